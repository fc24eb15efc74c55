# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What automatic denoising survives: hostile meshes, odd sizes, and the ends of its range."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from checks import lengths
from framelet.core import PRESETS, SurfaceMesh, blocks, connect, denoise
from framelet.core.automatic import filter as engine
from framelet.core.automatic.problem import NormalProblem
from framelet.core.automatic.recipes import RECIPES
from framelet.core.normals.means import ITEMS_IN_BLOCK
from mesh_files import mesh_files, read_mesh
from meshes import MESHES, bow_tie, clean_soup, faces_of, noisy, pyramid, soup, union

AUTO = PRESETS["AUTO"].settings
pytestmark = pytest.mark.filterwarnings("error")


@pytest.fixture(autouse=True)
def always(monkeypatch):
    """Do not call small meshes clean, whose noise cannot be measured: the recipes must survive them."""
    monkeypatch.setattr(blocks, "available_cores", lambda: 1)
    monkeypatch.setattr(engine, "estimate_noise", Measured(engine.estimate_noise))


class Measured:
    """Measures noise, and says a fifth of an edge where there is none."""

    def __init__(self, estimate):
        self.estimate = estimate

    def __call__(self, surface, *others):
        noise = self.estimate(surface, *others)
        start, end = surface.vertices[surface.edges].astype(float).swapaxes(0, 1)
        sigma = 0.2 * float(np.linalg.norm(end - start, axis=1).mean())
        return noise if noise.sigma > 0 else replace(noise, sigma=sigma)


def assert_finite(mesh, settings=AUTO):
    result = denoise(mesh, settings)
    assert np.isfinite(result.vertices).all()
    assert result.vertices.dtype == mesh.vertices.dtype
    assert result.report.displacement_max <= 2 * np.ptp(mesh.vertices, axis=0).max()
    return result.report


@pytest.mark.parametrize("name", MESHES)
def test_every_mesh_made_in_code(name, rng):
    mesh = MESHES[name]()
    assert_finite(mesh)
    assert_finite(noisy(mesh, rng), AUTO.with_changes(boundary="FREE"))


def test_polygon_soups():
    for seed in range(3):
        for shortest in (1, 3):
            assert_finite(soup(seed, shortest=shortest))
        assert_finite(clean_soup(seed))


@pytest.mark.parametrize(
    "build", [lambda: bow_tie(100), lambda: pyramid(150, closed=True), lambda: pyramid(300, closed=True)]
)
def test_many_fans_and_high_valences(build, rng):
    assert_finite(noisy(build(), rng))


@pytest.mark.parametrize("recipe", [RECIPES[0], RECIPES[-1]], ids=["normals", "positions"])
def test_memory_grows_with_the_faces_at_a_vertex_and_not_with_their_square(recipe, rng):
    """20,000 triangles at one vertex would be 400 million pairs."""
    mesh = pyramid(20_000, closed=True)
    points = 3000 * mesh.vertices.T + rng.normal(0, 0.2, mesh.vertices.T.shape)
    connectivity = connect(mesh)
    tracemalloc.start()
    try:
        problem = NormalProblem(points.astype(np.float32), mesh, connectivity, 0.2, blocks.Blocks(1))
        found = problem.run(recipe)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert np.isfinite(found).all() and lengths(found.T - points.T).max() > 0.01
    assert peak < 2000 * mesh.n_faces


def test_many_loose_vertices(rng):
    """More than a block of means, so that a block has no neighbors at all."""
    mesh = noisy(MESHES["tetrahedron"](), rng)
    loose = rng.normal(size=(ITEMS_IN_BLOCK + 7, 3))
    assert_finite(SurfaceMesh.from_faces(np.concatenate((mesh.vertices, loose)), faces_of(mesh)))
    shifted = [[v + len(loose) for v in face] for face in faces_of(mesh)]
    assert_finite(SurfaceMesh.from_faces(np.concatenate((loose, mesh.vertices)), shifted))


def test_faces_without_area_and_duplicate_faces(rng):
    """Coincident vertices, needles, faces that name a vertex twice, one vertex only, or none."""
    mesh = noisy(MESHES["irregular torus"](), rng)
    vertices = mesh.vertices.copy()
    vertices[10] = vertices[11] = vertices[12]
    vertices[50:60] = vertices[50] + np.linspace(0, 1e-12, 10)[:, None]
    vertices[100] += 1e4
    faces = faces_of(mesh)
    assert_finite(SurfaceMesh.from_faces(vertices, faces))
    faces += [*faces[:9], faces[3][::-1], [5, 5, 6], [7, 8, 7, 8], [9, 9, 9], [3], [4, 5]]
    for k in (0, 7, len(faces)):
        assert_finite(SurfaceMesh.from_faces(vertices, [*faces[:k], [], *faces[k:]]))


def test_faces_that_name_one_vertex_only():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 2, 2)]
    mesh = SurfaceMesh.from_faces(points, [(0, 1, 2), (3, 3, 3), (1, 1, 2), (0,), ()])
    result = denoise(mesh, AUTO)
    assert np.isfinite(result.vertices).all()
    assert np.allclose(result.vertices[3], mesh.vertices[3], rtol=0, atol=1e-6)


@pytest.mark.parametrize("strength", [0.05, 10.0])
def test_the_ends_of_the_range(strength, rng):
    mesh = noisy(union(MESHES["mixed sheet"](), soup(1)), rng)
    assert assert_finite(mesh, AUTO.with_changes(strength=strength)).displacement_max > 0


@pytest.mark.filterwarnings("default")
def test_huge_and_tiny_meshes(rng):
    """As long as the squares of lengths are numbers, size does not matter."""
    mesh = noisy(MESHES["quad torus"](), rng)
    expected = denoise(mesh, AUTO, dtype=np.float64).vertices
    for scale in (1e-60, 1e60):
        found = denoise(mesh.with_vertices(mesh.vertices * scale), AUTO, dtype=np.float64).vertices
        assert np.allclose(found / scale, expected, rtol=1e-6)


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
