# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that adds noise, to try out what denoising does."""

import bpy
from bpy.app.translations import pgettext_rpt as rpt_
from bpy.props import FloatProperty, IntProperty

from .mesh_io import mesh_bridge
from .preview import targets
from .properties.region_values import as_typed
from .reports.filled_reports import forget_estimate


def add_noise_to_object(obj: bpy.types.Object, sigma: float, seed: int) -> None:
    """Add Gaussian noise along the normals to the mesh of an object; in Edit Mode to the selected vertices.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode; its active shape key is edited, or with Multires the finest
        level.
    sigma : float
        Standard deviation of the noise, in mean edge lengths.
    seed : int
        The same seed gives the same noise.

    Raises
    ------
    ValueError
        With a sentence that begins with the object's name. The mesh is as it was.
    """
    from .run.shape import check_shape, shape_of, write_shape

    check_shape(obj)
    import numpy as np

    from ..core import add_noise

    with shape_of(obj) as shape:
        surface, movable = mesh_bridge.read_surface_and_movable(shape)
    if movable is not None and not movable.any():
        raise ValueError(f"‘{obj.name}’ has no selected vertices; select where noise should be added.")
    try:
        vertices = add_noise(surface, sigma, seed)
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
    if movable is not None:
        vertices = np.where(movable[:, None], vertices, surface.vertices)
    write_shape(obj, surface, vertices)


class OBJECT_OT_framelet_add_noise(bpy.types.Operator):
    """Move vertices along their normals by random amounts, to try out what denoising does"""

    bl_idname = "object.framelet_add_noise"
    bl_label = "Add Noise"
    bl_options = {"REGISTER", "UNDO"}

    sigma: FloatProperty(
        name="Strength",
        description="Standard deviation of the noise, in mean edge lengths: larger is noisier",
        default=0.2,
        min=0.0,
        max=10.0,
        soft_max=1.0,
        step=1,
        precision=3,
    )
    seed: IntProperty(name="Seed", description="Another number gives other noise of the same strength", min=0)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode or Edit Mode."""
        return targets.allows(cls, targets.poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add noise to every target."""
        sigma = as_typed(self.sigma)
        done = targets.run_on_targets(
            self, context, lambda obj, _progress: add_noise_to_object(obj, sigma, self.seed)
        )
        if not done:
            return {"CANCELLED"}
        forget_estimate(context.window_manager.framelet_estimate, done)
        text = rpt_("Added noise of {sigma:g} edge lengths to {names}")
        self.report({"INFO"}, text.format(sigma=sigma, names=targets.names_text(list(done))))
        return {"FINISHED"}
