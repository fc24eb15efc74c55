# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose sculpted shape is not their mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy


def multires_refusal(obj: bpy.types.Object) -> str | None:
    """Say in one sentence that the sculpted shape of an object is not its mesh; None if it is."""
    levels = max((item.total_levels for item in obj.modifiers if item.type == "MULTIRES"), default=0)
    if not levels:
        return None
    return (
        f"‘{obj.name}’ has a Multires modifier, whose sculpted shape is not the mesh that Framelet reads; "
        "apply the modifier, or denoise a copy made by Object > Convert > Mesh with Keep Original."
    )
