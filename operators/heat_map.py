# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that show as colors what the last run changed or took for noise, and take colors away."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees
from typing import TYPE_CHECKING, Any

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

from .colors.heat_settings import LIMITS, TOLERANCES, HeatMixin, shown_heat_names
from .colors.viewport import hide_unused_colors, show_vertex_colors
from .mesh_io import band_storage
from .preview import targets
from .properties.region_values import as_typed
from .properties.scene_units import value_texts
from .reports.filled_reports import fill_band_range
from .run import run_memory
from .shortage import shortage_told

if TYPE_CHECKING:
    from .bands.band_values import BandValues, ColorRange


def show_heat(
    context: bpy.types.Context, found: dict[str, BandValues], quantity: str, properties: Any
) -> ColorRange:
    """Color the objects of values, by object name, as a `HeatMixin` says, and take down what the colors mean.

    Quantities that have an attribute of their own are written there too.
    """
    from .colors.coloring import color_objects
    from .colors.heat_values import QUANTITIES

    kind = QUANTITIES[quantity]
    colored = color_objects(
        list(found.values()),
        kind.is_signed,
        _heat_limit(properties, found, quantity),
        band_storage.HEAT_COLORS,
        kind.domain,
        _heat_tolerance(properties, kind.unit),
    )
    fill_band_range(
        context.window_manager.framelet_band_range,
        list(found),
        kind.title,
        colored,
        is_signed=kind.is_signed,
        quantity=quantity,
        unit=kind.unit,
    )
    if kind.attribute:
        for obj, values in found.values():
            band_storage.write_numbers(obj, kind.attribute, values)
    return colored


def refresh_heat(context: bpy.types.Context, objects: Iterable[bpy.types.Object]) -> None:
    """Bring heat maps up to date after a run; the colors of objects that it did not treat stay.

    Where that cannot be, as in Edit Mode, where attributes cannot be written, or with a range that is no
    number, colors and legend are of the run before, and the legend goes.
    """
    from .colors.heat_values import QUANTITIES, heat_values

    shown = context.window_manager.framelet_band_range
    colored = [obj for obj in objects if band_storage.HEAT_COLORS in obj.data.attributes]
    if shown.quantity not in QUANTITIES or not colored:
        return
    if any(obj.mode != "OBJECT" or not run_memory.is_remembered(obj) for obj in colored):
        shown.objects.clear()
        return
    try:
        found = {obj.name: heat_values(obj, shown.quantity) for obj in colored}
        show_heat(context, found, shown.quantity, context.scene.framelet_heat_map)
    except ValueError:
        shown.objects.clear()


def _heat_limit(properties: Any, found: dict[str, BandValues], quantity: str) -> float:
    """Return the value of the last color; raise ValueError if it was given as something else."""
    from .colors.coloring import chosen_limit
    from .colors.heat_values import QUANTITIES

    values = [item.values for item in found.values()]
    unit = QUANTITIES[quantity].unit
    limit = chosen_limit(properties, values, LIMITS[unit])
    return degrees(limit) if unit == "ANGLE" and properties.range_rule == "FIXED" else limit


def _heat_tolerance(properties: Any, unit: str) -> float:
    """Return up to which magnitude values are green; 0 for none."""
    tolerance = as_typed(getattr(properties, TOLERANCES[unit])) if unit in TOLERANCES else 0.0
    return degrees(tolerance) if unit == "ANGLE" else tolerance


class OBJECT_OT_framelet_heat_map(HeatMixin, bpy.types.Operator):
    """Show as colors how the last run moved the selected meshes and their faces, or which noise it removed"""

    bl_idname = "object.framelet_heat_map"
    bl_label = "Heat Map"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh that was denoised, in Object Mode."""
        reason = targets.poll_reason(context, in_object_mode=True)
        if reason is None and not any(map(run_memory.is_remembered, targets.target_objects(context))):
            reason = n_("Denoise a selected mesh first")
        return targets.allows(cls, reason)

    def draw(self, _context: bpy.types.Context) -> None:
        """Show, when adjusting the last operation, the properties that count."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("quantity", *shown_heat_names(self, self.quantity)):
            layout.prop(self, name)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find the values of all targets, then color them with one range."""
        from .colors.heat_values import QUANTITIES, heat_values

        kind = QUANTITIES[self.quantity]
        done = targets.run_on_targets(self, context, lambda obj, _progress: heat_values(obj, self.quantity))
        if not done:
            return {"CANCELLED"}
        try:
            with shortage_told(", ".join(done)):
                found = show_heat(context, done, self.quantity, self)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        show_vertex_colors(context)
        shown = context.window_manager.framelet_band_range
        lowest, highest = value_texts(context.scene, [shown.minimum, found.limit], kind.unit)
        self.report(
            {"INFO"},
            rpt_(
                "{title} of {names}: colors from {lowest} to {highest}, {share:.1f}% of all are within"
            ).format(
                title=rpt_(kind.title),
                names=targets.names_text(list(done)),
                lowest=lowest,
                highest=highest,
                share=100.0 * found.share,
            ),
        )
        return {"FINISHED"}


class OBJECT_OT_framelet_hide_colors(bpy.types.Operator):
    """Remove the colors of heat maps and bands from the selected meshes, and show what was shown before"""

    bl_idname = "object.framelet_hide_colors"
    bl_label = "Hide Colors"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh with colors, in Object Mode."""
        reason = targets.poll_reason(context, in_object_mode=True)
        if reason is None and not any(
            band_storage.has_colors(obj.data) for obj in targets.target_objects(context)
        ):
            reason = n_("The selected meshes have no colors of Framelet")
        return targets.allows(cls, reason)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Take the colors of every target away."""
        done = targets.run_on_targets(
            self, context, lambda obj, _progress: band_storage.remove_object_colors(obj)
        )
        if not done:
            return {"CANCELLED"}
        hide_unused_colors(context)
        return {"FINISHED"}
