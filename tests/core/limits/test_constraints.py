# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which vertices stay, which move along a line only, and that what stays keeps its bits."""

import numpy as np
import pytest
from checks import AS_SOLVED, TRIANGLE_PRESETS, assert_same_bits, lengths, preset_settings, read_only
from framelet.core import denoise
from framelet.core.mesh.connectivity import connect
from framelet.core.mesh.geometry import vertex_normals
from framelet.core.mesh.surface_mesh import SurfaceMesh
from meshes import MESHES, faces_of, flipped, mixed_sheet, noisy, triangle_grid, triangle_torus, union

PRESET = pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
DTYPE = pytest.mark.parametrize("dtype", [np.float32, np.float64])


def settings_of(preset, **changes):
    return preset_settings(preset, **changes)


def as_type(mesh, dtype):
    return mesh.with_vertices(mesh.vertices.astype(dtype))


def bumpy_grid(rng, rows=9, columns=11):
    """Return a grid with noise in z everywhere; its border is straight seen from above."""
    mesh = triangle_grid(rows, columns)
    return mesh.with_vertices(mesh.vertices + rng.normal(0, 0.2, (mesh.n_vertices, 1)) * [0, 0, 1])


@PRESET
@DTYPE
def test_inputs_are_not_written_to_and_the_dtype_stays(preset, dtype, rng):
    mesh = as_type(noisy(mixed_sheet(), rng), dtype)
    frozen = read_only(mesh)
    movable = np.ones(mesh.n_vertices, bool)
    movable.flags.writeable = False
    result = denoise(frozen, settings_of(preset), movable=movable)
    assert result.vertices.dtype == dtype
    assert_same_bits(frozen.vertices, mesh.vertices)
    assert result.vertices.flags.writeable
    assert not np.shares_memory(result.vertices, frozen.vertices)
    assert_same_bits(denoise(mesh, settings_of(preset)).vertices, result.vertices)


@PRESET
@DTYPE
def test_only_movable_vertices_move(preset, dtype, rng):
    mesh = as_type(noisy(flipped(triangle_torus()), rng), dtype)
    movable = rng.random(mesh.n_vertices) < 0.3
    result = denoise(mesh, settings_of(preset), movable=movable, region=AS_SOLVED)
    assert_same_bits(result.vertices[~movable], mesh.vertices[~movable])
    assert (result.vertices[movable] != mesh.vertices[movable]).any(axis=1).all()
    assert result.report.n_moved == movable.sum()


@PRESET
@DTYPE
def test_vertices_that_stay_keep_negative_zeros(preset, dtype, rng):
    mesh = noisy(triangle_grid(), rng)
    vertices = mesh.vertices.astype(dtype)
    vertices[::2, 1] = -0.0
    movable = np.arange(mesh.n_vertices) % 4 == 1
    result = denoise(mesh.with_vertices(vertices), settings_of(preset), movable=movable)
    assert_same_bits(result.vertices[~movable], vertices[~movable])


@PRESET
@pytest.mark.parametrize("boundary", ["FIXED", "ALONG", "FREE"])
def test_loose_parts_stay(preset, boundary, rng):
    mesh = noisy(mixed_sheet(), rng)
    result = denoise(mesh, settings_of(preset, boundary=boundary))
    loose = connect(mesh).is_loose
    assert loose.sum() == 3
    assert_same_bits(result.vertices[loose], mesh.vertices[loose])


@PRESET
@pytest.mark.parametrize("far", [1e4, 1e8, 1e30])
def test_a_loose_vertex_far_away_changes_nothing(preset, far, rng):
    """Stray points are common in scans; the solver's center must not follow them."""
    mesh = noisy(flipped(triangle_torus()), rng)
    plain = denoise(mesh, settings_of(preset)).vertices
    points = np.concatenate((mesh.vertices, [[far, -far, 2 * far]]))
    result = denoise(SurfaceMesh.from_faces(points, faces_of(mesh)), settings_of(preset)).vertices
    assert_same_bits(result[-1:], points[-1:])
    assert lengths(result[:-1] - plain).max() < 1e-4


@PRESET
def test_parts_far_apart_are_cleaned_alike(preset, rng):
    """At 300 edge lengths float32 still leaves five digits of an edge length."""
    torus = noisy(flipped(triangle_torus()), rng)
    result = denoise(union(torus, *[torus] * 19), settings_of(preset)).vertices
    first = result[: torus.n_vertices]
    last = result[-torus.n_vertices :] - [19 * 20.0, 0, 0]
    assert lengths(first - last).max() < 1e-3


@PRESET
def test_a_fixed_border_stays(preset, rng):
    for name in ("irregular grid", "moebius strip", "mixed sheet", "three pages", "bow tie"):
        mesh = noisy(MESHES[name](), rng)
        rim = connect(mesh).is_boundary
        result = denoise(mesh, settings_of(preset, boundary="FIXED"))
        assert_same_bits(result.vertices[rim], mesh.vertices[rim])


@pytest.mark.parametrize("preset", ["TRI_1", "TRI_2"])
def test_along_keeps_a_straight_border(preset, rng):
    """Noise in z: the border smooths along itself, stays in its four walls, and does not shrink.

    Around the corners there is no noise, so that their normals point straight up.
    """
    mesh = bumpy_grid(rng)
    vertices = mesh.vertices.copy()
    near_side = np.minimum(vertices[:, 0], 10 - vertices[:, 0]) < 2
    near_end = np.minimum(-vertices[:, 1], 8 + vertices[:, 1]) < 2
    vertices[near_side & near_end, 2] = 0.0
    mesh = mesh.with_vertices(vertices)
    result = denoise(mesh, settings_of(preset, iterations=100), dtype=np.float64).vertices
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    corners = [0, 10, 88, 98]
    sides = [(x == 0, 0), (x == 10, 0), (y == 0, 1), (y == -8, 1)]
    for side, axis in sides:
        side = side.copy()
        side[corners] = False
        assert np.abs(result[side, axis] - mesh.vertices[side, axis]).max() < 1e-12
        z, before = result[side, 2], mesh.vertices[side, 2]
        assert np.std(np.diff(z, 2)) < 0.6 * np.std(np.diff(before, 2))


@PRESET
def test_corners_move_along_their_normals_only(preset, rng):
    mesh = bumpy_grid(rng)
    corners = [0, 10, 88, 98]
    result = denoise(mesh, settings_of(preset), dtype=np.float64).vertices
    moved = (result - mesh.vertices)[corners]
    assert lengths(np.cross(moved, vertex_normals(mesh)[corners])).max() < 1e-12
    if settings_of(preset).shrinkage == "VECTOR" or preset == "BILATERAL":
        assert lengths(moved).min() > 1e-6
    else:  # what shrinkage by coordinates does to a corner is not parallel to its plane
        assert not moved.any()


@PRESET
def test_corners_that_are_not_movable_stay(preset, rng):
    mesh = bumpy_grid(rng)
    movable = np.ones(mesh.n_vertices, bool)
    movable[[0, 98]] = False
    result = denoise(mesh, settings_of(preset), movable=movable).vertices
    assert_same_bits(result[~movable], mesh.vertices[~movable])


@pytest.mark.parametrize("preset", ["TRI_1", "TRI_2"])
def test_free_borders_shrink_and_others_do_not(preset):
    mesh = triangle_grid(9, 9)
    width = {}
    for boundary in ("FIXED", "ALONG", "FREE"):
        result = denoise(mesh, settings_of(preset, boundary=boundary, iterations=30)).vertices
        width[boundary] = np.ptp(result[:, :2], axis=0).min()
    assert width["FIXED"] == 8
    assert width["ALONG"] == pytest.approx(8, abs=1e-5)
    assert width["FREE"] < 7.9


@pytest.mark.parametrize(
    ("movable", "message"),
    [
        (np.ones(3, bool), r"mask of movable vertices is bool of shape \(3,\); expected bool \(72,\)"),
        (np.ones(72, int), r"mask of movable vertices is int64 of shape \(72,\); expected bool \(72,\)"),
        (np.ones((72, 1), bool), r"shape \(72, 1\)"),
        (np.zeros(72, bool), "No vertex may move; select at least one"),
    ],
)
def test_wrong_masks_are_refused(movable, message):
    with pytest.raises(ValueError, match=message):
        denoise(triangle_grid(), movable=movable)


@pytest.mark.parametrize(
    ("mesh", "message"),
    [
        (SurfaceMesh.from_faces(np.zeros((0, 3)), []), "The mesh is empty; it needs vertices and faces"),
        (SurfaceMesh.from_faces(np.eye(3), [], [(0, 1)]), "has 3 vertices but no faces; only surfaces"),
        (SurfaceMesh.from_faces(np.ones((3, 3)), [(0, 1, 2)]), "All faces have shrunk to points"),
        (SurfaceMesh.from_faces(1e300 * np.eye(3), [(0, 1, 2)]), "too large to measure its edges"),
        (
            SurfaceMesh.from_faces([(0, 0, 0), (1, 0, 0), (0, np.nan, 0)], [(0, 1, 2)]),
            r"Vertex 2 at \(0, nan, 0\) is",
        ),
        (
            SurfaceMesh.from_faces([(np.inf, 0, 0), (1, 0, 0), (0, np.nan, 0)], [(0, 1, 2)]),
            r"Vertex 0 at \(inf, 0, 0\) and 1 more are not finite points; delete or move it first",
        ),
    ],
)
@PRESET
@pytest.mark.filterwarnings("ignore:overflow encountered")
def test_meshes_that_cannot_be_cleaned_are_refused(mesh, message, preset):
    with pytest.raises(ValueError, match=message):
        denoise(mesh, settings_of(preset))
