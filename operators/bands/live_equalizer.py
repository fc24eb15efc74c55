# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The equalizer as a modifier: each level is an attribute of vectors, which nodes multiply by gains."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..mesh_io import mesh_bridge
from ..mesh_io.own_names import kind_refusal
from ..modifier import attributes
from ..modifier.node_groups import MASK
from ..modifier.offsets import offset_of, remove_modifier
from ..modifier.recipes import DISPLACEMENT, EQUALIZER, equalizer_recipe, level_name, recipe_of
from ..modifier.stack import attach, find_modifier, place_refusal
from ..run.shape import check_cage
from .transforms import equalizer_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy


def make_live(
    obj: bpy.types.Object,
    gains: Sequence[float],
    frame: str = "AUTO",
    stencil: str = "STRAIGHT",
    boundary: str = "ALONG",
    vertex_group: str = "",
) -> bpy.types.Modifier:
    """Store the levels of an object's mesh, and give it the modifier with one gain a level.

    What Framelet's other modifier adds to the mesh belongs to the surface whose levels these are.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode.
    gains : sequence of float
        The first values of the gains, one for each level, finest first. An object that has the modifier
        already keeps its own.
    frame, stencil, boundary : str
        See `DenoiseSettings`.
    vertex_group : str
        Name of a group whose weights scale the change of each vertex; empty for none.

    Returns
    -------
    bpy.types.Modifier

    Raises
    ------
    ValueError
        With a sentence that names the object. Everything is as it was.
    """
    check_cage(obj, "bands that are kept", "press Equalize, or ")
    if obj.mode != "OBJECT":
        raise ValueError(f"‘{obj.name}’: the live equalizer is made in Object Mode; leave the mode first.")
    reason = kind_refusal(obj, r"framelet_level_\d+") or place_refusal(obj, EQUALIZER)
    if reason is not None:
        raise ValueError(reason)
    cage = mesh_bridge.read_surface(obj)
    added = offset_of(obj, DISPLACEMENT)
    surface = cage if added is None else cage.with_vertices(cage.vertices + added)
    try:
        details = equalizer_of(surface, len(gains), frame, stencil, boundary).details()
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
    recipe = equalizer_recipe(len(gains))
    values: dict[str, object] = {level_name(level): gain for level, gain in enumerate(gains, 1)}
    old = find_modifier(obj, EQUALIZER)
    if old is not None and len(details) < _n_levels(old):
        # Attributes of levels that are gone would stay.
        remove_modifier(obj, EQUALIZER)
    for term, vectors in zip(recipe.terms, details, strict=True):
        attributes.write_vectors(obj.data, term.attribute, vectors)
    attributes.mark_cage(obj.data, cage)
    return attach(obj, recipe, {**values, MASK: vertex_group})


def _n_levels(modifier: bpy.types.Modifier) -> int:
    """Return how many levels the equalizer of a modifier has."""
    return len(recipe_of(modifier).terms)
