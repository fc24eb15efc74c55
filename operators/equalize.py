# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that turns the scales of a mesh up and down."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .bands.transforms import equalizer_of
from .mesh_io import mesh_bridge
from .preview import targets
from .properties.band_settings import EQUALIZER_NAMES, GAIN_NAMES, EqualizerMixin
from .properties.region_values import as_typed
from .properties.scene_units import displacement_in_scene, length_text
from .properties.settings import FrameMixin
from .reports.filled_reports import forget_estimate


def equalize_object(
    obj: bpy.types.Object,
    gains: Sequence[float],
    frame: str = "AUTO",
    stencil: str = "STRAIGHT",
    boundary: str = "ALONG",
    vertex_group: str = "",
    invert: bool = False,
) -> tuple[float, float]:
    """Multiply the details of an object's mesh by a gain for each level; in Edit Mode at selected vertices.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode; its active shape key is edited, or with Multires the finest
        level.
    gains : sequence of float
        One for each level, finest first.
    frame, stencil, boundary : str
        See `DenoiseSettings`.
    vertex_group : str
        Name of a group whose weights scale the change of each vertex; empty for none.
    invert : bool
        Take one minus the weights.

    Returns
    -------
    rms, maximum : float
        How far vertices moved, in scene units.

    Raises
    ------
    ValueError
        With a sentence that names the object. The mesh is as it was.
    """
    from .run.shape import check_shape, shape_of, write_shape

    check_shape(obj)
    import numpy as np

    from ..core.equalizer import check_gains

    with shape_of(obj) as shape:
        surface, movable = mesh_bridge.read_surface_and_movable(shape)
        group = mesh_bridge.read_weights(shape, vertex_group) if vertex_group else None
    if movable is not None and not movable.any():
        raise ValueError(f"‘{obj.name}’ has no selected vertices; select what should be equalized.")
    weights = None if movable is None else movable.astype(np.float64)
    if group is not None:
        group = 1.0 - group if invert else group
        weights = group if weights is None else weights * group
    try:
        check_gains(gains, weights, surface.n_vertices)
        equalizer = equalizer_of(surface, len(gains), frame, stencil, boundary)
        vertices = equalizer.equalized(gains, weights=weights)
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
    write_shape(obj, surface, vertices)
    return displacement_in_scene(obj, surface.vertices, vertices)


class OBJECT_OT_framelet_live_equalizer(FrameMixin, EqualizerMixin, bpy.types.Operator):
    """Store the scales of the selected meshes, and turn them up and down by the sliders of a modifier"""

    bl_idname = "object.framelet_live_equalizer"
    bl_label = "Live Equalizer"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode."""
        return targets.allows(cls, targets.poll_reason(context, in_object_mode=True))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show, when adjusting the last operation, what is stored; the gains are those of the modifier."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("levels", "frame", "stencil", "boundary"):
            layout.prop(self, name)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Store the scales of every target."""
        from .bands.live_equalizer import make_live

        gains = [as_typed(getattr(self, name)) for name in GAIN_NAMES[: self.levels]]
        done = targets.run_on_targets(
            self,
            context,
            lambda obj, _progress: make_live(
                obj, gains, self.frame, self.stencil, self.boundary, self.vertex_group
            ),
        )
        if not done:
            return {"CANCELLED"}
        text = rpt_("The levels of {names} are sliders of a modifier now")
        self.report({"INFO"}, text.format(names=targets.names_text(list(done))))
        return {"FINISHED"}


class OBJECT_OT_framelet_equalize(FrameMixin, EqualizerMixin, bpy.types.Operator):
    """Smooth or exaggerate the details of meshes, scale by scale; in Edit Mode those of selected vertices"""

    bl_idname = "object.framelet_equalize"
    bl_label = "Equalize"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode or Edit Mode."""
        return targets.allows(cls, targets.poll_reason(context))

    def draw(self, context: bpy.types.Context) -> None:
        """Show, when adjusting the last operation, the gains of the levels in use."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in EQUALIZER_NAMES:
            if name not in GAIN_NAMES[self.levels :]:
                layout.prop(self, name)
        for name in ("frame", "stencil", "boundary"):
            layout.prop(self, name)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Equalize every target."""
        gains = [as_typed(getattr(self, name)) for name in GAIN_NAMES[: self.levels]]
        done = targets.run_on_targets(
            self,
            context,
            lambda obj, _progress: equalize_object(
                obj, gains, self.frame, self.stencil, self.boundary, self.vertex_group, self.invert
            ),
        )
        if not done:
            return {"CANCELLED"}
        forget_estimate(context.window_manager.framelet_estimate, done)
        largest = max(maximum for _, maximum in done.values())
        self.report(
            {"INFO"},
            rpt_("Equalized {names}: vertices moved by up to {length}").format(
                names=targets.names_text(list(done)), length=length_text(context.scene, largest)
            ),
        )
        return {"FINISHED"}
