# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the method AUTO survives: hostile meshes, odd sizes, and the ends of its range."""

import tracemalloc

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, wild_mesh
from framelet.core import PRESETS, SurfaceMesh, denoise
from framelet.core.blocks import BLOCK_SIZE
from framelet.core.memory import estimated_bytes
from mesh_files import mesh_files, read_mesh
from meshes import MESHES, bow_tie, clean_soup, faces_of, noisy, pyramid, quad_grid, quad_torus, soup, union

AUTO = PRESETS["AUTO"].settings
pytestmark = pytest.mark.filterwarnings("error")


pytestmark = pytest.mark.usefixtures("one_thread")


def assert_finite(mesh, settings=AUTO):
    result = denoise(mesh, settings)
    assert np.isfinite(result.vertices).all()
    assert result.vertices.dtype == mesh.vertices.dtype
    assert result.report.displacement_max <= 2 * np.ptp(mesh.vertices, axis=0).max()
    noise = result.report.noise
    assert np.isfinite([noise.sigma, noise.sigma_low, noise.sigma_high, noise.width]).all()
    return result.report


@pytest.mark.parametrize("noise", ["AUTO", "WIDE"])
@pytest.mark.parametrize("name", MESHES)
def test_every_mesh_made_in_code(name, noise, rng):
    """As it is, and with noise; WIDE takes nothing for clean."""
    mesh, settings = MESHES[name](), AUTO.with_changes(noise=noise)
    assert_finite(mesh, settings)
    for boundary in ("FIXED", "ALONG", "FREE"):
        assert_finite(noisy(mesh, rng), settings.with_changes(boundary=boundary))


def test_polygon_soups():
    for seed in range(6):
        for shortest in (1, 3):
            assert_finite(soup(seed, shortest=shortest))
        assert_finite(clean_soup(seed))


@pytest.mark.parametrize(
    "build", [lambda: bow_tie(100), lambda: pyramid(150, closed=True), lambda: pyramid(3000, closed=True)]
)
def test_many_fans_and_high_valences(build, rng):
    assert_finite(noisy(build(), rng))


def test_memory_grows_with_the_faces_at_a_vertex_and_not_with_their_square(rng):
    """20,000 triangles at one vertex would be 400 million pairs."""
    mesh = pyramid(20_000, closed=True)
    mesh = mesh.with_vertices(3000 * mesh.vertices + rng.normal(0, 0.2, mesh.vertices.shape))
    tracemalloc.start()
    try:
        report = assert_finite(mesh)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert report.displacement_max > 0
    assert peak < estimated_bytes(mesh.n_vertices, mesh.n_corners, AUTO)


@pytest.mark.parametrize(
    "faces", [[(0, 1, 2), (2, 1, 3)], [(0, 1, 2), (0, 2, 1)], [(0, 1, 2), (3, 2, 1)], [(0, 1, 2, 3)]]
)
def test_two_triangles_and_less(faces, rng):
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]) + rng.normal(0, 0.2, (4, 3))
    for noise in ("AUTO", "WIDE"):
        assert_finite(SurfaceMesh.from_faces(points, faces), AUTO.with_changes(noise=noise))


def test_many_loose_vertices(rng):
    """More than a block of means, so that a block has no neighbors at all; they keep their bits."""
    mesh = noisy(quad_torus(12, 18), rng)
    loose = rng.normal(size=(2 * BLOCK_SIZE + 7, 3))
    behind = SurfaceMesh.from_faces(np.concatenate((mesh.vertices, loose)), faces_of(mesh))
    shifted = [[v + len(loose) for v in face] for face in faces_of(mesh)]
    before = SurfaceMesh.from_faces(np.concatenate((loose, mesh.vertices)), shifted)
    alone = denoise(mesh, AUTO).vertices
    for both, part in ((behind, slice(0, len(mesh.vertices))), (before, slice(len(loose), None))):
        found = denoise(both, AUTO).vertices
        is_loose = np.ones(both.n_vertices, bool)
        is_loose[part] = False
        assert_same_bits(found[is_loose], both.vertices[is_loose])
        assert np.abs(found[part] - alone).max() < 1e-3


def test_faces_without_area_and_duplicate_faces(rng):
    """Coincident vertices, needles, faces that name a vertex twice, one vertex only, or none."""
    mesh = noisy(MESHES["irregular torus"](), rng)
    vertices = mesh.vertices.copy()
    vertices[10] = vertices[11] = vertices[12]
    vertices[50:60] = vertices[50] + np.linspace(0, 1e-12, 10)[:, None]
    assert_finite(mesh.with_vertices(vertices))
    vertices[100] += 1e4
    faces = faces_of(mesh)
    assert_finite(SurfaceMesh.from_faces(vertices, faces))
    faces += [*faces[:9], faces[3][::-1], [5, 5, 6], [7, 8, 7, 8], [9, 9, 9], [3], [4, 5]]
    for k in (0, 7, len(faces)):
        assert_finite(wild_mesh(vertices, [*faces[:k], [], *faces[k:]]))


def test_a_face_that_has_no_area_does_not_spoil_those_around(rng):
    """A vertex on top of its neighbor: the rest is cleaned as without it."""
    mesh = noisy(quad_torus(20, 40), rng)
    vertices = mesh.vertices.copy()
    vertices[100] = vertices[101]
    found, expected = denoise(mesh.with_vertices(vertices), AUTO).vertices, denoise(mesh, AUTO).vertices
    far = np.linalg.norm(mesh.vertices - mesh.vertices[100], axis=1) > 3
    assert np.abs(found - expected)[far].max() < 0.02


def test_faces_that_name_one_vertex_only():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 2, 2)]
    mesh = wild_mesh(points, [(0, 1, 2), (3, 3, 3), (1, 1, 2), (0,), ()])
    result = denoise(mesh, AUTO)
    assert np.isfinite(result.vertices).all()
    assert np.allclose(result.vertices[3], mesh.vertices[3], rtol=0, atol=1e-6)


@pytest.mark.parametrize("noise", ["AUTO", "WIDE"])
def test_faces_of_two_corners_only(noise):
    """They have no normal, so that nothing moves."""
    mesh = wild_mesh(3 * np.eye(4, 3), [(0, 1), (2, 3)])
    assert_same_bits(denoise(mesh, AUTO.with_changes(noise=noise)).vertices, mesh.vertices)


@pytest.mark.parametrize("changes", [{"strength": 0.01}, {"strength": 10.0}, {"passes": 10}, {"passes": 1}])
def test_the_ends_of_the_range(changes, rng):
    mesh = noisy(union(MESHES["mixed sheet"](), soup(1), quad_torus()), rng)
    for noise in ("FINE", "WIDE"):
        assert assert_finite(mesh, AUTO.with_changes(noise=noise, **changes)).displacement_max > 0


def test_very_strong_noise(rng):
    for sigma in (0.8, 3.0, 100.0):
        for name in ("quad torus", "irregular torus", "mixed sheet"):
            assert_finite(noisy(MESHES[name](), rng, sigma))


@pytest.mark.filterwarnings("default")
def test_huge_and_tiny_meshes(rng):
    """As long as the squares of lengths are numbers, size does not matter."""
    mesh = noisy(quad_torus(12, 18), rng)
    expected = denoise(mesh, AUTO).vertices
    for scale in (1e-60, 1e60):
        found = denoise(mesh.with_vertices(mesh.vertices * scale), AUTO).vertices
        assert np.allclose(found / scale, expected, rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("points", "faces"),
    [
        (np.zeros((0, 3)), []),
        (np.eye(3), []),
        (np.zeros((3, 3)), [(0, 1, 2)]),
        (np.full((3, 3), np.nan), [(0, 1, 2)]),
        ([(0, 0, 0), (1, 0, 0), (0, np.inf, 0)], [(0, 1, 2)]),
    ],
)
def test_what_is_no_mesh_is_refused_in_one_sentence(points, faces):
    with pytest.raises(ValueError, match=r"^[A-Z].*\.$") as error:
        denoise(SurfaceMesh.from_faces(points, faces), AUTO)
    assert str(error.value).count(". ") == 0


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("kind", ["bad", "nonmanifold"])
def test_files_give_finite_vertices_or_one_sentence(shared_meshes, kind):
    refused = set()
    for path in mesh_files(shared_meshes, kind):
        try:
            assert_finite(read_mesh(path))
        except ValueError as error:
            assert str(error)[0].isupper() and str(error)[-1] == "."
            refused.add(path.stem)
    names = {"all_coincident", "empty", "nan_vertex", "one_edge", "single_vertex", "wire_polyline"}
    assert refused == (names if kind == "bad" else set())


@pytest.mark.parametrize("seed", [1, 2])
def test_a_shake_that_is_as_good_as_none_changes_nothing(seed, shared_meshes):
    """Single vertices were taken for outliers by chance where nothing moves, and 0.6 edges became of it."""
    mesh = read_mesh(shared_meshes / "tri" / "joint21k.ply")
    edge, settings = edge_length(mesh), PRESETS["MARCHING_CUBES"].settings
    shake = np.random.default_rng(seed).normal(0, 1e-6 * edge, mesh.vertices.shape)
    other = mesh.with_vertices((mesh.vertices + shake).astype(mesh.vertices.dtype))
    moved = denoise(mesh, settings).vertices.astype(float) - mesh.vertices
    change = denoise(other, settings).vertices.astype(float) - other.vertices - moved
    assert np.abs(change).max() < 0.02 * edge
    assert np.sqrt((moved**2).sum(axis=1).mean()) < 0.01 * edge


@pytest.mark.filterwarnings("error")
def test_a_sheet_that_is_stretched_beyond_measure():
    """Areas of its faces are huge beside the squares of local lengths."""
    mesh = quad_grid(5, 6)
    assert np.isfinite(denoise(mesh.with_vertices(mesh.vertices * [1e-9, 1e9, 1]), AUTO).vertices).all()
