# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and memory of choosing dilated stencils on a mesh of 100,000 vertices; each run is a process."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import checkout  # noqa: F401
import numpy as np
from cases import mesh_folder
from framelet.core import SurfaceMesh
from framelet.core.blocks import Blocks
from framelet.core.mesh.connectivity import connect
from framelet.core.transform import make_transform
from mesh_files import read_mesh
from meshes import noisy, quad_torus, triangle_torus

SIDES = (250, 400)
"""Rows and columns of the tori."""

RUNS = {
    "BOX_SPLINE_111": ("torus of triangles", "STRAIGHT"),
    "LINEAR_SPLINE": ("torus of quads", "STRAIGHT"),
    "ADAPTIVE": ("torus of triangles", "ADAPTIVE"),
}
REAL = "tri/amo90k"
N_LEVELS = (1, 2, 3, 4)
MEGABYTE = 2.0**20


class Cost(NamedTuple):
    """What a run took."""

    mesh: str
    vertices: int
    frame: str
    levels: int
    """Number of levels; the coarsest has taps 2^(levels - 1) edges apart."""
    connect_seconds: float
    transform_seconds: float
    start_megabytes: float
    """Peak memory before the transform, mesh and connectivity included."""
    transform_megabytes: float
    """Peak memory with the transform made."""


def measure_all(say: Callable[[str], None]) -> list[Cost]:
    """Run each frame with each number of levels in a process of its own, one after the other."""
    costs = []
    meshes = [REAL] if mesh_folder() is not None else []
    plan = [(mesh, frame) for frame, (mesh, _) in RUNS.items()]
    plan += [(mesh, frame) for mesh in meshes for frame in ("BOX_SPLINE_111", "ADAPTIVE")]
    for mesh, frame in plan:
        for levels in N_LEVELS:
            done = subprocess.run(
                [sys.executable, __file__, mesh, frame, str(levels)],
                capture_output=True,
                text=True,
                check=True,
            )
            costs.append(Cost(**json.loads(done.stdout)))
        say(f"dilation of {frame} on {mesh}: {costs[-1].transform_seconds:.2f} s for {levels} levels")
    return costs


def make_mesh(name: str) -> SurfaceMesh:
    """Return a large mesh with noise, in float32."""
    if name == REAL:
        mesh = read_mesh(mesh_folder() / f"{name}.ply")
    else:
        mesh = (quad_torus if "quads" in name else triangle_torus)(*SIDES)
    mesh = noisy(mesh, np.random.default_rng(0), 0.1)
    return mesh.with_vertices(mesh.vertices.astype(np.float32))


def measure_one(name: str, frame: str, levels: int) -> Cost:
    """Make a transform in this process, which should do nothing else."""
    mesh = make_mesh(name)
    stencil = RUNS[frame][1]
    with Blocks(0) as blocks:
        began = perf_counter()
        connectivity = connect(mesh, blocks)
        connected = perf_counter()
        start_megabytes = peak_megabytes()
        make_transform(
            mesh,
            frame,
            stencil,
            levels,
            connectivity=connectivity,
            blocks=blocks,
            dtype=np.float32,
            only_used_bands=True,
        )
        made = perf_counter()
    return Cost(
        mesh=name,
        vertices=mesh.n_vertices,
        frame=frame,
        levels=levels,
        connect_seconds=connected - began,
        transform_seconds=made - connected,
        start_megabytes=start_megabytes,
        transform_megabytes=peak_megabytes(),
    )


def peak_megabytes() -> float:
    """Return the largest memory that this process has had so far."""
    status = Path("/proc/self/status")
    if status.is_file():
        # On Linux `getrusage` also counts what the parent had when it started this process.
        line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM"))
        return int(line.split()[1]) / 1024.0
    import resource  # not on Windows

    unit = 1.0 if sys.platform == "darwin" else 1024.0  # bytes on macOS, kilobytes elsewhere
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / MEGABYTE


if __name__ == "__main__":
    print(json.dumps(measure_one(sys.argv[1], sys.argv[2], int(sys.argv[3]))._asdict()))
