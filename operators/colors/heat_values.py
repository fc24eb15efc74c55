# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last run of an object changed or took for noise, a number for each vertex or face corner."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from bpy.app.translations import pgettext_n as n_

from ..mesh_io.band_storage import HEAT_COLORS, NOISE, NOISE_WIDTH
from ..mesh_io.own_names import kind_refusal, names_refusal
from ..properties.scene_units import linear_part, surface_in_scene, turning
from ..run.run_memory import recall

if TYPE_CHECKING:
    import bpy

    from ..bands.band_values import BandValues


class Quantity(NamedTuple):
    """Something that a run changes: how it is called, its unit, and on which elements of a mesh it lives.

    `unit` is LENGTH, ANGLE or EDGES.
    """

    title: str
    is_signed: bool
    unit: str
    domain: str
    attribute: str = ""
    """Name of the attribute that has the numbers, besides the colors; empty for none."""


QUANTITIES = {
    "NORMAL": Quantity(n_("Displacement along normals"), True, "LENGTH", "POINT"),
    "LENGTH": Quantity(n_("Displacement"), False, "LENGTH", "POINT"),
    "ANGLE": Quantity(n_("Angle change of faces"), False, "ANGLE", "CORNER"),
    "NOISE": Quantity(n_("Noise"), False, "LENGTH", "POINT", NOISE),
    "WIDTH": Quantity(n_("Noise width in edges"), False, "EDGES", "POINT", NOISE_WIDTH),
}


def heat_values(obj: bpy.types.Object, quantity: str) -> BandValues:
    """Return what the last run of an object changed.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object that was denoised, as it was before or after the run.
    quantity : str
        NORMAL or LENGTH of the displacement, at the vertices, in scene units; ANGLE between the normals of a
        face before and after, at its corners, in degrees; strength in scene units of the NOISE that was taken
        away, and its WIDTH in edges, at the vertices.

    Raises
    ------
    ValueError
        In one sentence, if the mesh was not denoised or was changed since.
    """
    from ..bands.band_values import BandValues

    reason = names_refusal(obj) or kind_refusal(obj, f"{HEAT_COLORS}|{QUANTITIES[quantity].attribute}")
    if reason is not None:
        raise ValueError(reason)
    run, surface, _ = recall(obj)
    before = surface_in_scene(obj, surface.with_vertices(run.before))
    after = surface_in_scene(obj, surface.with_vertices(run.after))
    import numpy as np

    from ...core import noise_field
    from ...core.mesh.geometry import face_normals, vertex_normals
    from ...core.metrics import normal_angles

    if quantity == "ANGLE":
        # A face without area has no normal that could turn.
        angles = np.nan_to_num(normal_angles(face_normals(before), face_normals(after)))
        return BandValues(obj, angles.repeat(surface.face_sizes()))
    if quantity in ("NOISE", "WIDTH"):
        strength, width = noise_field(before, after.vertices)
        return BandValues(obj, (strength if quantity == "NOISE" else width).astype(np.float64))
    moved = after.vertices.astype(np.float64) - before.vertices
    if quantity == "LENGTH":
        return BandValues(obj, np.sqrt(np.square(moved).sum(axis=1)))
    # The normals of the result, which is what one looks at; those from before are noisy themselves.
    outwards = vertex_normals(after) * turning(linear_part(obj))
    return BandValues(obj, (moved * outwards).sum(axis=1))
