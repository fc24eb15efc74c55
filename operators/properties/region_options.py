# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What users set about a region: names, defaults, ranges and words, once for all interfaces."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from ...core.settings.choices import Choice
from ...core.settings.setting_info import check_value, setting_field

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core.limits.region import Region

LIMITS = (
    Choice("NONE", "None", "Vertices move as far as the method moves them"),
    Choice("EDGES", "Edge Lengths", "No vertex moves farther than so many mean edge lengths of its mesh"),
    Choice("LENGTH", "Length", "No vertex moves farther than a length in the scene"),
)

_LIMIT_WORDS = "Farthest that any vertex may move"


@dataclass(frozen=True)
class RegionOptions:
    """Where vertices may move and how far, as users set it.

    Lengths (`max_length`, `weld_distance`) are in scene units.

    Raises
    ------
    ValueError
        On construction, in one sentence, if a value is out of range or not one of the choices.
    """

    vertex_group: str = setting_field(
        "",
        "Vertex Group",
        "Vertices move by their weight in the group of this name: larger weights move farther, vertices with "
        "weight 0 or outside of the group stay; empty moves all",
    )
    invert_group: bool = setting_field(
        False, "Invert", "Vertices move by one minus their weight: larger weights move less"
    )
    face_set: int = setting_field(
        0,
        "Face Set",
        "Only vertices of the face set with this number move, those on its border included; another number "
        "is another set, 0 all of them",
        minimum=0,
        maximum=2**31 - 1,
    )
    keep_hidden: bool = setting_field(
        True,
        "Leave Hidden Alone",
        "Hidden vertices and those of hidden faces stay where they are, in Object Mode too",
    )
    keep_mask: bool = setting_field(
        True,
        "Sculpt Mask",
        "Vertices move by one minus their sculpt mask, in Object Mode too: masked ones stay where they are",
    )
    keep_sharp: bool = setting_field(
        False,
        "Keep Sharp Edges",
        "Edges that are marked sharp or creased stay sharp: their vertices are smoothed along the edges "
        "only, and stay where such edges end, meet or turn a corner",
    )
    limit: str = setting_field(
        "NONE", "Limit", "Whether there is a farthest way for vertices", choices=LIMITS
    )
    max_edges: float = setting_field(
        1.0,
        "Farthest",
        f"{_LIMIT_WORDS}, in mean edge lengths: larger removes stronger noise, smaller stays closer to the "
        "input",
        minimum=0.0,
        maximum=1000.0,
        soft_maximum=5.0,
    )
    max_length: float = setting_field(
        0.01,
        "Farthest",
        f"{_LIMIT_WORDS}, in scene units: larger removes stronger noise, smaller stays closer to the input",
        minimum=0.0,
        maximum=1e9,
        soft_maximum=1.0,
        unit="LENGTH",
    )
    along_normals: bool = setting_field(
        False,
        "Along Normals Only",
        "Vertices move across the surface only, so that textures do not slide; noise along the surface stays",
    )
    keep_volume: bool = setting_field(
        False,
        "Keep Volume",
        "Closed meshes keep their volume: what was lost is given back by moving vertices along the normals",
    )
    weld: bool = setting_field(
        True,
        "Keep Seams Closed",
        "Vertices of borders at exactly the same place count as one for the work and move together, as "
        "triangle soups and split seams need; the mesh keeps all its vertices, faces and UV maps",
    )
    weld_distance: float = setting_field(
        0.0,
        "Merge Distance",
        "Vertices up to so far apart count as one, in scene units: larger welds wider gaps; 0 only vertices "
        "of borders at exactly the same place",
        minimum=0.0,
        maximum=1e9,
        soft_maximum=0.01,
        unit="LENGTH",
    )
    together: bool = setting_field(
        False,
        "Together",
        "The selected objects are one surface for the work: borders of different objects that meet stay "
        "closed and are cleaned as if there was no border, as tiles of a terrain need",
    )
    repair_folds: bool = setting_field(
        True, "Repair Folds", "Where faces would fold over, their vertices move less"
    )

    straighten_borders: bool = setting_field(
        False,
        "Straighten Borders",
        "Frayed and zigzag open borders become as smooth as the inside: each follows its own course, and "
        "corners stay corners",
    )

    flatten_spikes: bool = setting_field(
        False,
        "Flatten Spikes",
        "Single vertices and small clusters far off their surroundings come down to them first; Automatic "
        "does so by itself, the other engines take them for shape",
    )

    def __post_init__(self) -> None:
        for item in fields(self):
            check_value(item.metadata["info"], str(item.type), getattr(self, item.name))

    def region(
        self,
        edge: float,
        scale: float = 1.0,
        weights: NDArray[np.floating] | None = None,
        feature_edges: NDArray[np.integer] | None = None,
        border: NDArray[np.bool_] | None = None,
    ) -> Region:
        """Return the region of one mesh.

        Parameters
        ----------
        edge : float
            Its mean edge length, in its own unit.
        scale : float
            Scene units to one unit of the mesh, of its directions the largest.
        weights : ndarray, shape (N,), or None
            Weights in the vertex group, as they are there.
        feature_edges : ndarray, shape (E, 2), or None
            Its sharp edges.
        border : ndarray, shape (N,), bool, or None
            Its vertices on borders, of which those at the same place are welded; None for all vertices.
        """
        from ...core.limits.region import Region

        if weights is not None and self.invert_group:
            weights = 1.0 - weights
        limit: dict[str, Any] = {
            "NONE": None,
            "EDGES": self.max_edges * edge,
            "LENGTH": _unscaled(self.max_length, scale),
        }
        return Region(
            weights=weights,
            feature_edges=feature_edges if self.keep_sharp else None,
            max_displacement=limit[self.limit],
            along_normals=self.along_normals,
            keep_volume=self.keep_volume,
            weld_distance=_unscaled(self.weld_distance, scale) if self.weld else None,
            weldable=border if self.weld and not self.weld_distance else None,
            repair_folds=self.repair_folds,
            straighten_borders=self.straighten_borders,
            flatten_spikes=self.flatten_spikes,
        )


def _unscaled(length: float, scale: float) -> float:
    """Return a length in the unit of the mesh; a mesh without any size in the scene is left as it is."""
    return length / scale if scale > 0.0 else length
