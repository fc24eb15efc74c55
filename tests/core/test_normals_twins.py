# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of the normal-field engine against their definitions (section 7), written as loops."""

import numpy as np
import pytest
from checks import AS_SOLVED, lengths
from framelet.core import DenoiseSettings, SurfaceMesh, connect, denoise
from framelet.core.blocks import Blocks
from framelet.core.normals import face_pairs, neighbors, pilot
from framelet.core.normals.averages import TILE, united
from framelet.core.normals.centroids import face_centroids
from framelet.core.normals.face_averages import FaceAverages
from framelet.core.normals.neighbors import edge_neighbors, faces_of_vertices, members_around
from framelet.core.normals.vertex_fit import VertexFit
from meshes import MESHES, faces_of, flipped, noisy, soup, triangle_grid, triangle_torus, union
from twins import faces_across, faces_touching, newell

ROUNDING = 1e-12
ALONE = Blocks(1)
ODD = SurfaceMesh.from_faces(
    np.eye(5, 3), [(0, 1, 2), (2, 4, 0), (3, 3, 3), (1, 1, 4), (0,), (2, 3, 2, 4), (2, 4, 3)]
)
KINDS = {
    "triangles": lambda: flipped(triangle_torus(5, 6)),
    "quads": MESHES["quad torus"],
    "mixed": MESHES["mixed sheet"],
    "polygons": lambda: union(MESHES["prism"](), MESHES["tetrahedron"]()),
    "boundary": lambda: flipped(triangle_grid(5, 6), seed=1),
    "quad boundary": MESHES["quad grid"],
    "one-sided": MESHES["moebius strip"],
    "non-manifold": lambda: union(MESHES["three pages"](), MESHES["bow tie"]()),
    "soup": lambda: soup(0),
    "odd faces": lambda: ODD,
    "single triangle": MESHES["single triangle"],
}
KIND = pytest.mark.parametrize("kind", KINDS)


def frame_of(table):
    """Return low-pass and differences as matrices, (n_i - n_j) / (k + 1), and k + 1 for each difference."""
    low, high, slots = np.zeros((len(table), len(table))), [], []
    for f, near in enumerate(table):
        taps = [f, *near]
        for i, a in enumerate(taps):
            low[f, a] += 1 / len(taps)
            for b in taps[i + 1 :]:
                row = np.zeros(len(table))
                row[a] += 1 / len(taps)
                row[b] -= 1 / len(taps)
                high.append(row)
                slots.append(len(taps))
    return low, np.reshape(high, (-1, len(table))), np.array(slots)


def measure_of(table):
    """Return the measure that equal weights pull back to the faces."""
    return frame_of(table)[0].sum(axis=0)


def unit(vectors, fallback):
    """Return rows of length one, and the fallback for zeros."""
    size = lengths(vectors)[:, None]
    return np.where(size > 0, vectors / np.where(size > 0, size, 1), fallback)


def slow_pilot(noisy, table, threshold, eps, iterations):
    """Return the pilot, shape (F, 3), by split Bregman with d, b and the inverse as a matrix."""
    low, high, slots = frame_of(table)
    inverse = np.concatenate((low, high)).T / measure_of(table)[:, None]
    apart = [np.linalg.norm(noisy[f] - noisy[g]) for f, near in enumerate(table) for g in near if f < g]
    nu = threshold * (np.median(apart) if apart else 0.0) * np.ones((len(high), 1))
    limit, normals = nu, noisy
    for round_ in range(4 if eps else 1):
        if round_:
            limit = nu * (eps / (lengths(high @ normals) * slots + eps))[:, None]
        normals, b = noisy, np.zeros((len(high), 3))
        for _ in range(iterations):
            y = high @ normals + b
            size = lengths(y)[:, None]
            d = np.where(size > limit, y * (1 - limit / np.where(size > 0, size, 1)), 0)
            b = b + high @ normals - d
            rebuilt = inverse @ np.concatenate((low @ normals, d - b))
            normals = unit((noisy + 10 * rebuilt) / 11, noisy)
    return normals


def slow_average(mesh, noisy, guide, centroids, areas, sigma_c, sigma_n, steps):
    """Return averages over the faces that share a vertex, shape (F, 3)."""
    around = faces_touching(mesh)
    for _ in range(steps):
        sums = np.zeros_like(noisy)
        for f, near in enumerate(around):
            far, turn = lengths(centroids[near] - centroids[f]), lengths(guide[near] - guide[f])
            weights = areas[near] * np.exp(-(far**2) / 2 / sigma_c**2) * np.exp(-(turn**2) / 2 / sigma_n**2)
            sums[f] = weights @ noisy[near]
        noisy = unit(sums, noisy)
    return noisy


def slow_update(mesh, points, normals):
    """Return positions, shape (N, 3), after each vertex took the mean pull of its faces."""
    pulls = [[] for _ in points]
    for face, n in zip(faces_of(mesh), normals, strict=True):
        for v in face:
            pulls[v].append(n * (n @ (points[face].mean(axis=0) - points[v])))
    return np.array([p + (np.mean(own, axis=0) if own else 0) for p, own in zip(points, pulls, strict=True)])


def field(n_faces, rng, with_zeros=True):
    """Return random unit normals in rows, half of them much alike, and zero for a face here and there."""
    normals = rng.normal(size=(n_faces, 3))
    normals[::2] = [0, 0, 1] + 0.2 * normals[::2]
    if with_zeros:
        normals[7::20] = 0
    return unit(normals, normals)


@pytest.mark.parametrize("kind", [*KINDS, "soups"])
def test_faces_around_faces_and_vertices(kind):
    soups = [soup(seed, shortest=1 + seed % 3) for seed in range(12)]
    for mesh in soups if kind == "soups" else [KINDS[kind]()]:
        across, at_vertex = edge_neighbors(mesh, connect(mesh)), faces_of_vertices(mesh)
        rows = np.split(across.neighbor, across.offset[1:-1])
        assert [row.tolist() for row in rows] == faces_across(mesh)
        rows = np.split(at_vertex.items, at_vertex.offset[1:-1])
        expected = [
            [f for f, face in enumerate(faces_of(mesh)) for w in face if w == v] for v in range(len(rows))
        ]
        assert len(rows) == mesh.n_vertices
        assert [row.tolist() for row in rows] == expected
        assert touching(mesh) == [set(row) for row in faces_touching(mesh)]


def touching(mesh):
    """Return the set of faces around each face, by way of tiles in a scrambled order."""
    n_tiles = -(-mesh.n_faces // TILE)
    faces = np.resize(np.random.default_rng(0).permutation(mesh.n_faces), (n_tiles, TILE))
    tiles = united(members_around(mesh, faces_of_vertices(mesh), faces), n_tiles, mesh.n_faces)
    found = [set() for _ in range(mesh.n_faces)]
    for tile, own in enumerate(faces):
        part = slice(tiles.offset[tile], tiles.offset[tile + 1])
        assert (np.diff(tiles.member[part]) > 0).all() and tiles.bits[part].all()
        for bit, face in enumerate(own):
            found[face] = {
                int(g)
                for g, bits in zip(tiles.member[part], tiles.bits[part], strict=True)
                if bits >> bit & 1
            }
    return found


@pytest.mark.parametrize("most", [0, 3, 5])
def test_vertices_with_very_many_faces_do_not_join_them(most, monkeypatch):
    monkeypatch.setattr(neighbors, "MOST_FACES", most)
    mesh = flipped(triangle_torus(5, 6))
    corners = faces_of(mesh)
    counts = np.bincount(np.concatenate(corners))
    expected = [
        {g for g, other in enumerate(corners) if g == f or any(counts[v] <= most for v in {*face} & {*other})}
        for f, face in enumerate(corners)
    ]
    assert touching(mesh) == expected
    assert max(map(len, expected)) > 1 or most < 5


@KIND
@pytest.mark.parametrize("at_once", [1, 2**14], ids=["small chunks", "large chunks"])
def test_the_face_frame_is_tight(kind, at_once, rng, monkeypatch):
    """In the measure that equal weights pull back: constant if all faces are of one kind."""
    monkeypatch.setattr(face_pairs, "TAPS_AT_ONCE", 6 * at_once)
    mesh = KINDS[kind]()
    pairs, table = face_pairs.FacePairs(edge_neighbors(mesh, connect(mesh)), ALONE), faces_across(mesh)
    low, high, slots = frame_of(table)
    assert np.abs(pairs.measure - measure_of(table)).max() < ROUNDING
    if len(set(mesh.face_sizes().tolist())) == 1:
        assert np.abs(pairs.measure - 1).max() < ROUNDING
    assert kind not in ("mixed", "polygons") or np.ptp(pairs.measure) > 0.01
    assert np.abs(low.T @ low + high.T @ high - np.diag(pairs.measure)).max() < ROUNDING
    normals, factor = rng.normal(size=(mesh.n_faces, 3)), rng.normal(size=(len(high), 3))
    # Rows of the table come face by face, chunks by the number of taps.
    at = np.repeat(np.arange(mesh.n_faces), [len(near) * (len(near) + 1) // 2 for near in table])

    def change(index, apart):
        chunk = pairs.chunks[index]
        rows = np.array([np.flatnonzero(at == face) for face in chunk.taps[0]], int).reshape(
            len(chunk.taps[0]), -1
        )
        expected = (high @ normals * slots[:, None])[rows]
        assert np.abs(apart - expected.transpose(2, 1, 0)).max(initial=0) < ROUNDING
        return apart * factor[rows].transpose(2, 1, 0)

    found = np.full((3, mesh.n_faces), np.nan)
    pairs.returned(normals.T, change).for_faces(
        lambda faces, values: found.__setitem__((slice(None), faces), values)
    )
    expected = high.T @ (factor * (high @ normals)) / measure_of(table)[:, None]
    assert np.abs(found.T - expected).max() < ROUNDING


@KIND
@pytest.mark.parametrize("eps", [0.0, 0.05])
@pytest.mark.parametrize("iterations", [1, 4])
def test_the_pilot(kind, eps, iterations, rng, monkeypatch):
    monkeypatch.setattr(pilot, "ITERATIONS", iterations)
    mesh = KINDS[kind]()
    normals = field(mesh.n_faces, rng)
    ticks = []
    found = pilot.pilot_normals(
        normals.T, edge_neighbors(mesh, connect(mesh)), 0.3, eps, ALONE, lambda: ticks.append(0)
    ).T
    assert (
        np.abs(found - slow_pilot(normals, faces_across(mesh), 0.3, eps, iterations)).max() < ROUNDING * 100
    )
    assert len(ticks) == iterations * pilot.n_rounds(eps) == iterations * (4 if eps else 1)
    assert np.abs(lengths(found)[lengths(normals) > 0] - 1).max() < ROUNDING
    assert mesh.n_faces == 1 or lengths(found - normals).max() > 0.01


def test_the_pilot_leaves_alone_what_has_no_noise(rng):
    """A threshold of 0, or no differences at all, by which thresholds are measured."""
    mesh = MESHES["mixed sheet"]()
    neighbors = edge_neighbors(mesh, connect(mesh))
    random, even = field(mesh.n_faces, rng, with_zeros=False).T, np.full((3, mesh.n_faces), 3**-0.5)
    for eps in (0.0, 0.05):
        assert np.abs(pilot.pilot_normals(random, neighbors, 0.0, eps, ALONE) - random).max() < ROUNDING
        assert np.abs(pilot.pilot_normals(even, neighbors, 9.0, eps, ALONE) - even).max() < ROUNDING


@KIND
def test_guided_averages(kind, rng):
    """Weights of area, distance and guide; for several steps, blocks and guides."""
    mesh = KINDS[kind]()
    normals, guide = field(mesh.n_faces, rng), field(mesh.n_faces, rng)
    centroids, areas = rng.normal(size=(mesh.n_faces, 3)), rng.exponential(size=mesh.n_faces)
    with Blocks(2, block_size=7) as blocks:
        averages = FaceAverages(mesh, faces_of_vertices(mesh), centroids, areas, 0.8, blocks)
        for own, sigma_n, steps in ((guide, 0.3, 1), (guide, 2.0, 3), (normals, 0.5, 2), (guide, 0.3, 0)):
            ticks = []
            weights = averages.weights(own.T, sigma_n)
            found = averages.smooth(normals.T, weights, steps, lambda ticks=ticks: ticks.append(0)).T
            expected = slow_average(mesh, normals, own, centroids, areas, 0.8, sigma_n, steps)
            assert np.abs(found - expected).max() < ROUNDING
            assert len(ticks) == steps
            assert np.abs(lengths(found)[lengths(normals) > 0] - 1).max() < ROUNDING


@KIND
@pytest.mark.parametrize("blocks", [ALONE, Blocks(1, 5)], ids=["one block", "blocks"])
def test_vertex_steps(kind, blocks, rng):
    mesh = KINDS[kind]()
    expected, normals = rng.normal(size=(mesh.n_vertices, 3)), field(mesh.n_faces, rng)
    fit = VertexFit(mesh, faces_of_vertices(mesh), blocks).steps(expected.T, normals.T)
    for found, motion in fit.points(4):
        before, expected = expected, slow_update(mesh, expected, normals)
        assert np.abs(found.T - expected).max() < ROUNDING
        assert motion == pytest.approx(np.sqrt(((expected - before) ** 2).sum(axis=1).mean()), rel=1e-9)
    assert mesh.n_faces == 1 or motion > 1e-4


@pytest.mark.parametrize("size", [3, 4, 7])
def test_one_step_turns_a_single_face_about_its_centroid(size, rng):
    mesh = SurfaceMesh.from_faces(rng.normal(size=(size, 3)), [range(size)])
    normal = unit(rng.normal(size=(1, 3)), 0)
    fit = VertexFit(mesh, faces_of_vertices(mesh), ALONE).steps(mesh.vertices.T, normal.T)
    found = next(points for points, _ in fit.points(1))
    center = mesh.vertices.mean(axis=0)
    assert np.abs(face_centroids(found, mesh)[:, 0] - center).max() < ROUNDING
    assert np.abs(normal @ (found - center[:, None])).max() < ROUNDING
    assert np.abs(normal @ (mesh.vertices - center).T).max() > 0.1


@pytest.mark.parametrize("sharpness", [0.0, 0.05])
@pytest.mark.parametrize(
    "kind", ["triangles", "mixed", "polygons", "boundary", "non-manifold", "single triangle"]
)
def test_a_whole_run(kind, sharpness, rng, monkeypatch):
    """Pilot, two passes over the noisy normals, and vertex steps, on a mesh with uneven areas."""
    monkeypatch.setattr(pilot, "ITERATIONS", 3)
    mesh = noisy(KINDS[kind](), rng)
    changes = {"sharpness": sharpness, "average_steps": 2, "passes": 2, "vertex_steps": 3, "sigma_n": 0.4}
    settings = DenoiseSettings(method="NORMALS", boundary="FREE", threads=1, **changes)
    faces, table = faces_of(mesh), faces_across(mesh)
    vectors = np.array([newell(mesh.vertices[face]) for face in faces])
    centroids = np.array([mesh.vertices[face].mean(axis=0) for face in faces])
    normals = unit(vectors, 0)
    apart = [np.linalg.norm(centroids[f] - centroids[g]) for f, near in enumerate(table) for g in near]
    sigma_c = np.mean([d for d in apart if d > 0] or [1.0])
    guide = slow_pilot(normals, table, settings.normal_threshold, sharpness, 3)
    for _ in range(2):
        guide = slow_average(mesh, normals, guide, centroids, lengths(vectors), sigma_c, 0.4, 2)
    points = mesh.vertices
    for _ in range(3):
        points = slow_update(mesh, points, guide)
    found = denoise(mesh, settings, dtype=np.float64, region=AS_SOLVED).vertices
    assert lengths(found - points).max() < 1e-10
    assert mesh.n_faces == 1 or lengths(found - mesh.vertices).max() > 1e-3
