# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The equalizer (section 9): S' is the inverse transform of {g_j high_j, low}; gain 1 changes no bit."""

import numpy as np
import pytest
from checks import assert_same_bits, lengths, random_rotation, read_only
from framelet.core import SurfaceMesh, connect, equalize, make_transform
from meshes import MESHES, flipped, mixed_sheet, noisy, quad_torus, triangle_grid, triangle_torus, union

FRAMES = ["BOX_SPLINE_111", "LINEAR_SPLINE_REDUCED", "B_SPLINE_3", "ADAPTIVE"]
FRAME = pytest.mark.parametrize("frame", FRAMES)
EXACT = 1e-11


def mesh_for(frame, rng):
    """Return a noisy mesh with the faces that a frame is made for, and others."""
    quads = union(quad_torus(5, 6), mixed_sheet())
    triangles = union(flipped(triangle_torus(6, 7)), mixed_sheet())
    return read_only(noisy(quads if "LINEAR" in frame else triangles, rng))


def exact(mesh, gains, frame="AUTO", **options):
    return equalize(mesh, gains, frame=frame, dtype=np.float64, **options)


@FRAME
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_gains_of_one_change_no_bit(frame, dtype, rng):
    mesh = mesh_for(frame, rng)
    vertices = mesh.vertices.astype(dtype)
    vertices[::3, 2] = -0.0
    for gains in ([1.0], np.ones(2)):
        assert_same_bits(equalize(mesh.with_vertices(vertices), gains, frame=frame), vertices)


@FRAME
def test_linear_in_the_gains(frame, rng):
    """S'(g) - S is a sum over the levels of (g_j - 1) times what that level adds."""
    mesh = mesh_for(frame, rng)
    first = exact(mesh, [2, 1], frame) - mesh.vertices
    second = exact(mesh, [1, 2], frame) - mesh.vertices
    assert min(lengths(first).max(), lengths(second).max()) > 0.05
    for gains in ([0.0, 0.0], [0.5, 3.0]):
        expected = mesh.vertices + (gains[0] - 1) * first + (gains[1] - 1) * second
        assert lengths(exact(mesh, gains, frame) - expected).max() < EXACT


@FRAME
@pytest.mark.parametrize("boundary", ["ALONG", "FREE"])
def test_is_the_inverse_of_scaled_details(frame, boundary, rng):
    """On a closed surface nothing is held; gain 0 everywhere leaves the synthesis of the low-pass alone."""
    mesh = noisy(quad_torus(5, 6) if "LINEAR" in frame else flipped(triangle_torus(6, 7)), rng)
    transform = make_transform(mesh, frame, "STRAIGHT", 2)
    found = transform.analyze(mesh.vertices)
    for gains in ([0.0, 0.0], [0.3, 1.7]):
        details = [gain * found.details(level) for level, gain in enumerate(gains)]
        expected = transform.synthesize(found.with_details(details, found.low))
        result = exact(mesh, gains, frame, boundary=boundary)
        assert lengths(result - expected).max() < EXACT
        assert lengths(result - mesh.vertices).max() > 0.05


def test_automatic_takes_the_frame_that_fits(rng):
    for build, frame in (
        (triangle_grid, "BOX_SPLINE_111"),
        (quad_torus, "LINEAR_SPLINE"),
        (mixed_sheet, "ADAPTIVE"),
    ):
        mesh = noisy(build(), rng)
        assert_same_bits(equalize(mesh, [0.5]), equalize(mesh, [0.5], frame=frame))


def test_more_gain_is_more_detail(rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    transform = make_transform(mesh)
    bands = [
        lengths(transform.analyze(equalize(mesh, [gain])).details(0)[:3]).mean() for gain in (0, 0.5, 1, 2)
    ]
    assert bands == sorted(bands)
    assert bands[0] < 0.8 * bands[2] < 0.6 * bands[3]


@FRAME
def test_weights_take_their_share_of_the_change(frame, rng):
    mesh = mesh_for(frame, rng)
    weights = rng.uniform(size=mesh.n_vertices)
    weights[::4] = 0.0
    whole = exact(mesh, [0.2, 2.0], frame)
    result = exact(mesh, [0.2, 2.0], frame, weights=weights)
    expected = mesh.vertices + weights[:, None] * (whole - mesh.vertices)
    assert lengths(result - expected).max() < EXACT
    assert_same_bits(result[::4], mesh.vertices[::4])
    assert_same_bits(exact(mesh, [0.2, 2.0], frame, weights=np.ones(mesh.n_vertices)), whole)


@FRAME
def test_rotation_and_scale_and_place(frame, rng):
    mesh = mesh_for(frame, rng)
    rotation, shift = random_rotation(rng), rng.normal(size=3)
    moved = mesh.with_vertices(3.0 * mesh.vertices @ rotation + shift)
    expected = 3.0 * exact(mesh, [0.5, 2.0], frame) @ rotation + shift
    assert lengths(exact(moved, [0.5, 2.0], frame) - expected).max() < 1e-10


@FRAME
def test_float32_is_close_and_threads_change_no_bit(frame, rng):
    mesh = mesh_for(frame, rng)
    single = mesh.with_vertices(mesh.vertices.astype(np.float32))
    results = [equalize(single, [0.5, 2.0], frame=frame, threads=threads) for threads in (1, 2, 4)]
    assert results[0].dtype == np.float32
    assert_same_bits(results[0], results[1])
    assert_same_bits(results[0], results[2])
    full = exact(single.with_vertices(single.vertices.astype(np.float64)), [0.5, 2.0], frame)
    assert lengths(results[0] - full).max() < 1e-4


@FRAME
def test_fixed_borders_and_loose_parts_stay(frame, rng):
    mesh = mesh_for(frame, rng)
    connectivity = connect(mesh)
    fixed = equalize(mesh, [0.0, 3.0], frame=frame, boundary="FIXED")
    assert_same_bits(fixed[connectivity.is_boundary], mesh.vertices[connectivity.is_boundary])
    moves = lengths(equalize(mesh, [0.0, 3.0], frame=frame) - mesh.vertices) > 0
    assert moves[connectivity.is_boundary].any()
    assert connectivity.is_loose.sum() == 3
    assert not moves[connectivity.is_loose].any()


@pytest.mark.parametrize("frame", ["BOX_SPLINE_111", "ADAPTIVE"])
def test_corners_of_a_flat_sheet_stay(frame):
    """Their details lie in the plane, and would round them off."""
    mesh = triangle_grid(9, 11)
    corners = [0, 10, 88, 98]
    for gains in ([0.0], [3.0], [0.0, 0.0], [0.2, 2.5]):
        result = exact(mesh, gains, frame)
        assert np.abs(result[:, 2]).max() < 1e-12
        assert np.abs(result[corners] - mesh.vertices[corners]).max() < 1e-12
        if frame == "BOX_SPLINE_111" and len(gains) == 1:
            assert np.abs(result - mesh.vertices).max() < 1e-12


def test_inputs_are_not_written_to(rng):
    mesh = mesh_for("AUTO", rng)
    before = mesh.vertices.copy()
    weights = np.ones(mesh.n_vertices)
    weights.flags.writeable = False
    result = equalize(mesh, (0.5, 0.5), weights=weights, connectivity=connect(mesh))
    assert not np.shares_memory(result, mesh.vertices)
    assert_same_bits(mesh.vertices, before)


NOTHING = SurfaceMesh.from_faces(np.zeros((0, 3)), [])


@pytest.mark.parametrize(
    ("mesh", "gains", "options", "message"),
    [
        (None, [], {}, r"^There are no gains; give one for each level, finest first\.$"),
        (None, [1, np.nan], {}, r"^The gain of level 2 is nan; it must be between 0 and 100\.$"),
        (None, [-0.5], {}, r"^The gain of level 1 is -0\.5; it must be between 0 and 100\.$"),
        (None, [100.1], {}, r"^The gain of level 1 is 100\.1; it must be between 0 and 100\.$"),
        (None, [np.inf], {}, r"^The gain of level 1 is inf; it must be between 0 and 100\.$"),
        (
            None,
            [1] * 9,
            {},
            r"^The mesh is too small for \d levels: nothing is \d+ edges apart; use \d levels? or",
        ),
        (
            None,
            [1],
            {"frame": "B_SPLINE_2"},
            "^B_SPLINE_2 is a frame for quads, but the mesh has none; use a box",
        ),
        (None, [1], {"frame": "HAAR"}, "^The frame is 'HAAR'; choose one of "),
        (None, [1], {"stencil": "BEST"}, "^The stencil is 'BEST'; choose one of MEAN, STRAIGHT"),
        (None, [1], {"boundary": "OPEN"}, "(B|b)oundary is 'OPEN'; choose one of "),
        (None, [2], {"weights": np.ones(3)}, r"^The weights have shape \(3,\); expected \(72,\)\.$"),
        (
            None,
            [2],
            {"weights": np.full(72, np.nan)},
            r"^The weight of vertex 0 is nan; it must be from 0 to 1",
        ),
        (NOTHING, [1], {}, "^The mesh is empty; it needs vertices and faces"),
        (
            MESHES["single triangle"](),
            [1],
            {"frame": "B_SPLINE_1"},
            "needs quads or pairs of triangles, but the mesh",
        ),
    ],
)
def test_what_cannot_be_done_is_refused_in_one_sentence(mesh, gains, options, message):
    with pytest.raises(ValueError, match=message) as error:
        equalize(mesh or triangle_grid(), gains, **options)
    assert str(error.value).endswith(".")
    assert str(error.value).count(". ") == 0
