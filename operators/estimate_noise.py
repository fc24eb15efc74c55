# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that measures how noisy meshes are where they may move, and changes nothing."""

from __future__ import annotations

from dataclasses import replace

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .mesh_io import mesh_bridge
from .preview import targets
from .properties.output_choices import IN_PLACE
from .properties.own_settings import settings_of
from .properties.region_options import RegionOptions
from .properties.region_values import to_region_options
from .properties.scene_units import length_in_scene, noise_text
from .reports.filled_reports import MeasuredNoise, fill_estimate


def estimate_object_noise(obj: bpy.types.Object, options: RegionOptions | None = None) -> MeasuredNoise:
    """Measure the noise of the mesh of an object, where a run may move it.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in any mode; the positions of its active shape key are measured, or with Multires those
        of the finest level, without modifiers.
    options : RegionOptions, optional
        What limits a run; by default selection and hidden vertices alone.

    Raises
    ------
    ValueError
        With a sentence that names the object.
    """
    from .mesh_io.region_bridge import read_region
    from .modifier.multires import multires_refusal
    from .run.shape import shape_of

    reason = mesh_bridge.kind_refusal(obj) or multires_refusal(obj, IN_PLACE)
    if reason is not None:
        raise ValueError(reason)
    from ..core.blocks import Blocks
    from ..core.noise.estimate import estimate_noise

    # Seams are not closed for it: that would take longer than to measure.
    with shape_of(obj) as shape:
        surface, movable, region = read_region(shape, replace(options or RegionOptions(), weld=False))
    where = movable
    if region.weights is not None:
        moves = region.weights > 0.0
        where = moves if where is None else moves & where
    try:
        with Blocks(0) as blocks:
            noise = estimate_noise(surface, blocks=blocks, where=where)
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
    return MeasuredNoise(noise, length_in_scene(obj, 1.0), where is not None and not where.all())


class OBJECT_OT_framelet_estimate_noise(bpy.types.Operator):
    """Measure how strong the noise of the selected meshes is, where they may move; changes nothing"""

    bl_idname = "object.framelet_estimate_noise"
    bl_label = "Estimate Noise"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode or Edit Mode."""
        return targets.allows(cls, targets.poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Measure every target, and keep the results for the sidebar."""
        scene = context.scene
        measured = targets.run_on_targets(
            self,
            context,
            lambda obj, _progress: estimate_object_noise(obj, to_region_options(settings_of(obj, scene))),
        )
        if not measured:
            return {"CANCELLED"}
        fill_estimate(context.window_manager.framelet_estimate, measured)
        self.report({"INFO"}, _sentence(context.scene, measured))
        return {"FINISHED"}


def _sentence(scene: bpy.types.Scene, measured: dict[str, MeasuredNoise]) -> str:
    """Say how noisy an object is, or of several the least and the most noisy."""
    texts = {
        name: noise_text(
            scene, item.scale * item.noise.sigma, item.noise.sigma_edges, item.noise.is_impulsive
        )
        for name, item in measured.items()
    }
    if len(texts) == 1:
        is_part = next(iter(measured.values())).is_part
        text = rpt_("Noise of {names}: {noise}")
        if is_part:
            text = rpt_("Noise of what may move of {names}: {noise}")
        return text.format(names=targets.names_text(list(texts)), noise=next(iter(texts.values())))
    names = sorted(measured, key=lambda name: measured[name].noise.sigma_edges)
    return rpt_("Noise of {names}: from {least} of ‘{first}’ to {most} of ‘{last}’").format(
        names=targets.names_text(names),
        least=texts[names[0]],
        first=names[0],
        most=texts[names[-1]],
        last=names[-1],
    )
