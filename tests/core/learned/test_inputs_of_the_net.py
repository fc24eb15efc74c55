# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scales and features against loops over faces, and what they do not depend on."""

import numpy as np
import pytest
from checks import lengths, random_rotation
from framelet.core import SurfaceMesh, connect
from framelet.core.averages import ring_means
from framelet.core.learned import features as features_module
from framelet.core.learned import scales as scales_module
from framelet.core.learned.engine import LONG, FaceEngine, long_edges
from kinds import ALONE, KINDS
from learned_twins import (
    AVERAGES,
    FLOOR,
    LEAST_LENGTH,
    SHRUNK,
    face_order,
    pairs_of,
    slow_features,
    slow_scales,
)
from meshes import MESHES, noisy, quad_torus, triangle_grid, triangle_torus, union
from stars import relabeled

SINGLE = 2e-4
"""Error of logarithms and heights in single precision."""

KINDS = {
    **KINDS,
    "a flat part": lambda: union(triangle_grid(5, 5), triangle_torus(4, 5)),
    "half a sheet": lambda: bumped(triangle_grid(9, 9)),
}


def bumped(mesh):
    """Return a flat sheet with one half of it waved."""
    points = mesh.vertices.copy()
    points[:, 2] = np.where(points[:, 0] > 4, 0.2 * np.sin(7 * points[:, 0] + 3 * points[:, 1]), 0)
    return mesh.with_vertices(points)


@pytest.fixture(autouse=True)
def exact(monkeypatch):
    """Whole series, and none that were cut off before or after."""
    series = (ring_means._low_pass_series, ring_means._power_series)
    for each in series:
        each.cache_clear()
    monkeypatch.setattr(ring_means, "LEFT_OUT", 1e-14)
    yield
    for each in series:
        each.cache_clear()


def engine_of(mesh):
    return FaceEngine(mesh, connect(mesh), ALONE)


def points_of(mesh):
    return np.ascontiguousarray(mesh.vertices.T, np.float32)


def matrix_of(rings):
    """Return ring means as a dense matrix."""
    n = len(rings.place)
    return rings.outward(rings.mean(rings.inward(np.eye(n))))


def by_pair(graph, pairs):
    """Return the number of each of the twin's pairs in the graph."""
    number, taken = {}, set()
    for place, (f, g) in enumerate(zip(graph.first[:-1].tolist(), graph.second[:-1].tolist(), strict=True)):
        number.setdefault((f, g), []).append(place)
    result = []
    for f, g, _ in pairs:
        result.append(number[f, g][0] if len(number[f, g]) == 1 else number[f, g].pop(0))
        assert result[-1] not in taken
        taken.add(result[-1])
    return result


def test_the_constants_of_the_twins():
    assert (AVERAGES, np.float32(FLOOR)) == (scales_module.AVERAGES, features_module.FLOOR)
    assert np.float32(SHRUNK) == scales_module.SHRUNK
    assert np.float32(LEAST_LENGTH) == scales_module.LEAST_LENGTH


@pytest.mark.parametrize("kind", ["irregular torus", "quad torus", "mixed sheet", "three pages", "border"])
def test_long_edges(kind, rng):
    """Edges many times as long as the geometric mean of those at one of their ends."""
    mesh = KINDS[kind]()
    points = mesh.vertices.copy()
    far = rng.permutation(mesh.n_vertices)[: 1 + mesh.n_vertices // 20]
    points[far] += 100 * rng.normal(size=(len(far), 3))
    mesh, connectivity = mesh.with_vertices(points), connect(mesh)
    length = lengths(points[mesh.edges[:, 0]] - points[mesh.edges[:, 1]])
    has_face = connectivity.edge_face_count > 0
    expected = np.zeros(mesh.n_edges, bool)
    for number in np.flatnonzero(has_face):
        at_ends = [has_face & (mesh.edges == v).any(axis=1) for v in mesh.edges[number]]
        expected[number] = length[number] > LONG * np.exp(min(np.log(length[own]).mean() for own in at_ends))
    assert long_edges(mesh, connectivity).tolist() == expected.tolist()
    assert expected.any() and not expected.all()


@pytest.mark.parametrize("kind", KINDS)
def test_scales(kind, rng):
    mesh = noisy(KINDS[kind](), rng)
    engine = engine_of(mesh)
    scales = scales_module.find_scales(points_of(mesh), engine.graph, engine.rings)
    normals, centroids, areas, length = slow_scales(mesh, matrix_of(engine.rings))
    assert np.abs(scales.areas - areas).max() < 1e-5
    assert np.abs(scales.centroids - centroids.transpose(2, 0, 1)).max() < 1e-4
    assert np.abs(scales.length - length).max() < 1e-5
    has_area = areas > 1e-3
    apart = np.abs(scales.normals - normals.transpose(2, 0, 1)).max(axis=0)
    assert apart[has_area].max() < 1e-3 and has_area[:, 0].mean() > 0.5
    assert (np.linalg.norm(scales.normals, axis=0) < 1 + 1e-5).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("log_strength", "width"), [(0.0, 0.0), (0.7, 1.0)])
def test_features(kind, log_strength, width, rng, monkeypatch):
    monkeypatch.setattr(features_module, "LEAST_ISLAND", 4)
    mesh = KINDS[kind]()
    if kind not in ("a flat part", "half a sheet"):
        mesh = noisy(mesh, rng)
    engine = engine_of(mesh)
    scales, found = engine.describe(points_of(mesh), log_strength, width)
    # The twin takes the same scales, so that what rounding does to thin faces does not count.
    same = (
        scales.normals.transpose(1, 2, 0),
        scales.centroids.transpose(1, 2, 0),
        scales.areas,
        scales.length,
    )
    same = [x.astype(float) for x in same]
    faces, pairs = slow_features(mesh, matrix_of(engine.rings), same, log_strength, width, 4)
    assert found.faces.shape == faces.shape and found.faces.dtype == np.float32
    columns = np.abs(found.faces - faces).max(axis=0)
    # Deviations come out of differences of large squares.
    assert columns[[19, 20]].max() < 0.05
    assert np.delete(columns, [19, 20]).max() < 10 * SINGLE
    order = by_pair(engine.graph, pairs_of(mesh))
    if order:
        assert np.abs(found.pairs[order] - pairs).max() < 10 * SINGLE
    assert not found.pairs[-1].any()


@pytest.mark.parametrize("kind", ["irregular torus", "quad torus", "mixed sheet", "border"])
def test_features_do_not_depend_on_pose_and_numbers(kind, rng):
    mesh = noisy(KINDS[kind](), rng)
    _, plain = engine_of(mesh).describe(points_of(mesh))
    turned = mesh.with_vertices(mesh.vertices @ random_rotation(rng))
    _, found = engine_of(turned).describe(points_of(turned))
    assert np.abs(found.faces - plain.faces).max() < 0.02
    assert np.abs(found.pairs - plain.pairs).max() < 0.02
    other, _ = relabeled(mesh, rng)
    _, found = engine_of(other).describe(points_of(other))
    assert np.abs(np.sort(found.faces, axis=0) - np.sort(plain.faces, axis=0)).max() < 0.02
    assert np.abs(np.sort(found.pairs, axis=0) - np.sort(plain.pairs, axis=0)).max() < 0.02


def test_islands_are_described_as_if_alone(rng, monkeypatch):
    """Also with other lengths of edges, and among faces of other kinds."""
    monkeypatch.setattr(features_module, "LEAST_ISLAND", 50)
    first = noisy(triangle_torus(10, 14), rng, 0.1)
    second = noisy(quad_torus(8, 10), rng, 0.3)
    second = second.with_vertices(7 * second.vertices)
    both = union(first, second)
    own = engine_of(both)
    _, found = own.describe(points_of(both))
    order = np.array(face_order(both))
    for mesh, part in ((first, order < first.n_faces), (second, order >= first.n_faces)):
        _, alone = engine_of(mesh).describe(points_of(mesh))
        assert np.abs(found.faces[part] - alone.faces).max() < 5e-3


def test_small_islands_are_described_together(rng):
    mesh = union(noisy(triangle_torus(5, 6), rng, 0.1), noisy(triangle_torus(5, 6), rng, 0.4))
    engine = engine_of(mesh)
    assert engine.island is not None
    _, found = engine.describe(points_of(mesh))
    assert (found.faces[:, 21:] == found.faces[0, 21:]).all()


def test_quantiles_of_large_meshes_are_those_of_a_sample(rng, monkeypatch):
    mesh = noisy(triangle_torus(30, 40), rng)
    engine = engine_of(mesh)
    _, whole = engine.describe(points_of(mesh))
    monkeypatch.setattr(features_module, "N_SAMPLES", 400)
    _, found = engine.describe(points_of(mesh))
    assert np.array_equal(found.faces[:, :21], whole.faces[:, :21])
    assert 0 < np.abs(found.faces[:, 21:] - whole.faces[:, 21:]).max() < 0.5


@pytest.mark.parametrize("build", [MESHES["single triangle"], MESHES["single quad"], MESHES["tetrahedron"]])
def test_tiny_meshes_have_features(build):
    mesh = build()
    _, found = engine_of(mesh).describe(points_of(mesh))
    assert np.isfinite(found.faces).all() and np.isfinite(found.pairs).all()


def test_faces_without_area_have_features():
    mesh = SurfaceMesh.from_faces(np.eye(5, 3) * [1, 1, 0], [(0, 1, 2), (2, 1, 3), (3, 4, 2), (0, 2, 4)])
    _, found = engine_of(mesh).describe(points_of(mesh))
    assert np.isfinite(found.faces).all() and np.isfinite(found.pairs).all()
