# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""On any mesh every frame is rebuilt, has the adjoint that it says, and is tight where it says so."""

import warnings

import numpy as np
from checks import lengths
from frame_checks import check_frame
from framelet.core import BANKS, FrameError
from framelet.core.frames.valence_masks import FAMILIES
from hypothesis import assume, given
from hypothesis import strategies as st

from .generated import SEEDS, TAME, meshes, one_sentence
from .profile import examples

LARGEST = 200
"""Vertices: the matrix of the transform is written out."""


@examples()
@given(
    meshes((*TAME, "degenerate faces", "coincident vertices", "spikes")),
    st.sampled_from([*BANKS, *FAMILIES]),
    st.integers(1, 3),
    st.sampled_from(["STRAIGHT", "MEAN", "ADAPTIVE"]),
    SEEDS,
)
def test_every_frame_on_any_mesh(mesh, frame, levels, stencil, seed):
    assume(0 < mesh.n_vertices <= LARGEST)
    assume(stencil != "ADAPTIVE" or frame in FAMILIES)  # which it replaces
    rng = np.random.default_rng(seed)
    # Rounding must not choose between neighbors: ties are broken by far more.
    points = mesh.vertices + rng.normal(0, 0.05, mesh.vertices.shape)
    assume(lengths(points).max() < 1e4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            check_frame(mesh.with_vertices(points), frame, levels, stencil, rng)
        except FrameError as error:
            one_sentence(error)
