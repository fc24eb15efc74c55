# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The method AUTO, by the door: what it does not depend on, what stays, and what its settings do."""

from itertools import pairwise

import numpy as np
import pytest
from checks import AS_SOLVED, assert_same_bits, lengths, random_rotation, read_only
from framelet.core import (
    PRESETS,
    NoiseBelief,
    PreparationCache,
    SurfaceMesh,
    add_noise,
    compare,
    connect,
    denoise,
    prepare,
)
from known_shapes import SHAPES, cube, edge_of, hexagons, lifted, sphere, white, wide
from meshes import (
    MESHES,
    bow_tie,
    faces_of,
    flipped,
    mixed_sheet,
    noisy,
    pyramid,
    quad_grid,
    quad_torus,
    triangle_grid,
    triangle_torus,
    turned_over,
    union,
)
from stars import relabeled

AUTO = PRESETS["AUTO"].settings
SINGLE = 2e-3
"""Mean edge lengths by which rounding may change a result: the kernels work in single precision."""


def all_kinds_of_faces():
    """Return an open sheet of quads, triangles and a hexagon, of some size."""
    faces = faces_of(quad_grid(14, 17))
    split = [t for f in faces[:90] for t in (f[:3], [f[0], f[2], f[3]])]
    points = quad_grid(14, 17).vertices.copy()
    points[:, 2] = np.sin(0.3 * points[:, 0]) + np.cos(0.4 * points[:, 1])
    hexagon = [*faces[120][:2], *faces[121][1:], faces[120][3]]
    return SurfaceMesh.from_faces(points, [*split, *faces[90:120], hexagon, *faces[122:]])


def three_sheets():
    """Return three sheets that share an edge line, which is non-manifold."""
    sheet, n = triangle_grid(9, 14), 14
    number = np.arange(sheet.n_vertices)
    points, faces = [sheet.vertices], list(faces_of(sheet))
    for turn in (2.0, 4.0):
        own = sheet.vertices @ np.array([[1, 0, 0], [0, np.cos(turn), np.sin(turn)], [0, 0, 1]])
        moved = np.where(number < n, number, number + sum(map(len, points)) - n)
        faces += [moved[face].tolist() for face in faces_of(sheet)]
        points.append(own[n:])
    return SurfaceMesh.from_faces(np.concatenate(points), faces)


MOVED = {
    "closed": lambda: flipped(triangle_torus()),
    "open": lambda: flipped(triangle_grid(), seed=1),
    "quads": lambda: quad_torus(12, 18),
    "polygons": lambda: hexagons(triangle_torus(10, 16)),
    "mixed": lambda: union(all_kinds_of_faces(), flipped(triangle_torus(10, 14))),
    "turned over": lambda: turned_over(flipped(triangle_torus())),
    "non-manifold": three_sheets,
}
SMALL = {
    "mixed": lambda: union(mixed_sheet(), pyramid(9), flipped(triangle_torus(6, 7))),
    "non-manifold": lambda: union(MESHES["three pages"](), bow_tie(3)),
}
MESH = pytest.mark.parametrize("name", MOVED)


pytestmark = pytest.mark.usefixtures("one_thread")


def solved(mesh, **given):
    """Return the vertices of a run that moves them well."""
    result = denoise(mesh, AUTO, **given)
    assert result.report.displacement_rms > 0.01 * result.report.mean_edge_length
    return result.vertices


def apart(found, expected, mesh):
    """Return the largest distance in mean edges."""
    return lengths(found - expected).max() / edge_of(mesh)


@MESH
def test_moving_turning_and_scaling_commute_with_it(name, rng):
    mesh = noisy(MOVED[name](), rng)
    expected, rotation, shift = solved(mesh), random_rotation(rng), np.array([3.25, -7.5, 1.0])
    assert apart(solved(mesh.with_vertices(mesh.vertices @ rotation)), expected @ rotation, mesh) < SINGLE
    assert apart(solved(mesh.with_vertices(mesh.vertices + shift)) - shift, expected, mesh) < SINGLE
    for scale in (1e-6, 3e6):
        found = solved(mesh.with_vertices(mesh.vertices * scale)) / scale
        assert apart(found, expected, mesh) < SINGLE


@MESH
def test_renumbering_commutes_with_it(name, rng):
    """Vertices, faces, and the corner that a face begins with; with so little noise that nothing folds."""
    mesh = noisy(MOVED[name](), rng, 0.1)
    expected = solved(mesh)
    other, old = relabeled(mesh, rng)
    assert apart(solved(other), expected[old], mesh) < SINGLE


@pytest.mark.parametrize("name", SMALL)
def test_small_islands_turn_with_the_mesh(name, rng):
    """Also where averages shrink them to nothing."""
    for _ in range(3):
        mesh, rotation = noisy(SMALL[name](), rng), random_rotation(rng)
        turned = denoise(mesh.with_vertices(mesh.vertices @ rotation), AUTO).vertices
        assert apart(turned, denoise(mesh, AUTO).vertices @ rotation, mesh) < 0.02


@pytest.mark.parametrize("shape", SHAPES)
def test_meshes_that_are_inside_out_are_cleaned_as_well(shape, rng):
    """Not to the digit: the net tells ridges from valleys."""
    clean = SHAPES[shape]()
    mesh = lifted(clean, 0.2 * white(clean, rng))
    over = SurfaceMesh.from_faces(mesh.vertices, [face[::-1] for face in faces_of(mesh)])
    plain, found = (
        compare(clean.with_vertices(denoise(own, AUTO).vertices), clean).mean_angle for own in (mesh, over)
    )
    assert found < 1.6 * plain


@MESH
def test_the_input_is_not_touched_and_its_precision_is_kept(name, rng):
    """In double precision what is added is as exact as a displacement in single precision can be."""
    mesh = noisy(MOVED[name](), rng, 0.1)  # with more, rounding decides which faces are unfolded
    double = denoise(read_only(mesh), AUTO, dtype=np.float64)
    single = denoise(mesh, AUTO)
    assert double.vertices.dtype == single.vertices.dtype == mesh.vertices.dtype == np.float64
    assert apart(double.vertices, single.vertices, mesh) < SINGLE
    coarse = mesh.with_vertices(mesh.vertices.astype(np.float32))
    found = denoise(coarse, AUTO).vertices
    assert found.dtype == np.float32
    assert apart(found, single.vertices, mesh) < SINGLE


def test_far_away_no_digit_is_lost(rng):
    mesh, shift = noisy(MOVED["closed"](), rng), np.array([1e7, -1e7, 1e7])
    far = mesh.with_vertices(mesh.vertices + shift)
    near = mesh.with_vertices(far.vertices - shift)  # with the digits that survive
    assert apart(solved(far) - shift, solved(near), mesh) < SINGLE


@pytest.mark.parametrize("name", ["closed", "mixed", "polygons"])
def test_threads_do_not_change_a_bit(name, rng):
    """With blocks so small that there are many."""
    mesh = noisy(union(MOVED[name](), MOVED[name]()), rng)
    results = [
        denoise(mesh, AUTO.with_changes(threads=threads), prepared=prepare(mesh, AUTO, block_size=100))
        for threads in (1, 2, 3)
    ]
    for result in results[1:]:
        assert_same_bits(result.vertices, results[0].vertices)
        assert result.report.noise == results[0].report.noise


def test_runs_after_one_another_give_the_same_bits(rng):
    """Also with all that a mesh needs made before, for other settings.

    The noise is not measured as wide here, so that saying that it is wide makes a difference.
    """
    mesh, cache = noisy(union(MOVED["quads"](), MOVED["polygons"]()), rng), PreparationCache()
    expected = denoise(mesh, AUTO).vertices
    for changes in ({}, {"strength": 2.0}, {"noise": "WIDE"}, {"passes": 1}, {}):
        found = denoise(mesh, AUTO.with_changes(**changes), prepared=cache).vertices
        assert np.array_equal(found, expected) == (not changes)


def test_other_positions_of_a_prepared_mesh_give_the_same_bits(rng):
    """Also where other edges are long then, and neighborhoods are others."""
    mesh, cache = noisy(MOVED["closed"](), rng), PreparationCache()
    points = mesh.vertices.copy()
    points[40] += 50
    far, near = mesh.with_vertices(points), noisy(mesh, rng, 0.05)
    for own in (mesh, near, far, near, mesh, far):
        assert_same_bits(denoise(own, AUTO, prepared=cache).vertices, denoise(own, AUTO).vertices)


@pytest.mark.parametrize("passes", [1, 2, 3])
def test_progress_rises_to_one(passes, rng):
    mesh, seen = noisy(MOVED["closed"](), rng), []
    result = denoise(mesh, AUTO.with_changes(passes=passes), callback=lambda *given: bool(seen.append(given)))
    fractions = [fraction for fraction, _ in seen]
    assert fractions == sorted(set(fractions)) and fractions[0] > 0
    assert fractions[-1] == pytest.approx(1.0, abs=1e-9) and max(fractions) <= 1
    assert len(fractions) >= 8 * passes and max(np.diff(fractions)) < 0.2
    assert result.report.iterations == passes and not result.report.is_stopped
    # How far the last pass moved vertices from where the one before had left them; unknown before the first.
    changes = [change for _, change in seen]
    assert np.isnan(changes[0]) and min(change for change in changes if not np.isnan(change)) > 0
    if passes == 3:
        left = denoise(mesh, AUTO.with_changes(passes=2)).vertices
        moved = np.sqrt((lengths(result.vertices - left) ** 2).mean())
        assert changes[-1] * result.report.mean_edge_length == pytest.approx(moved, rel=0.02)


def test_a_run_that_is_stopped_gives_the_last_pass(rng):
    """At every second step: the input, or what fewer passes give."""
    mesh, settings, seen = noisy(MOVED["closed"](), rng), AUTO.with_changes(passes=3), []
    denoise(mesh, settings, callback=lambda *given: bool(seen.append(given)))
    results = [mesh.vertices, *(denoise(mesh, AUTO.with_changes(passes=k)).vertices for k in (1, 2, 3))]
    reached = []
    for wanted in range(1, len(seen) + 1, 2):
        calls = []
        stopped = denoise(mesh, settings, callback=lambda *_: len(calls.append(0) or calls) == wanted)  # noqa: B023
        assert len(calls) == wanted and stopped.report.is_stopped
        reached.append(stopped.report.iterations)
        assert_same_bits(stopped.vertices, results[reached[-1]])
    assert reached == sorted(reached) and set(reached) >= {0, 1, 2}
    with pytest.raises(ZeroDivisionError):
        denoise(mesh, AUTO, callback=lambda *_: 1 / 0)


def test_it_stops_soon_when_asked(rng):
    """Between two blocks, wherever that is; then nothing has moved."""
    mesh = noisy(MOVED["mixed"](), rng)
    asked = []
    denoise(mesh, AUTO, should_stop=lambda: bool(asked.append(0)))
    assert len(asked) > 100
    for wanted in (1, len(asked) // 3, len(asked) // 2, len(asked) - 1):
        calls = []
        result = denoise(mesh, AUTO, should_stop=lambda: len(calls.append(0) or calls) >= wanted)  # noqa: B023
        assert result.report.is_stopped
        assert_same_bits(result.vertices, mesh.vertices)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_vertices_that_may_not_move_keep_their_bits(dtype, rng):
    """Because of the mask, a fixed boundary, or because they are loose."""
    mesh = noisy(union(mixed_sheet(), flipped(triangle_torus())), rng)
    mesh.vertices[::2, 1] = -0.0
    mesh = mesh.with_vertices(mesh.vertices.astype(dtype))
    connectivity = connect(mesh)
    movable = rng.random(mesh.n_vertices) < 0.5
    stays = ~movable | connectivity.is_boundary | connectivity.is_loose
    result = denoise(mesh, AUTO.with_changes(boundary="FIXED"), movable=movable, region=AS_SOLVED)
    assert_same_bits(result.vertices[stays], mesh.vertices[stays])
    assert (result.vertices[~stays] != mesh.vertices[~stays]).any(axis=1).mean() > 0.9


def test_borders(rng):
    """They stay, or move as the fit moves them, which pulls nothing along them: ALONG and FREE are alike."""
    mesh = noisy(triangle_grid(17, 17), rng)
    is_rim = connect(mesh).is_boundary
    moved = {
        boundary: denoise(mesh, AUTO.with_changes(boundary=boundary), region=AS_SOLVED).vertices
        - mesh.vertices
        for boundary in ("FIXED", "ALONG", "FREE")
    }
    assert not moved["FIXED"][is_rim].any()
    for boundary in ("ALONG", "FREE"):
        assert lengths(moved[boundary][is_rim]).mean() > 0.01
    assert_same_bits(moved["ALONG"], moved["FREE"])
    for motion in moved.values():
        assert lengths(motion[~is_rim]).mean() > 0.02


def test_borders_do_not_shrink(rng):
    """A flat sheet with noise keeps its size and becomes flat up to its rim."""
    clean = triangle_grid(21, 21)
    found = denoise(lifted(clean, 0.2 * white(clean, rng)), AUTO).vertices
    is_rim = connect(clean).is_boundary
    assert np.ptp(found[:, 0]) > 19.8 and np.ptp(found[:, 1]) > 19.8
    assert np.abs(found[~is_rim, 2]).mean() < 0.08
    assert np.abs(found[is_rim, 2]).mean() < 0.16


@pytest.mark.parametrize("name", SHAPES)
def test_clean_shapes_keep_every_bit(name, rng):
    for mesh in (
        SHAPES[name](),
        SHAPES[name]().with_vertices(SHAPES[name]().vertices @ random_rotation(rng) + 9),
    ):
        result = denoise(mesh, AUTO)
        assert_same_bits(result.vertices, mesh.vertices)
        assert result.report.n_moved == 0 and result.report.noise.is_clean


@pytest.mark.parametrize("noise", ["AUTO", "FINE"])
def test_what_is_clean_does_not_depend_on_strength(noise, rng):
    """A clean sphere stays, and of one with spikes the same vertices move."""
    clean, cache = SHAPES["sphere"](), PreparationCache()
    spiky = lifted(clean, 3.0 * (rng.random(clean.n_vertices) < 0.01))
    moved = []
    for strength in (0.25, 0.5, 1.0, 2.0, 4.0):
        settings = AUTO.with_changes(noise=noise, strength=strength)
        assert denoise(clean, settings, prepared=cache).report.noise.is_clean
        result = denoise(spiky, settings, prepared=cache, region=AS_SOLVED)
        moved.append((result.vertices != spiky.vertices).any(axis=1))
    assert 0 < moved[0].sum() < clean.n_vertices / 2
    assert all(np.array_equal(which, moved[0]) for which in moved)


@pytest.mark.parametrize(
    "name", ["triangle grid", "irregular grid", "quad grid", "single triangle", "single quad"]
)
def test_flat_meshes_keep_every_bit(name, rng):
    mesh = MESHES[name]()
    jitter = 0.1 * rng.normal(size=mesh.vertices.shape) * [1, 1, 0]
    for points in (mesh.vertices, (mesh.vertices + jitter) @ random_rotation(rng) + 3.0):
        assert_same_bits(denoise(mesh.with_vertices(points), AUTO).vertices, np.ascontiguousarray(points))


def test_a_flat_part_stays_flat_beside_noise(rng):
    """Half of a box is noisy; its other half keeps every bit."""
    clean = cube()
    is_noisy = clean.vertices[:, 0] > 8
    mesh = clean.with_vertices(
        np.where(is_noisy[:, None], lifted(clean, 0.2 * white(clean, rng)).vertices, clean.vertices)
    )
    found = denoise(mesh, AUTO).vertices
    is_far = clean.vertices[:, 0] < 6.5
    assert_same_bits(found[is_far], mesh.vertices[is_far])
    assert not (found == mesh.vertices).all(axis=1)[clean.vertices[:, 0] > 10].any()
    assert compare(clean.with_vertices(found), clean).rms_distance < 0.5 * compare(mesh, clean).rms_distance


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_strength_zero_is_identity(dtype, rng):
    for name, build in MOVED.items():
        mesh = noisy(build(), rng)
        mesh = mesh.with_vertices(mesh.vertices.astype(dtype))
        result = denoise(mesh, AUTO.with_changes(strength=0.0), dtype=dtype)
        assert_same_bits(result.vertices, mesh.vertices)
        assert result.report.n_moved == 0, name


@pytest.mark.parametrize(("shape", "sigma"), [("sphere", 0.15), ("quad part", 0.3)])
def test_strength_has_no_jumps(shape, sigma, rng):
    """From 0 to 4 in steps of 0.05, finer where it is steep and coarser from 2 on; more always takes more."""
    clean = SHAPES[shape]()
    mesh, cache = lifted(clean, sigma * white(clean, rng)), PreparationCache()

    def steps(strengths):
        results = [
            denoise(mesh, AUTO.with_changes(strength=float(s)), prepared=cache).vertices for s in strengths
        ]
        moved = [np.sqrt((lengths(b - a) ** 2).mean()) for a, b in pairwise(results)]
        angles = [compare(clean.with_vertices(x), mesh).mean_angle for x in results[::5]]
        assert min(np.diff(angles)) > -0.1  # degrees
        return np.array(moved), np.sqrt((lengths(results[-1] - results[0]) ** 2).mean())

    coarse, way = steps(np.concatenate((np.linspace(0, 2, 41), np.linspace(2.2, 4, 10))).round(2))
    assert coarse.max() < 0.2 * way and coarse[10:].max() < 0.12 * way and coarse[20:].max() < 0.08 * way
    fine, _ = steps(np.linspace(0.2, 0.4, 21).round(2))
    assert fine.max() < 0.05 * way


@pytest.mark.parametrize("shape", ["sphere", "torus", "quad torus", "part"])
def test_noise_settings_are_in_order(shape, rng):
    """The wider noise is said to be, the more of wide noise goes."""
    clean = SHAPES[shape]()
    smooth = lifted(clean, 0.2 * wide(clean, rng, 2))
    left, moved = [], []
    for noise in ("FINE", "AUTO", "WIDE"):
        result = denoise(smooth, AUTO.with_changes(noise=noise))
        left.append(compare(clean.with_vertices(result.vertices), clean).mean_angle)
        moved.append(result.report.displacement_rms)
    assert left[2] < 1.02 * min(left) and left[1] < 1.06 * left[0]
    assert left[2] < 0.98 * left[0] and moved[0] < moved[2]


@pytest.mark.parametrize("shape", ["sphere", "torus", "quad torus", "part"])
def test_noise_over_several_edges_goes_where_it_is_said_to_be_wide(shape, rng):
    clean = SHAPES[shape]()
    smooth = lifted(clean, 0.2 * wide(clean, rng, 6))
    found = clean.with_vertices(denoise(smooth, AUTO.with_changes(noise="WIDE")).vertices)
    assert compare(found, clean).mean_angle < 0.95 * compare(smooth, clean).mean_angle


def test_fine_and_wide_both_clean_white_noise(rng):
    clean = sphere()
    mesh = lifted(clean, 0.2 * white(clean, rng))
    for noise in ("FINE", "AUTO", "WIDE"):
        found = clean.with_vertices(denoise(mesh, AUTO.with_changes(noise=noise)).vertices)
        assert compare(found, clean).mean_angle < 0.2 * compare(mesh, clean).mean_angle


def test_more_passes_clean_strong_noise_on_a_machine_part_better(rng):
    clean = cube()
    mesh = lifted(clean, 0.35 * white(clean, rng))
    angles = [
        compare(clean.with_vertices(denoise(mesh, AUTO.with_changes(passes=k)).vertices), clean).mean_angle
        for k in (1, 2, 3)
    ]
    assert angles[2] < angles[1] < angles[0]


def test_the_report_tells_what_was_taken_for_noise(rng):
    clean = sphere()
    mesh = clean.with_vertices(add_noise(clean, 0.2, seed=0))
    report = denoise(mesh, AUTO).report
    assert report.settings == AUTO and isinstance(report.noise, NoiseBelief)
    assert 0.12 < report.noise.sigma / report.mean_edge_length < 0.25
    assert report.flipped_faces <= 0.01 * clean.n_faces
