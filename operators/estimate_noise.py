# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that measures how noisy meshes are, and changes nothing."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .mesh_io import mesh_bridge
from .preview import targets
from .properties.scene_units import length_in_scene, noise_text
from .reports.filled_reports import MeasuredNoise, fill_estimate


def estimate_object_noise(obj: bpy.types.Object) -> MeasuredNoise:
    """Measure the noise of the mesh of an object; in Edit Mode of the whole mesh too.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in any mode; the positions of its active shape key are measured, without modifiers.

    Raises
    ------
    ValueError
        With a sentence that begins with the object's name.
    """
    if obj.type != "MESH":
        raise ValueError(f"‘{obj.name}’ is not a mesh; select mesh objects.")
    from ..core import estimate_noise

    surface = mesh_bridge.read_surface(obj)
    try:
        noise = estimate_noise(surface, threads=0)
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
    return MeasuredNoise(noise, length_in_scene(obj, 1.0))


class OBJECT_OT_framelet_estimate_noise(bpy.types.Operator):
    """Measure how strong the noise of the selected meshes is; changes nothing"""

    bl_idname = "object.framelet_estimate_noise"
    bl_label = "Estimate Noise"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode or Edit Mode."""
        return targets.allows(cls, targets.poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Measure every target, and keep the results for the sidebar."""
        measured = targets.run_on_targets(self, context, lambda obj, _progress: estimate_object_noise(obj))
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
        text = rpt_("Noise of {names}: {noise}")
        return text.format(names=targets.names_text(list(texts)), noise=next(iter(texts.values())))
    names = sorted(measured, key=lambda name: measured[name].noise.sigma_edges)
    return rpt_("Noise of {names}: from {least} of ‘{first}’ to {most} of ‘{last}’").format(
        names=targets.names_text(names),
        least=texts[names[0]],
        first=names[0],
        most=texts[names[-1]],
        last=names[-1],
    )
