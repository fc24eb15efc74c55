# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the faces of a mesh begin, which Blender keeps as an array but gives out one face at a time.

`foreach_get` asks every face, 30 ns each, which for two million faces takes four times as long as reading
everything else of the mesh.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

MANY_FACES = 20_000
"""Below this number of faces asking each of them takes no time that anybody would notice."""

_N_SAMPLES = 16


def read_face_starts(mesh: bpy.types.Mesh, starts: NDArray[np.int32]) -> None:
    """Read the first corner of each face.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        A mesh in Object Mode.
    starts : ndarray, shape (F,), int32
        Filled; contiguous.
    """
    address = _address_of_starts(mesh) if len(starts) >= MANY_FACES else None
    if address is None:
        mesh.polygons.foreach_get("loop_start", starts)
    else:
        ctypes.memmove(starts.ctypes.data, address, starts.nbytes)


def _address_of_starts(mesh: bpy.types.Mesh) -> int | None:
    """Return where Blender keeps the first corners of all faces, as 32-bit numbers; None if it is not clear.

    What Python holds of a face is the place of its number in the array. This is Blender's own business, so
    that it is believed only if the places of faces throughout the mesh lie as in such an array and the
    numbers there are those that the faces give.
    """
    polygons = mesh.polygons
    last = len(polygons) - 1
    address = polygons[0].as_pointer()
    samples = {min(1, last), *(last * number // _N_SAMPLES for number in range(_N_SAMPLES + 1))}
    if any(polygons[index].as_pointer() != address + 4 * index for index in samples):
        return None
    # All of it lies between the places of the first and the last face, so that it may be read.
    numbers = {index: ctypes.c_int32.from_address(address + 4 * index).value for index in samples}
    is_right = all(number == polygons[index].loop_start for index, number in numbers.items())
    return address if is_right else None
