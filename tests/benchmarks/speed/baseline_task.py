# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One measurement of another program, or of the plainest numpy: `baseline_task.py NAME MESH.npz`, as JSON."""

import json
import sys

import loading  # noqa: F401
import numpy as np
from shapes import read_mesh
from stopwatch import Stopwatch, begin_peak, peak_bytes


def plain(mesh, watch):
    """Tri-2 as the formulas stand in the paper, on whole arrays: no blocks, no threads, all seven bands."""
    from framelet.core import BANKS, PRESETS, connect, make_stencil
    from framelet.core.mesh.geometry import mean_edge_length

    settings = PRESETS["TRI_2"].settings
    stencil = make_stencil(mesh, connect(mesh), "STRAIGHT", bank=BANKS["BOX_SPLINE_111"])
    bank = BANKS["BOX_SPLINE_111"]
    masks, row = bank.masks.astype(np.float32), bank.reconstruction[0].astype(np.float32)
    noisy = (mesh.vertices / np.float32(mean_edge_length(mesh))).astype(np.float32)

    def analyze(surface):
        points = stencil.extended(surface).T
        return np.tensordot(masks, points[stencil.slots], axes=1)

    def solve():
        surface, residual = noisy, np.zeros((len(masks), *noisy.shape), np.float32)
        details = analyze(noisy)
        for _ in range(settings.iterations):
            rebuilt = np.tensordot(row, details - residual, axes=1)
            surface = (noisy + settings.mu * rebuilt) / (1.0 + settings.mu)
            coefficients = analyze(surface)
            shifted = coefficients + residual
            length = np.linalg.norm(shifted, axis=2, keepdims=True)
            threshold = settings.lambda_ / settings.mu
            details = shifted * (np.maximum(length - threshold, 0.0) / np.maximum(length, 1e-30))
            details[0] = shifted[0]
            residual = shifted - details
        return surface

    watch.run("solve", solve)


def pymeshlab_taubin(mesh, watch):
    """Taubin smoothing of MeshLab, at its default settings."""
    watch.run("solve", _meshlab(mesh).apply_coord_taubin_smoothing)


def pymeshlab_two_step(mesh, watch):
    """Two-step smoothing of MeshLab, at its default settings."""
    watch.run("solve", _meshlab(mesh).apply_coord_two_steps_smoothing)


def _meshlab(mesh):
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    faces = mesh.corner_vertex.reshape(-1, 3)
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices.astype(np.float64), faces))
    return meshes


def meshlib_denoise(mesh, watch):
    """The denoising of MeshLib by way of normals, at its default settings."""
    from meshlib import mrmeshnumpy, mrmeshpy

    other = mrmeshnumpy.meshFromFacesVerts(mesh.corner_vertex.reshape(-1, 3), mesh.vertices)
    watch.run("solve", lambda: mrmeshpy.meshDenoiseViaNormals(other))


BASELINES = {
    function.__name__: function for function in (plain, pymeshlab_taubin, pymeshlab_two_step, meshlib_denoise)
}


def main():
    """Measure and print; a package that is missing gives an empty result."""
    name, path = sys.argv[1:3]
    mesh = read_mesh(path)
    before = begin_peak()
    watch = Stopwatch()
    try:
        BASELINES[name](mesh, watch)
    except ImportError as error:
        sys.stdout.write("\n" + json.dumps({"missing": str(error)}) + "\n")
        return
    stages = watch.seconds | {"all": watch.seconds["solve"]}
    found = {"stages": stages, "peak": peak_bytes() - before}
    found |= {"n_vertices": mesh.n_vertices, "n_faces": mesh.n_faces}
    sys.stdout.write("\n" + json.dumps(found) + "\n")


if __name__ == "__main__":
    main()
