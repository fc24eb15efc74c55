# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scales and features against loops over faces, and what they do not depend on."""

import numpy as np
import pytest
from checks import assert_same_bits, lengths, random_rotation
from framelet.core import SurfaceMesh, connect
from framelet.core.learned import features as features_module
from framelet.core.learned import residual as residual_module
from framelet.core.learned import scales as scales_module
from framelet.core.learned.engine import LONG, FaceEngine, long_edges
from framelet.core.learned.net import load_net
from kinds import ALONE, KINDS
from learned_twins import (
    AVERAGES,
    FLOOR,
    LEAST_LENGTH,
    SHRUNK,
    SPREAD,
    face_order,
    pairs_of,
    ring_matrix,
    slow_features,
    slow_offsets,
    slow_residual,
    slow_scales,
)
from meshes import MESHES, noisy, octahedron, quad_torus, tetrahedron, triangle_grid, triangle_torus, union
from stars import relabeled

pytestmark = pytest.mark.usefixtures("exact")
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


def engine_of(mesh, **sizes):
    return FaceEngine(mesh, connect(mesh), ALONE, **sizes)


def points_of(mesh):
    return np.ascontiguousarray(mesh.vertices.T, np.float32)


def matrix_of(rings):
    """Return ring means as a dense matrix."""
    n = len(rings.place)
    return rings.outward(rings.mean(rings.inward(np.eye(n))))


def by_pair(graph, pairs):
    """Return the number of each of the twin's pairs in the graph."""
    number, residual = {}, set()
    for place, (f, g) in enumerate(zip(graph.first[:-1].tolist(), graph.second[:-1].tolist(), strict=True)):
        number.setdefault((f, g), []).append(place)
    result = []
    for f, g, _ in pairs:
        result.append(number[f, g][0] if len(number[f, g]) == 1 else number[f, g].pop(0))
        assert result[-1] not in residual
        residual.add(result[-1])
    return result


def test_the_constants_of_the_twins():
    assert (AVERAGES, np.float32(FLOOR)) == (scales_module.AVERAGES, features_module.FLOOR)
    assert np.float32(SHRUNK) == scales_module.SHRUNK
    assert np.float32(LEAST_LENGTH) == scales_module.LEAST_LENGTH
    assert SPREAD == features_module.SPREAD_AVERAGES == residual_module.SPREAD_AVERAGES
    assert features_module.N_FACE == 39


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


SCALED = {
    **KINDS,
    "vertices on top of each other": lambda: coincident(quad_torus()),
    "small islands": lambda: union(tetrahedron(), triangle_torus(), octahedron()),
}


def coincident(mesh):
    """Return a mesh with all vertices in the rings around one vertex in one place, and edges of no length."""
    points = mesh.vertices.copy()
    near = lengths(points - points[0]) < 3.5
    assert 8 < near.sum() < mesh.n_vertices - 8
    points[near] = points[0]
    return mesh.with_vertices(points)


@pytest.mark.parametrize("kind", SCALED)
def test_scales(kind, rng):
    """Also of islands that averages shrink to nothing, where normals and lengths have a floor."""
    mesh = SCALED[kind]() if "top" in kind else noisy(SCALED[kind](), rng)
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


def test_shrunk_faces_keep_the_normals_of_the_scale_before(rng):
    mesh = noisy(tetrahedron(), rng)
    engine = engine_of(mesh)
    scales = scales_module.find_scales(points_of(mesh), engine.graph, engine.rings)
    areas, normals = scales.areas, scales.normals
    assert (areas[:, 1] > SHRUNK * areas[:, 0]).all() and (areas[:, 2:] < SHRUNK * areas[:, :1]).all()
    assert_same_bits(normals[..., 2], normals[..., 1])
    assert_same_bits(normals[..., 3], normals[..., 1])
    assert np.abs(np.linalg.norm(normals, axis=0) - 1).max() < 1e-5


def test_lengths_are_those_of_edges_but_for_noise(rng):
    """Also on small islands, and on a mesh whose vertices are all in one place."""
    for mesh in (triangle_torus(40, 80), tetrahedron(), octahedron()):
        edge = lengths(mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]]).mean()
        engine = engine_of(mesh)
        unit = scales_module.find_scales(points_of(mesh), engine.graph, engine.rings).unit / edge
        assert unit.min() > 0.9 * LEAST_LENGTH and unit.max() < 2
        none = scales_module.find_scales(0 * points_of(mesh), engine.graph, engine.rings)
        assert (none.unit == 1).all() and not none.areas.any()


def test_other_positions_have_an_engine_of_their_own_if_other_edges_are_long(rng):
    mesh = noisy(triangle_torus(10, 14), rng)
    connectivity, near = connect(mesh), engine_of(mesh)
    assert near.for_positions(noisy(mesh, rng), connectivity) is near
    points = mesh.vertices.copy()
    points[17] += 1000
    far = mesh.with_vertices(points)
    found, expected = near.for_positions(far, connectivity), engine_of(far)
    assert found is not near and found.graph is near.graph and found.at_vertex is near.at_vertex
    assert np.array_equal(matrix_of(found.rings), matrix_of(expected.rings))
    means = matrix_of(near.rings)
    assert not matrix_of(found.rings)[:, 17].any() and means[:, 17].any()
    for each in (found, expected):
        each.made = each.describe(points_of(far))
        each.made += (load_net("wide").normals(*each.made, each.graph),)
        each.fitted = each.fit.fit(points_of(far), each.made[2])
    assert_same_bits(found.made[1].faces, expected.made[1].faces)
    assert_same_bits(found.fitted, expected.fitted)
    again = found.for_positions(mesh, connectivity)
    assert again is not found and np.array_equal(matrix_of(again.rings), means)
    assert found.for_positions(far, connectivity) is found and near.for_positions(mesh, connectivity) is near


def test_a_far_vertex_takes_the_mean_of_its_neighbors_and_counts_for_none(rng):
    """Its edges are long for its neighbors, and all it has."""
    mesh = noisy(triangle_torus(10, 14), rng)
    points = mesh.vertices.copy()
    points[17] += 1000
    mesh = mesh.with_vertices(points)
    engine = engine_of(mesh)
    expected = ring_matrix(mesh, mesh.edges[(mesh.edges == 17).any(axis=1)].tolist())
    found = matrix_of(engine.rings)
    assert np.abs(found - expected).max() < 1e-12
    neighbors = {v for edge in mesh.edges.tolist() if 17 in edge for v in edge} - {17}
    assert set(np.flatnonzero(found[17])) == neighbors and not found[:, 17].any()


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_taken_away(kind, rng):
    """Along the normals of the result, squared and multiplied with the mean of the ring, then spread."""
    before = noisy(KINDS[kind](), rng)
    after, engine = noisy(before, rng, 0.05), engine_of(before)
    offsets = slow_offsets(before, after.vertices)
    found = engine.offsets(points_of(before), points_of(after))
    assert np.abs(found - offsets).max() < 1e-5
    strength, correlation = slow_residual(matrix_of(engine.rings), offsets)
    for residual in (
        engine.residual(points_of(before), points_of(after)),
        residual_module.find_residual(offsets.astype(np.float32), engine.rings),
    ):
        assert residual.strength.dtype == residual.correlation.dtype == np.float32
        assert np.abs(residual.strength - strength).max() < 1e-4
        assert np.abs(residual.correlation - correlation)[strength > 1e-3].max(initial=0) < 1e-3
        assert (np.abs(residual.correlation) <= 1).all()


def test_nothing_taken_away_is_not_correlated(rng):
    mesh = noisy(KINDS["mixed sheet"](), rng)
    residual = engine_of(mesh).residual(points_of(mesh), points_of(mesh))
    assert not residual.strength.any() and not residual.correlation.any()


def test_the_pass_before_is_seen_in_two_columns_only(rng):
    mesh = noisy(KINDS["mixed sheet"](), rng)
    engine = engine_of(mesh)
    residual = engine.residual(points_of(noisy(mesh, rng)), points_of(mesh))
    _, first = engine.describe(points_of(mesh))
    _, second = engine.describe(points_of(mesh), residual)
    assert features_module.N_RESIDUAL == 2 and not first.faces[:, 37:].any()
    assert_same_bits(second.faces[:, :37].copy(), first.faces[:, :37].copy())
    assert_same_bits(second.pairs, first.pairs)
    assert np.abs(second.faces[:, 37:]).min(axis=0).min() > 0
    # What a usual noise leaves is near 0, as in a first pass; none at all is far from it.
    usual = residual_module.Residual(np.full(mesh.n_vertices, 0.13, np.float32), 0 * residual.correlation)
    _, found = engine.describe(points_of(mesh), usual)
    assert np.abs(found.faces[:, 37]).max() < 0.5 and not found.faces[:, 38].any()
    _, nothing = engine.describe(points_of(mesh), usual._replace(strength=0 * usual.strength))
    assert (nothing.faces[:, 37] < -1.25).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("log_strength", "is_first"), [(0.0, True), (0.7, True), (-0.5, False)])
def test_features(kind, log_strength, is_first, rng):
    mesh = KINDS[kind]()
    if kind not in ("a flat part", "half a sheet"):
        mesh = noisy(mesh, rng)
    engine = engine_of(mesh, least_island=4)
    residual = None
    if not is_first:
        residual = engine.residual(points_of(noisy(mesh, rng)), points_of(mesh))
    scales, found = engine.describe(points_of(mesh), residual, log_strength)
    # The twin takes the same scales, so that what rounding does to thin faces does not count.
    same = (
        scales.normals.transpose(1, 2, 0),
        scales.centroids.transpose(1, 2, 0),
        scales.areas,
        scales.length,
    )
    same = [x.astype(float) for x in same]
    faces, pairs, context = slow_features(mesh, matrix_of(engine.rings), same, residual, log_strength, 4)
    island = np.zeros(len(faces), int) if found.island is None else found.island
    assert np.abs(found.context[island] - context).max() < 5e-3
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
    mesh, turn = noisy(KINDS[kind](), rng), random_rotation(rng)
    before = noisy(mesh, rng)

    def described(mesh, before):
        engine = engine_of(mesh)
        return engine.describe(points_of(mesh), engine.residual(points_of(before), points_of(mesh)))

    _, plain = described(mesh, before)
    turned = mesh.with_vertices(mesh.vertices @ turn)
    _, found = described(turned, before.with_vertices(before.vertices @ turn))
    assert np.abs(found.faces - plain.faces).max() < 0.02
    assert np.abs(found.pairs - plain.pairs).max() < 0.02
    other, old = relabeled(mesh, rng)
    _, found = described(other, other.with_vertices(before.vertices[old]))
    assert np.abs(np.sort(found.faces, axis=0) - np.sort(plain.faces, axis=0)).max() < 0.02
    assert np.abs(np.sort(found.pairs, axis=0) - np.sort(plain.pairs, axis=0)).max() < 0.02


def test_islands_are_described_as_if_alone(rng):
    """Also with other lengths of edges, and among faces of other kinds."""
    first = noisy(triangle_torus(10, 14), rng, 0.1)
    second = noisy(quad_torus(8, 10), rng, 0.3)
    second = second.with_vertices(7 * second.vertices)
    both = union(first, second)
    own = engine_of(both, least_island=50)
    _, found = own.describe(points_of(both))
    order = np.array(face_order(both))
    for mesh, part in ((first, order < first.n_faces), (second, order >= first.n_faces)):
        _, alone = engine_of(mesh).describe(points_of(mesh))
        assert np.abs(found.faces[part] - alone.faces).max() < 5e-3


def test_small_islands_are_described_together(rng):
    mesh = union(noisy(triangle_torus(5, 6), rng, 0.1), noisy(triangle_torus(5, 6), rng, 0.4))
    engine = engine_of(mesh)
    assert engine.island is None
    assert np.unique(engine_of(mesh, least_island=50).island).tolist() == [0, 1]
    _, found = engine.describe(points_of(mesh))
    assert (found.faces[:, 21:] == found.faces[0, 21:]).all()


def test_quantiles_of_large_meshes_are_those_of_a_sample(rng):
    energies = rng.normal(size=(20_000, 8)).astype(np.float32)
    is_flat = rng.random(len(energies)) < 0.2
    energies[is_flat] = 100
    whole, found = (features_module.quantiles_of(energies, is_flat, n) for n in (len(energies), 4000))
    assert np.abs(whole[:3] - np.quantile(energies[~is_flat, 0], (0.25, 0.5, 0.75))).max() < 1e-3
    assert 0 < np.abs(found - whole).max() < 0.1
    few = energies[:300], is_flat[:300]
    assert_same_bits(features_module.quantiles_of(*few), features_module.quantiles_of(*few, 300))


@pytest.mark.parametrize("build", [MESHES["single triangle"], MESHES["single quad"], MESHES["tetrahedron"]])
def test_tiny_meshes_have_features(build):
    mesh = build()
    _, found = engine_of(mesh).describe(points_of(mesh))
    assert np.isfinite(found.faces).all() and np.isfinite(found.pairs).all()


def test_faces_without_area_have_features():
    mesh = SurfaceMesh.from_faces(np.eye(5, 3) * [1, 1, 0], [(0, 1, 2), (2, 1, 3), (3, 4, 2), (0, 2, 4)])
    _, found = engine_of(mesh).describe(points_of(mesh))
    assert np.isfinite(found.faces).all() and np.isfinite(found.pairs).all()
