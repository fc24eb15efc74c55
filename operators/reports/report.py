# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last runs did, kept on the window manager for the sidebar to show.

The classes have no methods, for the reason given in `setting_values`; `filled_reports` fills them.
"""

from typing import Any

import bpy
from bpy.props import BoolProperty, CollectionProperty, FloatProperty, IntProperty, StringProperty


def _length(name: str, description: str) -> Any:
    """Return the property of a length in scene units."""
    return FloatProperty(name=name, description=description, unit="LENGTH", precision=5)


def _edges(name: str, description: str) -> Any:
    """Return the property of a length in mean edge lengths."""
    return FloatProperty(name=name, description=description, precision=3)


def _value(name: str, description: str) -> Any:
    """Return the property of a number that colors stand for."""
    more = "in scene units, degrees or edge lengths"
    return FloatProperty(name=name, description=f"{description}, {more}", precision=5)


def _share(name: str, description: str) -> Any:
    """Return the property of a share, in percent."""
    return FloatProperty(name=name, description=description, subtype="PERCENTAGE")


def _chosen(name: str) -> Any:
    """Return the property of a setting that a run took from the noise, in words."""
    return StringProperty(
        name=name, description="What the last run took from the noise of this object; empty for nothing"
    )


_SIGMA = "Standard deviation of the noise along the normals, in"
_IMPULSIVE = "Some vertices are displaced much more than others; the noise is that of the quieter ones"


_QUIETEST = "Strength of the noise in its quietest tenth of the surface, in"
_STRONGEST = "Strength of the noise in its strongest tenth of the surface, in"


class BeliefMixin:
    """What automatic denoising took for noise; of several objects extremes, and shares of all vertices."""

    has_belief: BoolProperty(
        name="Removed", description="The noise is what automatic denoising took away, not an estimate"
    )
    is_off: BoolProperty(name="Off", description="Strength was 0, so that nothing moved")
    is_clean: BoolProperty(name="Clean Already", description="There was no noise, and nothing moved")
    sigma_low: _length("Quietest", f"{_QUIETEST} scene units")
    sigma_high: _length("Strongest", f"{_STRONGEST} scene units")
    sigma_low_edges: _edges("Quietest in Edge Lengths", f"{_QUIETEST} mean edge lengths")
    sigma_high_edges: _edges("Strongest in Edge Lengths", f"{_STRONGEST} mean edge lengths")
    width: _edges("Width", "Standard deviation of what smoothed the noise, in edge lengths; 0 if nothing did")
    spikes: _share("Spikes", "Share of the vertices that were far off alone")
    clean: _share("Clean", "Share of the vertices that were clean, and stayed")
    wide: _share("Wide", "Share of the faces whose noise was taken for wide, as neighbors share it")
    along_edges: _edges(
        "Along Surface", "What was taken away along the surface, root mean square in edge lengths"
    )


class FrameletNoise(BeliefMixin, bpy.types.PropertyGroup):
    """The noise of one object as it was measured last; its `name` is the object's."""

    sigma: _length("Noise", f"{_SIGMA} scene units")
    sigma_edges: _edges("In Edge Lengths", f"{_SIGMA} mean edge lengths")
    is_impulsive: BoolProperty(name="Impulsive", description=_IMPULSIVE)
    is_denoised: BoolProperty(
        name="Denoised", description="The noise is that before the last run, which removed it"
    )
    chosen_lambda: _chosen("Smoothing λ")
    chosen_mu: _chosen("Penalty μ")


class FrameletEstimate(bpy.types.PropertyGroup):
    """The noise of the objects that were measured last, by an estimate or by a denoising run."""

    objects: CollectionProperty(type=FrameletNoise, name="Objects", description="The noise by object")


class FrameletReport(BeliefMixin, bpy.types.PropertyGroup):
    """The last denoising run, all of its objects taken together."""

    names: StringProperty(name="Objects", description="The objects that were denoised, separated by commas")
    n_objects: IntProperty(name="Objects", description="Number of objects; 0 before the first run")
    n_vertices: IntProperty(name="Vertices", description="Number of vertices, those that stayed included")
    n_moved: IntProperty(name="Moved", description="Number of vertices that moved")
    iterations: IntProperty(
        name="Iterations", description="Iterations that ran, the largest number of any object"
    )
    displacement_rms: _length("Displacement", "Root mean square over all vertices, in scene units")
    displacement_max: _length("Largest Displacement", "How far the farthest vertex moved, in scene units")
    displacement_rms_edges: _edges(
        "In Edge Lengths", "Root mean square over all vertices, in mean edge lengths"
    )
    displacement_max_edges: _edges(
        "In Edge Lengths", "How far the farthest vertex moved, in mean edge lengths"
    )
    flipped_faces: IntProperty(
        name="Flipped Faces", description="Faces that turned by more than a right angle"
    )
    folded_faces: IntProperty(
        name="Folded Faces", description="Faces that look against the faces around them"
    )
    folded_faces_before: IntProperty(
        name="Folded Faces Before", description="Faces that looked against the faces around them before"
    )
    degenerate_faces: IntProperty(name="Degenerate", description="Faces next to without area")
    degenerate_faces_before: IntProperty(
        name="Degenerate Before", description="Faces next to without area before"
    )
    damped_vertices: IntProperty(name="Damped", description="Vertices that moved less, so that no face folds")
    line_vertices: IntProperty(
        name="On Lines", description="Vertices on sharp edges, which were smoothed along them only"
    )
    welded_vertices: IntProperty(name="Welded", description="Vertices that were welded to others for the run")
    is_closed: BoolProperty(
        name="Closed", description="All meshes are closed, so that their volumes are known"
    )
    volume_change: FloatProperty(
        name="Volume",
        description="Change of the volume, the largest of any closed mesh",
        subtype="PERCENTAGE",
    )
    irregular_vertices: IntProperty(name="Irregular", description="Vertices that took the irregular rule")
    boundary_vertices: IntProperty(name="Boundary", description="Vertices on open borders")
    non_manifold_vertices: IntProperty(name="Non-Manifold", description="Vertices where the surface branches")
    loose_vertices: IntProperty(name="Loose", description="Vertices without a face; they do not move")
    has_noise: BoolProperty(name="Noise Is Known", description="The noise of all objects was measured")
    noise_sigma: _length("Noise", f"{_SIGMA} scene units, root mean square over all vertices")
    noise_sigma_edges: _edges("In Edge Lengths", f"{_SIGMA} mean edge lengths")
    is_impulsive: BoolProperty(name="Impulsive", description=f"Of any object: {_IMPULSIVE.lower()}")
    parameters: StringProperty(
        name="Parameters", description="What was taken from the measured noise; empty if nothing was"
    )
    frame: StringProperty(
        name="Frame That Ran",
        description="Name of the frame that ran, also where the mesh decided; empty if there was none or "
        "objects had different ones",
    )
    hints: StringProperty(
        name="Hints", description="What made the result other than expected, and the way out, a line each"
    )
    seconds: FloatProperty(name="Time", description="Seconds for all objects", precision=2)


class FrameletComparison(bpy.types.PropertyGroup):
    """The last comparison of two meshes of the same topology."""

    object_name: StringProperty(
        name="Object", description="The object that was compared; empty before the first time"
    )
    other_name: StringProperty(name="Other", description="The object it was compared with")
    mean_angle: FloatProperty(
        name="Mean Angle", description="Mean angle of face normals, in degrees", precision=3
    )
    max_angle: FloatProperty(name="Largest Angle", description="Largest angle of face normals, in degrees")
    rms_distance: _length("Distance", "Root mean square of the distances of vertices, in scene units")
    max_distance: _length("Largest Distance", "Largest distance of two vertices, in scene units")
    rms_distance_edges: _edges("In Edge Lengths", "Root mean square of the distances, in mean edge lengths")
    max_distance_edges: _edges("In Edge Lengths", "Largest distance, in mean edge lengths")
    flipped_faces: IntProperty(
        name="Flipped Faces", description="Faces that differ by more than a right angle"
    )


class FrameletName(bpy.types.PropertyGroup):
    """An object, by its `name`. Names may have any sign in them, so that no text holds several."""


class FrameletBandRange(bpy.types.PropertyGroup):
    """What the colors of a band or a heat map mean; `unit` is LENGTH, ANGLE or EDGES."""

    objects: CollectionProperty(
        type=FrameletName, name="Objects", description="The objects that are colored; none if empty"
    )
    title: StringProperty(name="Band", description="What is shown")
    quantity: StringProperty(name="Quantity", description="What a heat map shows; empty for bands")
    is_signed: BoolProperty(name="Signed", description="Values are components along the normals")
    unit: StringProperty(
        name="Unit",
        description="LENGTH in scene units, ANGLE in degrees, or EDGES in mean edge lengths",
        default="LENGTH",
    )
    minimum: _value("Minimum", "The value with the first color")
    maximum: _value("Maximum", "The value with the last color")
    largest: _value("Largest", "Largest magnitude of all values")
    share: FloatProperty(
        name="Within", description="Share of the vertices within the range", subtype="PERCENTAGE"
    )
    tolerance: _value("Tolerance", "Values of at most this magnitude are green; 0 if none are")
    green: FloatProperty(name="Green", description="Share of the values that are green", subtype="PERCENTAGE")
    shading_type: StringProperty(name="Shading", description="How the 3D View was shaded before")
    color_type: StringProperty(name="Color", description="What colored the 3D View before")
