# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise the mesh of one object: read, compute, write. No user interface."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from . import mesh_bridge, run_memory
from .preparations import preparations

if TYPE_CHECKING:
    import bpy

    from ..core.denoising.report import Callback, DenoiseReport
    from ..core.settings import DenoiseSettings


class MeasuredReport(NamedTuple):
    """A report, whose lengths are in object space, how far vertices moved and the noise in scene units."""

    report: DenoiseReport
    scene_rms: float
    scene_max: float
    scene_sigma: float
    """Measured noise in scene units; 0 if it was not measured."""


def denoise_object(
    obj: bpy.types.Object, settings: DenoiseSettings, callback: Callback | None = None
) -> DenoiseReport:
    """Denoise the mesh of an object in place; in Edit Mode only the selected vertices.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode. Its active shape key is edited; modifiers are not applied.
    settings : DenoiseSettings
        What to do.
    callback : callable, optional
        `callback(fraction, change)`, called after each iteration; returns True to stop.

    Returns
    -------
    DenoiseReport
        Lengths are in object space. If the run was stopped, the mesh is as it was.

    Raises
    ------
    ValueError
        With a sentence that begins with the object's name. The mesh is as it was.
    """
    return denoise_and_measure(obj, settings, callback).report


def denoise_and_measure(
    obj: bpy.types.Object, settings: DenoiseSettings, callback: Callback | None = None
) -> MeasuredReport:
    """Denoise as `denoise_object` does, and measure with the object's scale too."""
    reason = mesh_bridge.refusal(obj)
    if reason is not None:
        raise ValueError(reason)
    from ..core import denoise
    from .scene_units import displacement_in_scene, length_in_scene

    surface, movable = mesh_bridge.read_surface_and_movable(obj)
    if movable is not None and not movable.any():
        raise ValueError(f"‘{obj.name}’ has no selected vertices; select what should be denoised.")
    try:
        result = denoise(surface, settings, movable=movable, callback=callback, prepared=preparations())
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
    if not result.report.is_stopped:
        run_memory.write_and_remember(obj, surface, result.vertices)
    rms, maximum = displacement_in_scene(obj, surface.vertices, result.vertices)
    noise = result.report.noise
    sigma = 0.0 if noise is None else length_in_scene(obj, noise.sigma)
    return MeasuredReport(result.report, rms, maximum, sigma)
