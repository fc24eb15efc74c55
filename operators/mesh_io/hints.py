# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What about an object makes a result other than expected, and the way out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bpy.app.translations import pgettext_rpt as rpt_

from ..properties.scene_units import linear_part
from .steps import TERRACES, VOXELS

if TYPE_CHECKING:
    import bpy

UNEVEN = 1.05
"""Largest scale over the smallest from which noise in the mesh is not that in the scene."""


def hints(obj: bpy.types.Object, steps: str = "") -> list[str]:
    """Return what is to say about an object that was denoised, in words without a full stop; often nothing.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object.
    steps : str
        What `steps.find_steps` said of its mesh.
    """
    import numpy as np

    found = []
    scales = np.linalg.svd(linear_part(obj), compute_uv=False)
    if scales[0] > UNEVEN * scales[-1]:
        found.append(rpt_("the object is scaled unevenly: apply its scale (Ctrl A) and denoise again"))
    if any(each.type == "SUBSURF" and each.show_viewport and each.levels for each in obj.modifiers):
        found.append(rpt_("the cage was denoised: to clean what Subdivision shows, apply it first"))
    if steps == VOXELS:
        found.append(rpt_("it is made of voxels: the preset Marching Cubes / CT rounds the steps"))
    if steps == TERRACES:
        found.append(rpt_("its heights are in whole steps: the preset Paper Tri-2 takes them away"))
    return found
