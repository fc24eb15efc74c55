# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The estimate of memory against what numpy allocates, and the refusal of what does not fit."""

import tracemalloc

import numpy as np
import pytest
from framelet.core import PRESETS, DenoiseSettings, SurfaceMesh, denoise
from framelet.core import memory as module
from framelet.core.errors import TooLargeError
from framelet.core.memory import check_memory, estimated_bytes, high_valences
from framelet.core.settings import used_settings
from meshes import faces_of, noisy, quad_torus

TRI_2 = PRESETS["TRI_2"].settings
CASES = [
    ("triangles", {}),
    ("triangles", {"shrinkage": "BANDS", "stencil": "MEAN", "delta": 0.1}),
    ("triangles", {"levels": 2}),
    ("triangles", {"frame": "ADAPTIVE", "stencil": "ADAPTIVE"}),
    ("triangles", {"frame": "ADAPTIVE", "stencil": "ADAPTIVE", "levels": 2}),
    ("triangles", {"frame": "PAIRWISE"}),
    ("triangles", {"frame": "B_SPLINE_3"}),
    ("triangles", {"method": "AUTO"}),
    ("quads", {"method": "AUTO"}),
    ("triangles", {"method": "BILATERAL"}),
    ("quads", {"frame": "LINEAR_SPLINE"}),
    ("quads", {"frame": "B_SPLINE_4"}),
]


@pytest.fixture(scope="module")
def surfaces():
    """A torus of quads, and one of triangles with either diagonal of each quad: half of it is irregular."""
    rng = np.random.default_rng(0)
    quads = quad_torus(120, 200)
    a, b, c, d = quads.corner_vertex.reshape(-1, 4).T
    is_other = rng.random(len(a)) < 0.5
    first = np.where(is_other, (a, b, c), (a, b, d)).T
    second = np.where(is_other, (a, c, d), (b, c, d)).T
    triangles = SurfaceMesh.from_faces(quads.vertices, np.concatenate((first, second)))
    return {"triangles": noisy(triangles, rng), "quads": noisy(quads, rng)}


@pytest.mark.parametrize(("kind", "changes"), CASES)
def test_the_estimate_is_near_the_peak(kind, changes, surfaces):
    """Within a factor of two, without what blocks in work take: on small meshes that is most of it."""
    mesh = surfaces[kind]
    values = vars(TRI_2) | {"threads": 1, "iterations": 3} | changes
    settings = DenoiseSettings(**used_settings(values))
    tracemalloc.start()
    denoise(mesh, settings)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    estimate = estimated_bytes(mesh.n_vertices, mesh.n_corners, settings)
    assert peak < estimate
    assert estimate - module._FIXED < 2.0 * peak


@pytest.mark.parametrize("preset", PRESETS)
def test_the_estimate_grows_with_the_mesh(preset):
    settings = PRESETS[preset].settings
    small, large = (estimated_bytes(n, 6 * n, settings) for n in (10**6, 10**7))
    assert small > 200 * 10**6
    assert 9 * (small - module._FIXED) < large < 10 * small
    assert estimated_bytes(0, 0, settings) > 0
    if settings.method == "POSITIONS":
        assert estimated_bytes(10**6, 6 * 10**6, settings.with_changes(levels=3)) > small


def test_a_run_that_does_not_fit_is_refused_before_it_begins(surfaces):
    mesh = surfaces["triangles"]
    with pytest.raises(
        TooLargeError, match=r"24,000 vertices need about .* MB of memory .* only 10 MB are free"
    ):
        denoise(mesh, TRI_2, max_bytes=10**7)
    bad = SurfaceMesh.from_faces(np.full((3, 3), np.nan), [(0, 1, 2)])
    with pytest.raises(TooLargeError, match="of memory"):
        denoise(bad, TRI_2, max_bytes=10**7)  # nothing of the mesh was looked at
    denoise(mesh, TRI_2, max_bytes=2 * estimated_bytes(mesh.n_vertices, mesh.n_corners, TRI_2))


def test_large_numbers_are_in_gigabytes():
    wide = DenoiseSettings(method="BILATERAL", sigma_c=2.0)
    with pytest.raises(TooLargeError, match=r"need about \d\d\.\d GB .* only 7\.9 GB are free"):
        check_memory(fan(9000), wide, 7_900_000_000)
    check_memory(fan(9000), wide, None)


def fan(n):
    """Return a closed cylinder whose caps are fans of n triangles."""
    angle = 2 * np.pi * np.arange(n) / n
    rim = np.stack((n / 6.28 * np.cos(angle), n / 6.28 * np.sin(angle), 0 * angle), axis=1)
    points = np.concatenate(
        [*(rim + np.array([0, 0, height]) for height in range(6)), [[0, 0, 0], [0, 0, 5]]]
    )
    here, there = np.arange(n), (np.arange(n) + 1) % n
    sides = [
        np.stack(corners, axis=1) + row * n
        for row in range(5)
        for corners in ((here, there, there + n), (here, there + n, here + n))
    ]
    caps = [np.stack((here * 0 + 6 * n, there, here), axis=1)]
    caps.append(np.stack((here * 0 + 6 * n + 1, here + 5 * n, there + 5 * n), axis=1))
    points += np.random.default_rng(1).normal(scale=0.2, size=points.shape)
    return SurfaceMesh.from_faces(points.astype(np.float32), np.concatenate((*sides, *caps)))


def quad_fan(n):
    """Return a closed cylinder of quads whose caps are fans of n quads."""
    mesh = fan(2 * n)
    here, there = np.arange(2 * n), (np.arange(2 * n) + 1) % (2 * n)
    sides = [np.stack((here, there, there + 2 * n, here + 2 * n), axis=1) + 2 * n * row for row in range(5)]
    odd = here[1::2]
    last = (odd + 1) % (2 * n)
    caps = [
        np.stack(
            (np.full(n, 12 * n + cap), last + 10 * n * cap, odd + 10 * n * cap, odd - 1 + 10 * n * cap), 1
        )
        for cap in (0, 1)
    ]
    return SurfaceMesh.from_faces(mesh.vertices, np.concatenate((*sides, *caps)))


HUBS = [
    {"method": "BILATERAL", "iterations": 2},
    {"method": "BILATERAL", "iterations": 2, "sigma_c": 1.5},
    {"method": "POSITIONS", "frame": "BOX_SPLINE_111", "levels": 2, "iterations": 3},
    {"method": "POSITIONS", "frame": "BOX_SPLINE_111", "levels": 3, "iterations": 3},
    {"method": "POSITIONS", "frame": "PAIRWISE", "iterations": 3},
    {"method": "POSITIONS", "frame": "ADAPTIVE", "iterations": 3},
    {"method": "POSITIONS", "frame": "ADAPTIVE", "levels": 2, "iterations": 3},
    {"method": "POSITIONS", "frame": "B_SPLINE_1", "iterations": 3},
    {"method": "POSITIONS", "frame": "B_SPLINE_3", "iterations": 3},
    {"method": "POSITIONS", "frame": "B_SPLINE_5", "iterations": 3},
    {"method": "POSITIONS", "frame": "BOX_SPLINE_FOUR_DIRECTION", "iterations": 3},
]
HUBS_OF_QUADS = [
    {"method": "BILATERAL", "iterations": 2},
    {"method": "POSITIONS", "frame": "LINEAR_SPLINE", "levels": 2, "iterations": 3},
    {"method": "POSITIONS", "frame": "B_SPLINE_2", "levels": 2, "iterations": 3},
    {"method": "POSITIONS", "frame": "B_SPLINE_3", "iterations": 3},
    {"method": "POSITIONS", "frame": "B_SPLINE_4", "levels": 2, "iterations": 3},
    {"method": "POSITIONS", "frame": "PAIRWISE", "iterations": 3},
    {"method": "POSITIONS", "frame": "ADAPTIVE", "levels": 2, "iterations": 3},
]


@pytest.mark.parametrize(
    ("build", "changes"), [(fan, case) for case in HUBS] + [(quad_fan, case) for case in HUBS_OF_QUADS]
)
def test_the_estimate_knows_vertices_of_high_valence(build, changes):
    """What pairs across a hub take grows with the square of its valence; it is known within 1.5 times."""
    settings = DenoiseSettings(threads=1, **changes)
    is_costly = changes.get("levels") == 3 or changes.get("frame") == "B_SPLINE_5" or "sigma_c" in changes
    mesh = build(250 if is_costly else 500)
    tracemalloc.start()
    denoise(mesh, settings)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    estimate = estimated_bytes(mesh.n_vertices, mesh.n_corners, settings, high_valences(mesh))
    assert peak < 1.5 * estimate
    assert estimate - module._FIXED < 1.5 * max(peak, module._FIXED)
    with pytest.raises(TooLargeError):
        denoise(mesh, settings, max_bytes=estimate - 1)


def test_faces_of_the_test_meshes_are_what_they_are_called(surfaces):
    assert {len(face) for face in faces_of(surfaces["quads"])} == {4}
