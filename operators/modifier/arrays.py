# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which vertices Array and Weld modifiers join, and the steps by which the former repeat the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from .mirrors import read_mirrors
from .stack import modifiers_below

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh


class Joint(NamedTuple):
    """Pairs of vertices at the same place: a first one, shape (P,), and the mapped second one.

    The map from place to place, shape (4, 4), is one in the space of the object.
    """

    matrix: NDArray[np.float64]
    first: NDArray[np.intp]
    second: NDArray[np.intp]


class Step(NamedTuple):
    """The map from a copy of the mesh to the next one, shape (4, 4), and what is joined.

    `stays`, shape (3,), are the axes along which joined vertices stay: how long the step is depends on them.
    """

    matrix: NDArray[np.float64]
    joints: tuple[Joint, ...]
    stays: NDArray[np.bool_]


def read_steps(obj: bpy.types.Object, surface: SurfaceMesh) -> tuple[Step, ...]:
    """Return the steps of the Array modifiers that merge vertices of the mesh, in the order of the stack.

    Modifiers that come after others than Mirror and Array, which make vertices of their own, do not repeat
    the mesh itself.
    """
    arrays = [each for each in obj.modifiers if each.type == "ARRAY" and each.show_viewport]
    if not any(each.use_merge_vertices for each in arrays):
        return ()
    import numpy as np

    from ...core.mesh.borders import border_vertices

    vertices = surface.vertices.astype(np.float64)
    border = np.flatnonzero(border_vertices(surface))
    images = [np.eye(4)]
    low_high = np.stack((vertices.min(axis=0), vertices.max(axis=0)))
    box = np.array([[low_high[x, 0], low_high[y, 1], low_high[z, 2]] for x, y, z in np.ndindex(2, 2, 2)])
    for plane in read_mirrors(obj):
        mirror = np.eye(4)
        mirror[:3, :3] -= 2.0 * np.outer(plane.normal, plane.normal)
        mirror[:3, 3] = 2.0 * (plane.point @ plane.normal) * plane.normal
        images += [mirror @ each for each in images]
        box = np.concatenate((box, mapped(mirror, box)))
    steps = []
    for modifier in arrays:
        if any(below.type not in {"MIRROR", "ARRAY"} for below in modifiers_below(modifier)):
            break
        step = _matrix(obj, modifier, np.ptp(box, axis=0))
        if not np.isfinite(step).all():
            break
        # The motion of copies without a volume, as of an object scaled to 0, cannot be taken back.
        if modifier.use_merge_vertices and np.linalg.matrix_rank(step) == 4:
            near = modifier.merge_threshold
            joints = tuple(_joint(step @ each, vertices, border, near) for each in images)
            relative = np.array(modifier.relative_offset_displace) * modifier.use_relative_offset
            found = tuple(joint for joint in joints if len(joint.first))
            if found:
                steps.append(Step(step, found, relative != 0.0))
        if modifier == arrays[-1]:
            break
        box = _repeated(box, step, _count(modifier, step))
        images += [step @ each for each in images]
    return tuple(steps)


def read_weld_distance(obj: bpy.types.Object) -> float | None:
    """Return how far apart vertices are at most that Weld modifiers join; None if there are none."""
    found = [each.merge_threshold for each in obj.modifiers if each.type == "WELD" and each.show_viewport]
    return max(found, default=None)


def mapped(matrix: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points, shape (n, 3), after an affine map, shape (4, 4)."""
    moved: NDArray[np.float64] = points @ matrix[:3, :3].T + matrix[:3, 3]
    return moved


def _repeated(box: NDArray[np.float64], step: NDArray[np.float64], n_copies: int) -> NDArray[np.float64]:
    """Return the points, shape (n, 3), that hold the copies of a box: of those along a line the outermost."""
    import numpy as np

    if np.array_equal(step[:3, :3], np.eye(3)):
        return np.concatenate((box, box + (max(n_copies, 1) - 1) * step[:3, 3]))
    copies = [box]
    for _ in range(n_copies - 1):
        copies.append(mapped(step, copies[-1]))
    return np.concatenate(copies)


def _matrix(
    obj: bpy.types.Object, modifier: bpy.types.Modifier, size: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return Blender's map from a copy to the next one, of a mesh of this size along the axes."""
    import numpy as np

    step = np.eye(4)
    if modifier.use_constant_offset:
        step[:3, 3] += np.array(modifier.constant_offset_displace)
    if modifier.use_relative_offset:
        step[:3, 3] += np.array(modifier.relative_offset_displace) * size
    if modifier.use_object_offset and modifier.offset_object is not None:
        step = step @ np.array(obj.matrix_world.inverted_safe() @ modifier.offset_object.matrix_world)
    return step


def _count(modifier: bpy.types.Modifier, step: NDArray[np.float64]) -> int:
    """Return how many copies there are; two where that is measured along a curve."""
    import numpy as np

    if modifier.fit_type == "FIXED_COUNT":
        return int(modifier.count)
    length = float(np.linalg.norm(step[:3, 3]))
    if modifier.fit_type == "FIT_LENGTH" and length > 1e-6:
        return int((modifier.fit_length + 1e-6) / length) + 1
    return 2


def _joint(
    matrix: NDArray[np.float64], vertices: NDArray[np.float64], border: NDArray[np.intp], near: float
) -> Joint:
    """Return which vertices of borders a map brings next to others, each with the nearest one."""
    import numpy as np
    from mathutils.kdtree import KDTree

    tree = KDTree(len(border))
    for number, place in enumerate(mapped(matrix, vertices[border]).tolist()):
        tree.insert(place, number)
    tree.balance()
    pairs = []
    for number, place in enumerate(vertices[border].tolist()):
        _, other, distance = tree.find(place)
        if other is not None and distance <= near:
            pairs.append((border[number], border[other]))
    first, second = np.array(pairs, np.intp).reshape(-1, 2).T
    return Joint(matrix, first, second)
