# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise and models of the quality benchmark, and what is measured on them."""

import sys
from pathlib import Path

import numpy as np
import pytest
from framelet.core import add_noise, compare, connect
from framelet.core.mesh.geometry import mean_edge_length, vertex_normals
from meshes import faces_of
from twins import newell, signed_volume

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

from cases import CaseName, load_case  # noqa: E402
from noise import NOISES, correlated, half_of, local_edge  # noqa: E402
from shapes import MADE, QUICK, gear, rounded_cube  # noqa: E402


@pytest.mark.parametrize("noise", NOISES)
def test_noise_has_its_size_and_its_seed(noise):
    clean = rounded_cube(16)
    moved = NOISES[noise](clean, 3)
    assert np.array_equal(moved, NOISES[noise](clean, 3))
    assert not np.array_equal(moved, NOISES[noise](clean, 4))
    offset = (moved - clean.vertices) / mean_edge_length(clean)
    if noise.startswith("local"):
        offset = (moved - clean.vertices) / local_edge(clean)[:, None]
    size = np.linalg.norm(offset, axis=1)
    kind, *numbers = noise.split()
    is_moved = size > 0
    along = np.abs((offset * vertex_normals(clean)).sum(axis=1)[is_moved]) / size[is_moved]
    if kind == "direction":
        assert abs(along.mean() - 0.5) < 0.05  # of directions uniform on the sphere
    elif kind in ("view", "terraces"):
        assert np.ptp(np.abs(offset / size[:, None]), axis=0).max() < 1e-6
    elif kind == "pixels":
        assert size.max() <= np.sqrt(3) / 2 * float(numbers[0]) + 1e-9
    else:
        assert along.min() > 1 - 1e-6
    if kind == "spikes":
        is_far = size > 1
        assert 0 < is_far.mean() < 0.03 and size[is_far].min() > 1.5 and size.max() < 12.5
        is_moved = ~is_far
    parts = {"uneven": [~half_of(clean), half_of(clean)]}.get(kind, [is_moved])
    sigmas = {
        "correlated": [0.2],
        "mixed": [np.hypot(*map(float, numbers[:2]))] if kind == "mixed" else [],
        "spikes": [0.1],
        # Rounding is as likely to miss by anything up to half a step.
        "terraces": [float(numbers[0]) / np.sqrt(12)],
        "pixels": [float(numbers[0]) / 2],
    }.get(kind, numbers)
    for part, sigma in zip(parts, sigmas, strict=True):
        rms = np.sqrt((size[part] ** 2).mean()) / float(sigma)
        assert 1.0 < rms < 2.0 if kind == "view" else abs(rms - 1) < 0.08
    share = {"impulsive": 0.5, "sparse": 0.2, "spikes": 0.99}.get(kind, 1.0)
    assert abs(is_moved.mean() - share) < (0.04 if kind in ("sparse", "spikes") else 0.001)


@pytest.mark.parametrize("n_averages", [1, 2, 4, 8])
def test_correlated_noise_is_alike_at_neighbors(n_averages):
    clean = rounded_cube(16)
    heights = ((correlated(clean, 0, n_averages) - clean.vertices) * vertex_normals(clean)).sum(axis=1)
    one, other = clean.edges.T
    alike = np.corrcoef(heights[one], heights[other])[0, 1]
    assert alike > {1: 0.25, 2: 0.45, 4: 0.6, 8: 0.7}[n_averages]


def test_local_edges_are_those_at_a_vertex():
    clean = gear()
    expected = [
        np.mean(
            [np.linalg.norm(np.diff(clean.vertices[edge], axis=0)) for edge in clean.edges if vertex in edge]
        )
        for vertex in (0, 5, 77)
    ]
    np.testing.assert_allclose(local_edge(clean)[[0, 5, 77]], expected)


def test_noise_along_normals_is_that_of_the_core():
    clean = rounded_cube(6)
    assert np.array_equal(NOISES["normal 0.3"](clean, 5), add_noise(clean, 0.3, 5))


@pytest.mark.parametrize("name", [*MADE, *QUICK])
def test_models_made_in_code_are_closed(name):
    mesh = {**MADE, **QUICK}[name]()
    assert connect(mesh).is_closed
    if "torus" not in name:  # those of the tests are turned inside out, which does not matter here
        assert signed_volume(mesh) > 0
    assert mesh.n_faces < 25_000


def largest_bend(mesh):
    """The largest angle between faces that share an edge, in degrees."""
    normals = np.array([newell(mesh.vertices[face]) for face in faces_of(mesh)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    at_edge = {}
    for face, corners in enumerate(faces_of(mesh)):
        for edge in zip(corners, [*corners[1:], corners[0]], strict=True):
            at_edge.setdefault(frozenset(map(int, edge)), []).append(face)
    cosines = [normals[pair[0]] @ normals[pair[1]] for pair in at_edge.values() if len(pair) == 2]
    return np.degrees(np.arccos(np.clip(min(cosines), -1, 1)))


def test_gear_has_sharp_edges_and_rounded_cube_has_fillets():
    bends = [largest_bend(mesh) for mesh in (gear(), rounded_cube(12))]
    assert bends[0] > 80
    assert bends[1] < 50


def test_measure_is_that_of_the_core():
    case = load_case(CaseName("made/small_cube_tri", "normal 0.2", 1))
    expected = compare(case.noisy, case.model.clean)
    found = case.measure(case.noisy.vertices)
    assert (found.angle, found.flips) == (expected.mean_angle, expected.flipped_faces)
    assert abs(found.rms - expected.rms_distance / expected.mean_edge_length) < 1e-12
    assert np.abs(case.positions(case.rows) - case.noisy.vertices).max() < 1e-5
