# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What cleaning normals leaves alone, does not depend on, and survives."""

import numpy as np
import pytest
from checks import AS_SOLVED, assert_same_bits, lengths, random_rotation
from framelet.core import PRESETS, DenoiseSettings, SurfaceMesh, blocks, connect, denoise
from framelet.core.blocks import Blocks
from framelet.core.normals import filter as engine
from framelet.core.normals import pilot
from framelet.core.surface.geometry import vertex_normals
from framelet.core.transform import adaptive_level
from mesh_files import mesh_files, read_mesh
from meshes import MESHES, clean_soup, faces_of, noisy, pyramid, soup, triangle_grid, union
from stars import relabeled

PRESET = pytest.mark.parametrize("preset", ["FREE_FORM", "PRISMATIC"])
RUNS = {
    "plain": PRESETS["FREE_FORM"].settings,
    "sharp": DenoiseSettings(method="NORMALS", sharpness=0.05, average_steps=2, vertex_steps=5),
    "no averages": DenoiseSettings(method="NORMALS", average_steps=0),
}
RUN = pytest.mark.parametrize("run", ["plain", "sharp"])
UNMOVED = 1e-5
"""Mean edge lengths that rounding may move a vertex in float32; the meshes are about ten edges wide."""

MOVED = {
    "mixed": lambda: union(
        *(MESHES[name]() for name in ("mixed sheet", "prism", "octahedron", "irregular grid"))
    ),
    "turned over": MESHES["turned-over sheet"],
    "non-manifold": lambda: union(MESHES["three pages"](), MESHES["bow tie"]()),
}
FLAT = {
    "triangles": triangle_grid,
    "quads": MESHES["quad grid"],
    "uneven": MESHES["irregular grid"],
    "one triangle": lambda: SurfaceMesh.from_faces([(0, 0, 0), (1, 0, 0), (0.3, 0.9, 0)], [(0, 1, 2)]),
    "one quad": MESHES["single quad"],
    "one hexagon": lambda: SurfaceMesh.from_faces(
        [(np.cos(k * np.pi / 3), np.sin(k * np.pi / 3), 0) for k in range(6)], [range(6)]
    ),
    "collinear face": lambda: SurfaceMesh.from_faces(
        [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0), (1, -1, 0)],
        [(0, 2, 4), (0, 4, 3), (0, 1, 2), (0, 5, 1), (1, 5, 2)],
    ),
}


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Few iterations of the pilot, on one thread unless told: what is tested here holds for any number."""
    monkeypatch.setattr(blocks, "available_cores", lambda: 1)
    for module in (engine, pilot):
        monkeypatch.setattr(module, "ITERATIONS", 3)


def solved(mesh, run, **given):
    """Return the vertices of a float64 run that moves them well."""
    result = denoise(mesh, RUNS[run], dtype=np.float64, **given)
    assert result.report.displacement_rms > 0.01 * result.report.mean_edge_length
    return result.vertices


@pytest.mark.parametrize(
    ("name", "run"),
    # Without averages a face without area would have whatever normal rounding gives it.
    [(name, run) for name in FLAT for run in RUNS if (name, run) != ("collinear face", "no averages")],
)
def test_flat_meshes_come_back_unchanged(name, run, rng):
    """Also tilted, with neighbors of any shape, and with a face that has no normal of its own."""
    settings, mesh = RUNS[run], FLAT[name]()
    moved = denoise(mesh, settings).vertices - mesh.vertices
    assert (moved[:, 2] == 0).all()
    assert lengths(moved).max() < UNMOVED
    jitter = 0.1 * rng.normal(size=mesh.vertices.shape) * [1, 1, 0] * (name != "collinear face")
    tilted = mesh.with_vertices((mesh.vertices + jitter) @ random_rotation(rng) + 3.0)
    assert lengths(denoise(tilted, settings).vertices - tilted.vertices).max() < UNMOVED
    assert lengths(denoise(tilted, settings, dtype=np.float64).vertices - tilted.vertices).max() < 1e-12


@RUN
@pytest.mark.parametrize("file", ["flat_triangles.obj", "flat_quads.obj"])
def test_flat_files_come_back_unchanged(shared_meshes, file, run):
    mesh = read_mesh(shared_meshes / "bad" / file)
    assert lengths(denoise(mesh, RUNS[run]).vertices - mesh.vertices).max() < UNMOVED


@RUN
@pytest.mark.parametrize("name", MOVED)
def test_moving_turning_scaling_and_renumbering(name, run, rng):
    """Far away float64 keeps 2e-9 of a position; a negative scale and a mirror turn the mesh inside out."""
    mesh = noisy(MOVED[name](), rng)
    expected = solved(mesh, run)
    rotation = random_rotation(rng)
    for turn in (rotation, -3.0 * rotation, 1e-6 * rotation * [1, 1, -1]):
        found = solved(mesh.with_vertices(mesh.vertices @ turn), run)
        assert lengths(found @ np.linalg.inv(turn) - expected).max() < 1e-9
    shift = np.array([1e7, -1e7, 1e7])
    far = mesh.with_vertices(mesh.vertices + shift)
    near = mesh.with_vertices(far.vertices - shift)  # with the digits that survive
    assert lengths(solved(far, run) - shift - solved(near, run)).max() < 1e-7
    other, old = relabeled(mesh, rng)
    assert lengths(solved(other, run) - expected[old]).max() < 1e-9
    assert lengths(denoise(mesh, RUNS[run]).vertices - expected).max() < 1e-4


@RUN
def test_turning_all_faces_over(run, rng):
    mesh = noisy(MESHES["irregular torus"](), rng)
    other = SurfaceMesh.from_faces(mesh.vertices, [face[::-1] for face in faces_of(mesh)])
    assert lengths(solved(other, run) - solved(mesh, run)).max() < 1e-9


@RUN
def test_threads_and_blocks_do_not_change_a_bit(run, rng, monkeypatch):
    monkeypatch.setattr(adaptive_level, "SLOTS_PER_CHUNK", 2**9)
    mesh = noisy(union(triangle_grid(12, 20), *(MESHES[name]() for name in ("mixed sheet", "bow tie"))), rng)
    results, changes = [], []
    for threads, size in ((1, 100), (2, 100), (4, 100), (2, 10**6)):
        monkeypatch.setattr(Blocks.__init__, "__defaults__", (0, size))
        settings, seen = RUNS[run].with_changes(threads=threads, vertex_steps=3), []
        results.append(denoise(mesh, settings, callback=lambda *given, seen=seen: seen.append(given)))
        changes.append(seen)
        assert_same_bits(results[-1].vertices, results[0].vertices)
    assert mesh.n_vertices > 2 * 100
    assert changes[0] == changes[1] == changes[2]


@RUN
def test_fractions_rise_to_one_and_true_stops(run, rng):
    """The normals take all but the last calls; stopped among those, nothing has moved."""
    mesh = noisy(MESHES["mixed sheet"](), rng)
    settings = RUNS[run]
    seen = []
    denoise(mesh, settings, callback=lambda *given: bool(seen.append(given)))
    total, n_steps = len(seen), settings.vertex_steps
    assert [fraction for fraction, _ in seen] == pytest.approx(np.arange(1, total + 1) / total)
    assert seen[-1][0] == 1.0
    assert [change > 0 for _, change in seen] == [False] * (total - n_steps) + [True] * n_steps
    assert total - n_steps >= 3 + 4
    for wanted in (1, total - n_steps, total - n_steps + 1, total - 1):
        calls = []
        stopped = denoise(mesh, settings, callback=lambda *_: len(calls.append(0) or calls) == wanted)  # noqa: B023
        steps = max(wanted - (total - n_steps), 0)
        assert len(calls) == wanted
        assert stopped.report.is_stopped
        assert stopped.report.iterations == steps
        same = denoise(mesh, settings.with_changes(vertex_steps=steps)).vertices if steps else mesh.vertices
        assert_same_bits(stopped.vertices, same)


@RUN
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_vertices_that_may_not_move_keep_their_bits(run, dtype, rng):
    """Because of the mask, a fixed boundary, or because they are loose."""
    mesh = noisy(union(MESHES["mixed sheet"](), MESHES["irregular torus"]()), rng)
    mesh.vertices[::2, 1] = -0.0
    mesh = mesh.with_vertices(mesh.vertices.astype(dtype))
    connectivity = connect(mesh)
    movable = rng.random(mesh.n_vertices) < 0.5
    stays = ~movable | connectivity.is_boundary | connectivity.is_loose
    assert (connectivity.is_loose.sum(), connectivity.is_boundary.sum()) == (3, 22)
    result = denoise(mesh, RUNS[run].with_changes(boundary="FIXED"), movable=movable, region=AS_SOLVED)
    assert_same_bits(result.vertices[stays], mesh.vertices[stays])
    assert (result.vertices[~stays] != mesh.vertices[~stays]).any(axis=1).all()
    assert result.report.n_moved == (~stays).sum()


@RUN
def test_corners_of_a_border_move_along_their_normals_only(run, rng):
    mesh = noisy(triangle_grid(), rng)
    corners = [0, 8, 63, 71]
    moved = (solved(mesh, run) - mesh.vertices)[corners]
    assert lengths(np.cross(moved, vertex_normals(mesh)[corners])).max() < 1e-12
    assert lengths(moved).min() > 1e-6


def assert_finite(mesh, settings):
    result = denoise(mesh, settings)
    assert np.isfinite(result.vertices).all()
    assert result.report.displacement_max <= 2 * np.ptp(mesh.vertices, axis=0).max()
    assert result.vertices.dtype == mesh.vertices.dtype


@PRESET
def test_soups_and_meshes_made_in_code(preset, rng):
    settings = PRESETS[preset].settings.with_changes(passes=1)
    for seed in range(5):
        assert_finite(soup(seed, shortest=1 + 2 * (seed % 2)), settings)
        assert_finite(clean_soup(seed), settings)
    for build in (*MESHES.values(), lambda: pyramid(150, closed=True)):
        assert_finite(noisy(build(), rng), settings)


@PRESET
def test_faces_without_area_and_duplicate_faces(preset, rng):
    """Coincident vertices, needles, faces that name a vertex twice, one vertex only, or none."""
    mesh = noisy(MESHES["irregular torus"](), rng)
    vertices = mesh.vertices.copy()
    vertices[10] = vertices[11] = vertices[12]
    vertices[50:60] = vertices[50] + np.linspace(0, 1e-12, 10)[:, None]
    vertices[100] += 1e4
    faces = faces_of(mesh)
    faces += [*faces[:9], faces[3][::-1], [5, 5, 6], [7, 8, 7, 8], [9, 9, 9], [3], [4, 5]]
    assert_finite(SurfaceMesh.from_faces(vertices, faces), PRESETS[preset].settings)
    for k in (0, 7, len(faces)):
        some_empty = SurfaceMesh.from_faces(vertices, [*faces[:k], [], *faces[k:]])
        assert_finite(some_empty, PRESETS[preset].settings)


@pytest.mark.parametrize("kind", ["bad", "nonmanifold"])
def test_files_give_finite_vertices_or_one_sentence(shared_meshes, kind):
    refused = set()
    for path in mesh_files(shared_meshes, kind):
        mesh = read_mesh(path)
        for preset in ("FREE_FORM", "PRISMATIC"):
            try:
                assert_finite(mesh, PRESETS[preset].settings.with_changes(passes=1))
            except ValueError as error:
                message = str(error)
                assert message[0].isupper() and message[-1] == "." and message.count(". ") == 0, message
                refused.add((path.stem, preset))
    names = {"all_coincident", "empty", "nan_vertex", "one_edge", "single_vertex", "wire_polyline"}
    expected = {(name, preset) for name in names for preset in ("FREE_FORM", "PRISMATIC")}
    assert refused == (expected if kind == "bad" else set())
