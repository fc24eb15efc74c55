# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh still is the one to which the vectors of its modifier belong, in words for the sidebar."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_n as n_

from ..mesh_io import mesh_bridge
from . import attributes
from .offsets import KINDS
from .stack import find_modifier, modifiers_below

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy

WORDS = {
    "FACES": n_("Other vertices or faces since; run it again"),
    "POSITIONS": n_("The mesh was edited since; run it again"),
}

_known: dict[int, str] = {}
"""What `attributes.cage_change` said of meshes, by their numbers in the session, until they are touched."""


def cage_words(obj: bpy.types.Object) -> str:
    """Say why what a modifier of Framelet adds does not fit an object any more; empty if it does.

    Looking at a mesh of a million vertices takes a tenth of a second, so that it is done once after an edit,
    and not within Edit Mode.
    """
    modifiers = [found for kind in KINDS if (found := find_modifier(obj, kind))]
    if not modifiers or obj.mode == "EDIT":
        return ""
    below = modifiers_below(modifiers[-1])
    if below:
        return iface_("‘{name}’ changes the vertices before; move it down").format(name=below[-1].name)
    mesh = obj.data
    if mesh.session_uid not in _known:
        _known[mesh.session_uid] = attributes.cage_change(mesh, mesh_bridge.read_surface(obj))
    change = _known[mesh.session_uid]
    if change == "POSITIONS" and mesh.shape_keys is not None:
        return ""  # which shape is looked at says nothing of edits
    return iface_(WORDS[change]) if change else ""


def forget_cages(touched: Iterable[int] | None = None) -> None:
    """Look again at meshes, by their numbers in the session; at all by default."""
    if touched is None:
        _known.clear()
        return
    for uid in touched:
        _known.pop(uid, None)
