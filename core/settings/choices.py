# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The values of the settings that are chosen from lists, with their words."""

from __future__ import annotations

from typing import NamedTuple

from .frame_catalog import FRAME_CATALOG


class Choice(NamedTuple):
    """One value of a setting that is chosen from a list."""

    identifier: str
    label: str
    description: str


METHODS = (
    Choice(
        "AUTO",
        "Automatic",
        "Learned shrinkage: cleans the directions of the faces, then fits the vertices; keeps features",
    ),
    Choice("POSITIONS", "Positions (paper)", "Split Bregman on vertex positions with a tight wavelet frame"),
    Choice(
        "BILATERAL", "Bilateral", "Bilateral mesh filtering (Fleishman et al. 2003), the paper's baseline"
    ),
)
NOISES = (
    Choice("AUTO", "Automatic", "What the mesh shows; fine relief stays where it can be told from noise"),
    Choice("FINE", "Fine", "Different from vertex to vertex; what is wider is taken for relief"),
    Choice("WIDE", "Wide", "Smooth over several edges, or steps of voxels; fine relief goes too"),
)
TUNINGS = (
    Choice("GIVEN", "As Set", "The values that are set"),
    Choice("NOISE", "From Noise", "From the measured noise, for each mesh its own"),
)
FRAMES = (
    Choice("AUTO", "Automatic", "Box spline on triangles, linear spline on quads, adaptive on anything else"),
    *(Choice(entry.identifier, entry.label, entry.description) for entry in FRAME_CATALOG),
)
STENCILS = (
    Choice(
        "MEAN",
        "Mean",
        "At irregular vertices every tap is the mean of the one-ring; smooths more, blurs edges",
    ),
    Choice(
        "STRAIGHT",
        "Straight",
        "At irregular vertices neighbors are paired along the straightest lines; keeps edges",
    ),
    Choice("ADAPTIVE", "Adaptive", "Masks fit each vertex's valence, whatever the frame; exactly tight"),
)
SHRINKAGES = (
    Choice(
        "BANDS", "Bands", "Each coordinate is shrunk by its norm over all bands (4.5); depends on the axes"
    ),
    Choice(
        "VECTOR", "Vector", "Each band is shrunk by the length of its vector; does not depend on the axes"
    ),
    Choice("SCALAR", "Scalar", "Each number is shrunk by itself (5.5); depends on the axes"),
)
BOUNDARIES = (
    Choice("FIXED", "Fixed", "Boundary vertices do not move"),
    Choice(
        "ALONG",
        "Along",
        "Boundaries are smoothed along themselves and are not pulled inwards; corners keep their place",
    ),
    Choice(
        "FREE",
        "Free",
        "Boundary vertices move like all others, so that open borders shrink, but not with Automatic, which "
        "treats them as Along does",
    ),
)
