# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The planes in which the modifiers of an object mirror its mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from .stack import modifiers_below

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray


class Plane(NamedTuple):
    """A plane in the space of an object: its unit normal and a point, shape (3,), float64 each.

    Vertices of borders up to `distance` away from it are joined to their images.
    """

    normal: NDArray[np.float64]
    point: NDArray[np.float64]
    distance: float


def read_mirrors(obj: bpy.types.Object) -> tuple[Plane, ...]:
    """Return the planes of the Mirror modifiers that join the two halves, by clipping or by merging.

    Modifiers that come after others which make vertices of their own do not mirror the mesh itself.
    """
    import numpy as np

    planes = []
    for modifier in obj.modifiers:
        joins = modifier.type == "MIRROR" and (modifier.use_clip or modifier.use_mirror_merge)
        if not joins or not modifier.show_viewport:
            continue
        if any(below.type != "MIRROR" for below in modifiers_below(modifier)):
            continue
        matrix = np.eye(4)
        if modifier.mirror_object is not None:
            matrix = np.array(obj.matrix_world.inverted_safe() @ modifier.mirror_object.matrix_world)
        for axis in range(3):
            length = np.linalg.norm(matrix[:3, axis])
            if modifier.use_axis[axis] and length > 0.0:
                normal = matrix[:3, axis] / length
                planes.append(Plane(normal, matrix[:3, 3].copy(), float(modifier.merge_threshold)))
    return tuple(planes)
