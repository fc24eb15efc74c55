# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All banks and stencils pass one and the same routine, on regular, irregular, open and mixed meshes."""

import numpy as np
import pytest
from checks import read_only
from frame_checks import check_frame
from framelet.core import (
    BANKS,
    FilterBank,
    FrameError,
    FrameTransform,
    MeshError,
    SettingError,
    SurfaceMesh,
    TooLargeError,
)
from framelet.core.frames.valence_masks import FAMILIES
from framelet.core.mesh.connectivity import connect
from framelet.core.settings.frame_catalog import FRAME_CATALOG
from meshes import MESHES, faces_of, flipped, klein_bottle, noisy, quad_torus, triangle_torus, turned_over

SHAPES = {
    "triangle torus": lambda: triangle_torus(6, 8),
    "flipped torus": lambda: flipped(triangle_torus(6, 8)),
    "quad torus": lambda: quad_torus(6, 7),
    "mixed sheet": MESHES["mixed sheet"],
    "irregular grid": MESHES["irregular grid"],
}
FITTING = {entry.identifier: entry.lattice for entry in FRAME_CATALOG}


@pytest.mark.parametrize(
    ("shape", "levels"), [*((shape, 1) for shape in SHAPES), ("flipped torus", 2), ("mixed sheet", 2)]
)
@pytest.mark.parametrize("frame", [*BANKS, *FAMILIES])
def test_every_frame_on_every_mesh(frame, shape, levels, rng):
    mesh = read_only(noisy(SHAPES[shape](), rng))
    more = {"BOX_SPLINE_111": ("MEAN",), "ADAPTIVE": ("ADAPTIVE",)} if levels == 1 else {}
    for stencil in ("STRAIGHT", *more.get(frame, ())):
        try:
            check_frame(mesh, frame, levels, stencil, rng)
        except FrameError as error:
            # Frames for quads on triangles, and levels that reach beyond a small mesh.
            assert (FITTING[frame] == "QUADS" and "quads" in str(error)) or "too small" in str(error)


@pytest.mark.parametrize(
    ("frame", "shape"), [("BOX_SPLINE_111", "triangle torus"), ("LINEAR_SPLINE", "quad torus")]
)
def test_the_papers_frames_are_tight_where_the_mesh_is_regular(frame, shape):
    assert FrameTransform(SHAPES[shape](), frame).is_tight
    assert not FrameTransform(SHAPES[shape](), frame, 2).is_tight
    assert not FrameTransform(SHAPES["mixed sheet"](), frame).is_tight


@pytest.mark.parametrize("frame", ["LINEAR_SPLINE", "B_SPLINE_4", "B_SPLINE_6"])
def test_wide_frames_are_tight_where_faces_can_agree(frame, rng):
    """Around a surface of one side some walks turn to the left and some to the right."""
    turned = turned_over(quad_torus(12, 14), seed=1, share=0.2)
    for mesh, is_tight in ((turned, True), (klein_bottle(12, 14), frame == "LINEAR_SPLINE")):
        assert FrameTransform(mesh, frame).is_tight == is_tight
        check_frame(mesh, frame, rng=rng)


def test_a_bank_of_ones_own_passes(rng):
    haar = np.array([[1, 1, 1, 1], [1, -1, -1, 1], [1, 1, -1, -1], [1, -1, 1, -1]]) / 4
    bank = FilterBank("MINE", "ANY", [(0, 0), (0, 1), (1, 1), (1, 0)], haar)
    for shape in ("quad torus", "triangle torus"):
        check_frame(read_only(noisy(SHAPES[shape](), rng)), bank, 1, rng=rng)


@pytest.mark.parametrize(
    ("shape", "frame"),
    [("triangle torus", "BOX_SPLINE_111"), ("quad torus", "LINEAR_SPLINE"), ("mixed sheet", "ADAPTIVE")],
)
def test_auto_takes_what_fits(shape, frame):
    mesh = SHAPES[shape]()
    assert FrameTransform(mesh).frame == FrameTransform(mesh.vertices, faces_of(mesh), "Auto").frame == frame


def test_what_does_not_fit_is_refused():
    mesh = SHAPES["quad torus"]()
    transform = FrameTransform(mesh, "linear-spline", 2)
    with pytest.raises(FrameError, match="The frame is 'NONE'; choose one of AUTO, BOX_SPLINE_111, "):
        FrameTransform(mesh, "none")
    with pytest.raises(MeshError, match=r"shape \(41, 3\); the transform needs \(42, 3\)"):
        transform.analyze(mesh.vertices[:-1])
    low, *details = transform.analyze(mesh.vertices)
    with pytest.raises(FrameError, match="There are 2 arrays of coefficients; expected the low-pass and 2"):
        transform.synthesize([low, details[0]])
    with pytest.raises(FrameError, match=r"have shape \(7, 42, 3\); expected \(8, 42, 3\)"):
        transform.adjoint([low, details[0][:7], details[1]])
    big = SurfaceMesh.from_faces(np.zeros((5000, 3)) + np.eye(5000, 3), [(0, 1, 2)])
    with pytest.raises(TooLargeError, match="5,000 vertices; matrices are for 4,096 at most"):
        FrameTransform(big, "ADAPTIVE").to_dense()
    assert not connect(mesh).is_boundary.any() and issubclass(SettingError, ValueError)


def test_bounds_of_a_large_mesh_are_inside(rng):
    mesh = noisy(flipped(triangle_torus(20, 30)), rng)
    transform = FrameTransform(mesh)
    exact, found = transform.frame_bounds(mesh.n_vertices), transform.frame_bounds(40)
    assert exact[0] - 1e-9 <= found[0] and found[1] <= exact[1] + 1e-9
    assert found[1] == pytest.approx(exact[1], rel=1e-3)
