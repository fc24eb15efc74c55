# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape that an artist sees of an object: its mesh, or with Multires the finest level."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..mesh_io import mesh_bridge
from ..modifier.multires import find_multires, level_object, reshape
from ..properties.output_choices import IN_PLACE
from .output import refusal

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh


def check_shape(obj: bpy.types.Object) -> None:
    """Raise ValueError with a sentence, if the shape of an object cannot be changed."""
    reason = refusal(obj, IN_PLACE)
    if reason is not None:
        raise ValueError(reason)


@contextmanager
def shape_of(obj: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Give an object whose mesh is the shape: the object itself, or one that is gone afterwards."""
    if find_multires(obj) is None:
        yield obj
        return
    with level_object(obj) as level:
        try:
            yield level
        except ValueError as error:
            raise ValueError(str(error).replace(f"‘{level.name}’", f"‘{obj.name}’")) from error


def write_shape(obj: bpy.types.Object, surface: SurfaceMesh, vertices: NDArray[np.floating]) -> None:
    """Give the shape of an object, which was read as `surface`, new positions, shape (N, 3)."""
    if find_multires(obj) is None:
        mesh_bridge.write_vertices(obj, surface, vertices)
    else:
        reshape(obj, vertices)


def check_cage(obj: bpy.types.Object, what: str, way: str = "") -> None:
    """Raise ValueError with a sentence, if the mesh of an object cannot be changed or is not its shape.

    Parameters
    ----------
    obj : bpy.types.Object
        Any object.
    what : str
        What the levels of Multires do not have.
    way : str
        The way to it that there is, if any, before that which there always is.
    """
    if find_multires(obj) is not None:
        raise ValueError(
            f"‘{obj.name}’ has a Multires modifier, whose levels have no {what}; {way}apply the modifier "
            "first."
        )
    reason = mesh_bridge.refusal(obj)
    if reason is not None:
        raise ValueError(reason)
