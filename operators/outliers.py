# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators for what is no surface: spikes, which are selected or flattened, and small loose islands."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import bmesh
import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

from ..core.settings.outliers import SPIKE_LENGTH, SPIKE_VERTICES
from .context_objects import active_object
from .mesh_io import mesh_bridge
from .modifier.recipes import DISPLACEMENT
from .modifier.stack import find_modifier
from .preview import targets
from .properties.region_options import RegionOptions
from .properties.region_values import as_typed

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from ..core import SurfaceMesh


class SpikeMixin:
    """What counts as a spike."""

    length: bpy.props.FloatProperty(
        name="Length",
        description="Least factor from the edges around a spike to its own: larger finds fewer spikes",
        default=SPIKE_LENGTH,
        min=1.01,
        max=100.0,
        soft_max=10.0,
        precision=2,
    )
    most: bpy.props.IntProperty(
        name="Vertices",
        description="How many vertices a spike has at most: larger finds wider ones",
        default=SPIKE_VERTICES,
        min=1,
        max=1000,
        soft_max=50,
    )


class Found(NamedTuple):
    """An object, and which of its vertices are to be selected, shape (N,)."""

    obj: bpy.types.Object
    chosen: NDArray[np.bool_]


def select_vertices(obj: bpy.types.Object, chosen: NDArray[np.bool_]) -> None:
    """Select these vertices of an object in Edit Mode, shape (N,), and no others; never hidden ones."""
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    edit_mesh.select_mode = {"VERT"}
    for vert, is_chosen in zip(edit_mesh.verts, chosen.tolist(), strict=True):
        vert.select = is_chosen and not vert.hide
    edit_mesh.select_flush_mode()
    bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)


def flatten_spikes(obj: bpy.types.Object, length: float = SPIKE_LENGTH, most: int = SPIKE_VERTICES) -> int:
    """Bring the spikes of an object down to the surface around them; in Edit Mode the selected ones.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object; its active shape key is edited, or with Multires the finest level. What is hidden or
        masked stays.
    length, most : float, int
        What a spike is, see `core.mesh.spikes.find_spikes`.

    Returns
    -------
    int
        Number of vertices that were moved.

    Raises
    ------
    ValueError
        With a sentence that names the object. The mesh is as it was.
    """
    from ..core.mesh.spikes import find_spikes, flattened
    from .mesh_io.region_bridge import read_region
    from .run.shape import check_shape, shape_of, write_shape

    check_shape(obj)
    if find_modifier(obj, DISPLACEMENT) is not None:
        raise ValueError(
            f"‘{obj.name}’ has the modifier of a run, which counts on its spikes; apply or remove it first."
        )
    with shape_of(obj) as shape:
        surface, movable, region = read_region(shape, RegionOptions())
    spikes = find_spikes(surface, length, most)
    if movable is not None:
        spikes &= movable
    if region.weights is not None:
        spikes &= region.weights > 0.0
    vertices = flattened(surface, spikes)
    write_shape(obj, surface, vertices)
    return int((vertices != surface.vertices).any(axis=1).sum())


def _select_on_targets(
    operator: bpy.types.Operator,
    context: bpy.types.Context,
    find: Callable[[SurfaceMesh], NDArray[np.bool_]],
    found: str,
) -> set[str]:
    """Select, in Edit Mode, what is found of every target; `found` is the sentence that says how much.

    The mode is changed only once there is something to select.
    """
    from .run.shape import check_cage

    def look(obj: bpy.types.Object, _progress: targets.Progress) -> Found:
        check_cage(obj, "selection")
        return Found(obj, find(mesh_bridge.read_surface(obj)))

    done = targets.run_on_targets(operator, context, look)
    if not done:
        return {"CANCELLED"}
    if context.mode != "EDIT_MESH":
        active = active_object(context)
        refusal = mesh_bridge.ownership_refusal(active)
        if active is not None and refusal is None and not _is_edit_mode_entered(active):
            refusal = (
                f"‘{active.name}’, the active object, cannot be in Edit Mode; make it local and visible."
            )
        if refusal is not None:
            operator.report({"ERROR"}, refusal)
            return {"CANCELLED"}
    context.tool_settings.mesh_select_mode = (True, False, False)
    for obj, chosen in done.values():
        if obj.data.is_editmode:
            select_vertices(obj, chosen)
    number = sum(int(item.chosen.sum()) for item in done.values())
    operator.report({"INFO"}, rpt_(found).format(number=number, names=targets.names_text(list(done))))
    return {"FINISHED"}


def _is_edit_mode_entered(obj: bpy.types.Object) -> bool:
    """Switch to Edit Mode; return whether Blender does so."""
    try:
        bpy.ops.object.mode_set(mode="EDIT")
    except RuntimeError:
        return False
    return bool(obj.data.is_editmode)


class OBJECT_OT_framelet_select_spikes(SpikeMixin, bpy.types.Operator):
    """Select single vertices and small clusters that are far off their surroundings, in Edit Mode"""

    bl_idname = "object.framelet_select_spikes"
    bl_label = "Select Spikes"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh."""
        return targets.allows(cls, targets.poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Select them on every target."""
        from ..core.mesh.spikes import find_spikes

        length, most = as_typed(self.length), self.most
        return _select_on_targets(
            self,
            context,
            lambda surface: find_spikes(surface, length, most),
            n_("Selected {number:,} vertices of spikes of {names}"),
        )


class OBJECT_OT_framelet_flatten_spikes(SpikeMixin, bpy.types.Operator):
    """Bring spikes down to the surface around them; in Edit Mode the selected ones"""

    bl_idname = "object.framelet_flatten_spikes"
    bl_label = "Flatten Spikes"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh."""
        return targets.allows(cls, targets.poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Flatten them on every target."""
        length, most = as_typed(self.length), self.most
        done = targets.run_on_targets(self, context, lambda obj, _progress: flatten_spikes(obj, length, most))
        if not done:
            return {"CANCELLED"}
        text = rpt_("Flattened {number:,} vertices of spikes of {names}")
        self.report({"INFO"}, text.format(number=sum(done.values()), names=targets.names_text(list(done))))
        return {"FINISHED"}


class OBJECT_OT_framelet_select_islands(bpy.types.Operator):
    """Select small loose parts in Edit Mode, so that they can be deleted; the largest part is never one"""

    bl_idname = "object.framelet_select_islands"
    bl_label = "Select Small Islands"
    bl_options = {"REGISTER", "UNDO"}

    most: bpy.props.IntProperty(
        name="Vertices",
        description="How many vertices an island has at most: larger selects larger ones",
        default=100,
        min=1,
        max=2**31 - 1,
        soft_max=10000,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh."""
        return targets.allows(cls, targets.poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Select them on every target."""
        from ..core.mesh.spikes import small_islands

        most = self.most
        return _select_on_targets(
            self,
            context,
            lambda surface: small_islands(surface, most),
            n_("Selected {number:,} vertices of small islands of {names}"),
        )


classes = (
    OBJECT_OT_framelet_select_spikes,
    OBJECT_OT_framelet_flatten_spikes,
    OBJECT_OT_framelet_select_islands,
)
