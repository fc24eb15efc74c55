# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The output Modifier: the mesh keeps its positions, and what denoising moved is an attribute."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..mesh_io import mesh_bridge
from ..mesh_io.own_names import kind_refusal, names_refusal
from . import attributes
from .inputs import get_input, set_input
from .node_groups import ON
from .recipes import AMOUNT, DENOISE_RECIPE, DISPLACEMENT
from .stack import attach, find_modifier, place_refusal

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh


def refusal(obj: bpy.types.Object) -> str | None:
    """Say in one sentence why an object cannot get the modifier; None if it can."""
    reason = mesh_bridge.ownership_refusal(obj)
    if reason is not None:
        return reason
    reason = mesh_bridge.mode_refusal(obj)
    if reason is not None:
        return reason
    if not obj.is_editable:
        return f"‘{obj.name}’ is linked, so that it cannot get a modifier; make it local first."
    reason = names_refusal(obj) or kind_refusal(obj, DENOISE_RECIPE.terms[0].attribute)
    return reason or place_refusal(obj, DISPLACEMENT) or mesh_bridge.faces_refusal(obj)


def store_displacement(
    obj: bpy.types.Object, surface: SurfaceMesh, vertices: NDArray[np.floating], amount: float = 1.0
) -> NDArray[np.float32]:
    """Store where denoising moves the vertices of an object, and give it the modifier that moves them.

    Parameters
    ----------
    obj : bpy.types.Object
        The object that was read; `refusal` gives no reason against it. One that has the modifier already
        keeps the values of its inputs.
    surface : SurfaceMesh
        The mesh as it was read; its positions stay.
    vertices : ndarray, shape (N, 3)
        New positions in object space.
    amount : float
        How much of the motion a new modifier shows.

    Returns
    -------
    ndarray, shape (N, 3), float32
        The new positions, as they are shown with the amount 1.
    """
    positions = mesh_bridge.with_moved(surface, vertices)
    attributes.write_vectors(obj.data, DENOISE_RECIPE.terms[0].attribute, positions - surface.vertices)
    attributes.mark_cage(obj.data, surface)
    modifier = attach(obj, DENOISE_RECIPE, {AMOUNT: amount})
    if not get_input(modifier, ON):
        set_input(modifier, ON, True)  # a new result is shown
    return positions


def stored_displacement(obj: bpy.types.Object) -> NDArray[np.float32]:
    """Return the displacement of an object's mesh, shape (N, 3), as it is shown with the amount 1."""
    return attributes.read_vectors(obj.data, DENOISE_RECIPE.terms[0].attribute)


def shown_amount(obj: bpy.types.Object) -> float:
    """Return how much of the motion the modifier of an object shows."""
    modifier = find_modifier(obj, DISPLACEMENT)
    return 0.0 if modifier is None else float(get_input(modifier, AMOUNT))
