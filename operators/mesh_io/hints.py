# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What about an object makes a result other than expected, and the way out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bpy.app.translations import pgettext_rpt as rpt_

from ..properties.scene_units import linear_part

if TYPE_CHECKING:
    import bpy

    from ...core import NoiseEstimate

UNEVEN = 1.05
"""Largest scale over the smallest from which noise in the mesh is not that in the scene."""


def hints(obj: bpy.types.Object, noise: NoiseEstimate | None = None) -> list[str]:
    """Return what is to say about an object that was denoised, in words without a full stop; often nothing.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object.
    noise : NoiseEstimate, optional
        What the run took for noise.
    """
    import numpy as np

    from ...core import NoiseBelief
    from ...core.noise import TERRACES, VOXELS

    found = []
    scales = np.linalg.svd(linear_part(obj), compute_uv=False)
    if scales[0] > UNEVEN * scales[-1]:
        found.append(rpt_("the object is scaled unevenly: apply its scale (Ctrl A) and denoise again"))
    if any(each.type == "SUBSURF" and each.show_viewport and each.levels for each in obj.modifiers):
        found.append(rpt_("the cage was denoised: to clean what Subdivision shows, apply it first"))
    if not isinstance(noise, NoiseBelief):
        return found
    if noise.steps == VOXELS:
        found.append(rpt_("it is made of voxels: the preset Marching Cubes / CT rounds the steps"))
    if noise.steps == TERRACES:
        found.append(rpt_("its heights are in whole steps: the preset Paper Tri-2 takes them away"))
    if noise.is_doubtful:
        found.append(rpt_("if what is left is noise, it is several edges wide: set Noise to Wide"))
    return found
