# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets do what their lines say, on shapes made in code."""

import numpy as np
import pytest
from framelet.core import PRESETS, SurfaceMesh, add_noise, compare, denoise
from twins import signed_volume

N_CELLS = 26
RADII = (0.83, 0.34)
"""Of a torus in a cube from -1.3 to 1.3; in voxels about 8 and 3.4."""


def torus_distance(points):
    """Return signed distances from a tilted torus, positive outside."""
    x, y, z = np.moveaxis(np.asarray(points, np.float64), -1, 0)
    y, z = 0.92 * y - 0.39 * z, 0.39 * y + 0.92 * z
    return np.hypot(np.hypot(x, y) - RADII[0], z) - RADII[1]


def voxel_surface():
    """Return the faces between the voxels inside the torus and those outside, as quads."""
    edges = np.linspace(-1.3, 1.3, N_CELLS + 1)
    middles = (edges[:-1] + edges[1:]) / 2
    inside = torus_distance(np.stack(np.meshgrid(middles, middles, middles, indexing="ij"), axis=-1)) < 0
    quads = []
    for axis in range(3):
        change = np.diff(inside.astype(int), axis=axis)
        places = np.argwhere(change)
        corner = places + np.eye(3, dtype=int)[axis]
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        faces = np.stack([corner, corner + u, corner + u + v, corner + v], axis=1)
        enters = change[tuple(places.T)] > 0
        faces[enters] = faces[enters][:, ::-1]
        quads.append(faces)
    quads = np.concatenate(quads)
    grid, numbers = np.unique(quads.reshape(-1, 3), axis=0, return_inverse=True)
    return SurfaceMesh.from_faces(edges[grid].astype(np.float32), numbers.reshape(-1, 4))


def rms_in_voxels(surface):
    return float(np.sqrt(np.mean(torus_distance(surface.vertices) ** 2))) / (2.6 / N_CELLS)


def test_marching_cubes_takes_the_steps_away_and_keeps_the_volume():
    steps = voxel_surface()
    result = denoise(steps, PRESETS["MARCHING_CUBES"].settings)
    smooth = steps.with_vertices(result.vertices)
    assert rms_in_voxels(smooth) < 0.35 * rms_in_voxels(steps)
    truth = 2 * np.pi**2 * RADII[0] * RADII[1] ** 2
    assert signed_volume(smooth) == pytest.approx(signed_volume(steps), rel=0.01)
    assert signed_volume(smooth) == pytest.approx(truth, rel=0.03)
    # What shrinks instead loses volume.
    soft = denoise(steps, PRESETS["POSITIONS"].settings.with_changes(lambda_=1.0))
    assert signed_volume(steps.with_vertices(soft.vertices)) < 0.9 * truth
    for other in ("PRISMATIC", "SCULPT"):
        others = denoise(steps, PRESETS[other].settings)
        assert rms_in_voxels(steps.with_vertices(others.vertices)) > 1.2 * rms_in_voxels(smooth)


def carved_sphere():
    """Return a dense sphere with waves about seven edges long all over."""
    vertices = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], np.float64)
    faces = np.array([(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])
    for _ in range(5):
        pairs = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        pairs, middle = np.unique(pairs, axis=0, return_inverse=True)
        ab, bc, ca = middle.reshape(-1, 3).T + len(vertices)
        vertices = np.concatenate([vertices, vertices[pairs].mean(axis=1)])
        a, b, c = faces.T
        faces = np.concatenate(
            [np.stack(f, 1) for f in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
    vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    edge = np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean()
    waves = np.sin(2 * np.pi / (7 * edge) * vertices + (0, 1, 2)).prod(axis=1)
    return SurfaceMesh.from_faces(vertices * (1 + 0.7 * edge * waves)[:, None], faces)


def test_sculpt_keeps_strokes_that_the_preset_for_scans_takes_for_noise():
    clean = carved_sphere()
    kept = {
        key: denoise(clean, PRESETS[key].settings).report.displacement_rms for key in ("SCULPT", "FREE_FORM")
    }
    assert kept["SCULPT"] < 0.5 * kept["FREE_FORM"]
    noisy = clean.with_vertices(add_noise(clean, 0.2, 1))
    found = noisy.with_vertices(denoise(noisy, PRESETS["SCULPT"].settings).vertices)
    assert compare(found, clean).mean_angle < 0.7 * compare(noisy, clean).mean_angle
