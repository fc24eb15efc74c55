# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's PLY exporter would lose: the order of vertices with UVs, and the last bit of colors."""

from __future__ import annotations

import bpy
import numpy as np


def store_uv_by_vertex(mesh: bpy.types.Mesh) -> bool:
    """Copy the active UV map to vertex attributes s and t, which are the PLY names of texture coordinates.

    The exporter's own option for UVs makes one vertex for each pair of position and UV, in another order.

    Returns
    -------
    bool
        False if a vertex has several UVs, so that nothing was copied.
    """
    layer = mesh.uv_layers.active
    if layer is None or not mesh.loops:
        return True
    by_corner = np.empty((len(mesh.loops), 2), np.float32)
    layer.data.foreach_get("uv", by_corner.ravel())
    corner_vertex = np.empty(len(mesh.loops), np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", corner_vertex)
    by_vertex = np.zeros((len(mesh.vertices), 2), np.float32)
    by_vertex[corner_vertex] = by_corner
    if not np.array_equal(by_vertex[corner_vertex], by_corner):
        return False
    for axis, name in enumerate("st"):
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        attribute = mesh.attributes.new(name, "FLOAT", "POINT")
        attribute.data.foreach_set("value", np.ascontiguousarray(by_vertex[:, axis]))
    return True


def round_colors(mesh: bpy.types.Mesh) -> None:
    """Move the active vertex colors to where the exporter, which cuts off, finds the nearest of 256 steps."""
    colors = mesh.color_attributes.active_color
    if colors is None or colors.data_type != "FLOAT_COLOR" or not len(colors.data):
        return
    values = np.empty((len(colors.data), 4), np.float32)
    colors.data.foreach_get("color_srgb", values.ravel())
    # A quarter of a step is far from both neighbors, whatever the rounding on the way.
    colors.data.foreach_set("color_srgb", ((np.round(values * 255) + 0.25) / 255).astype(np.float32).ravel())
