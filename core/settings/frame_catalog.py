# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of all frames: a frame that is entered here is a choice everywhere.

It holds names and words only, so that user interfaces can list the frames without loading numpy.
"""

from __future__ import annotations

from typing import NamedTuple


class FrameEntry(NamedTuple):
    """A frame: its name, its words, the faces it is made for, and where its `FilterBank` stands.

    `lattice` is TRIANGLES, QUADS or ANY. `module`, below `core.frames`, holds the bank under the name
    `identifier`; it is empty for frames whose masks fit the valence (`frames.valence_masks`).
    """

    identifier: str
    label: str
    description: str
    lattice: str
    module: str


FRAME_CATALOG = (
    FrameEntry(
        "BOX_SPLINE_111",
        "Box Spline",
        "Triangles: linear box spline in three directions, six high-pass masks (3.5); the paper's choice",
        "TRIANGLES",
        "box_spline",
    ),
    FrameEntry(
        "BOX_SPLINE_111_CANONICAL",
        "Box Spline, Canonical",
        "Triangles: the same low-pass with seven high-pass masks (3.8)",
        "TRIANGLES",
        "box_spline",
    ),
    FrameEntry(
        "BOX_SPLINE_FOUR_DIRECTION",
        "Box Spline, Four Directions",
        "Cells: box spline in four directions, eleven high-pass masks (Example 3.2); smoother",
        "ANY",
        "four_direction",
    ),
    FrameEntry(
        "LINEAR_SPLINE",
        "Linear Spline",
        "Quads: bilinear spline, eight high-pass masks (5.1); the paper's choice",
        "QUADS",
        "linear_spline",
    ),
    FrameEntry(
        "LINEAR_SPLINE_REDUCED",
        "Linear Spline, Reduced",
        "Quads: the same low-pass with five high-pass masks (5.4)",
        "QUADS",
        "linear_spline",
    ),
    FrameEntry(
        "B_SPLINE_1", "B-Spline 1 (Haar)", "Cells: 2x2 masks, the most local frame", "ANY", "b_spline"
    ),
    FrameEntry(
        "B_SPLINE_2", "B-Spline 2", "Quads: 3x3 masks, the linear spline up to signs", "QUADS", "b_spline"
    ),
    FrameEntry("B_SPLINE_3", "B-Spline 3", "Cells: 4x4 masks of the quadratic spline", "ANY", "b_spline"),
    FrameEntry("B_SPLINE_4", "B-Spline 4", "Quads: 5x5 masks of the cubic spline", "QUADS", "b_spline"),
    FrameEntry("B_SPLINE_5", "B-Spline 5", "Cells: 6x6 masks, wide and smooth", "ANY", "b_spline"),
    FrameEntry(
        "B_SPLINE_6", "B-Spline 6", "Quads: 7x7 masks, the widest and smoothest frame", "QUADS", "b_spline"
    ),
    FrameEntry(
        "ADAPTIVE",
        "Adaptive",
        "Any mesh: masks that fit each vertex's valence; exactly tight at every vertex",
        "ANY",
        "",
    ),
    FrameEntry(
        "PAIRWISE",
        "Pairwise",
        "Any mesh: low-pass and all differences within a one-ring; exactly tight, many bands",
        "ANY",
        "",
    ),
)
