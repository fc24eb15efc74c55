# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that measures how far a mesh is from another one of the same topology."""

from typing import TYPE_CHECKING

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_
from bpy.props import StringProperty

from .context_objects import active_object, selected_objects
from .mesh_io import mesh_bridge
from .preview import targets
from .properties.scene_units import length_text, surface_in_scene
from .reports.filled_reports import fill_comparison
from .shortage import shortage_told

if TYPE_CHECKING:
    from ..core import Comparison


def compare_objects(obj: bpy.types.Object, other: bpy.types.Object) -> "Comparison":
    """Compare the meshes of two objects, both with the scale of the first and wherever they stand.

    Parameters
    ----------
    obj : bpy.types.Object
        The object to judge.
    other : bpy.types.Object
        The object to compare with; its mesh has the same faces.

    Returns
    -------
    Comparison
        Lengths are in scene units.

    Raises
    ------
    ValueError
        With a sentence that begins with the object's name.
    """
    for each in (obj, other):
        if each.type != "MESH":
            raise ValueError(f"‘{each.name}’ is not a mesh; choose two mesh objects.")
    from ..core import compare

    surfaces = [surface_in_scene(obj, mesh_bridge.read_surface(each)) for each in (obj, other)]
    try:
        return compare(surfaces[0], surfaces[1])
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’ and ‘{other.name}’: {error}") from error


class OBJECT_OT_framelet_compare(bpy.types.Operator):
    """Measure how far the active mesh is from the other selected one, which must have the same faces"""

    bl_idname = "object.framelet_compare"
    bl_label = "Compare"
    bl_options = {"REGISTER"}

    other: StringProperty(
        name="Other",
        description="Name of the object to compare with; empty takes the other selected mesh object",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for an active mesh."""
        obj = active_object(context)
        if obj is None or obj.type != "MESH":
            return targets.allows(cls, n_("The active object must be a mesh"))
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Compare, and keep the result for the sidebar."""
        obj = active_object(context)
        assert obj is not None  # see `poll`
        try:
            other = self._find_other(context)
            with shortage_told(obj.name):
                comparison = compare_objects(obj, other)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        fill_comparison(context.window_manager.framelet_comparison, obj.name, other.name, comparison)
        edges = comparison.rms_distance / comparison.mean_edge_length
        self.report(
            {"INFO"},
            rpt_(
                "‘{name}’ against ‘{other}’: {angle:.3f}° mean angle, {distance} RMS distance "
                "({edges:.3f} edge lengths)"
            ).format(
                name=obj.name,
                other=other.name,
                angle=comparison.mean_angle,
                distance=length_text(context.scene, comparison.rms_distance),
                edges=edges,
            ),
        )
        return {"FINISHED"}

    def _find_other(self, context: bpy.types.Context) -> bpy.types.Object:
        """Return the object to compare with."""
        if self.other:
            found = context.scene.objects.get(self.other)
            if found is None:
                raise ValueError(f"‘{self.other}’ is not an object of this scene.")
            return found
        active = active_object(context)
        assert active is not None  # see `poll`
        others = [obj for obj in selected_objects(context) if obj.type == "MESH" and obj != active]
        if len(others) != 1:
            raise ValueError(
                f"‘{active.name}’ needs one other selected mesh to compare with; {len(others)} are selected."
            )
        return others[0]
