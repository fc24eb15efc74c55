# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the system gives no more memory: a sentence, as for all else that cannot be done."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    import bpy

_MARGIN = 1_000_000
"""Numbers of four bytes beyond the arrays of a mesh, for what Blender itself keeps of a call."""


@contextmanager
def shortage_told(name: str) -> Iterator[None]:
    """Say what a `MemoryError` means, as a ValueError with one sentence.

    Parameters
    ----------
    name : str
        Of the object that is worked on.

    Examples
    --------
    >>> with shortage_told("Cube"):
    ...     raise MemoryError
    Traceback (most recent call last):
    ValueError: There is not enough memory for ‘Cube’; close other programs, or work on a smaller mesh.
    """
    try:
        yield
    except MemoryError as error:
        raise ValueError(
            f"There is not enough memory for ‘{name}’; close other programs, or work on a smaller mesh."
        ) from error


def reserve_for_reading(mesh: bpy.types.Mesh) -> None:
    """Raise MemoryError unless there is room for reading a mesh.

    Where a mesh shares arrays with an undo step, Blender copies each of them before it shows it, and ends
    itself where it gets no memory for a copy.
    """
    import numpy as np

    n_numbers = 3 * len(mesh.vertices) + 2 * len(mesh.edges) + 2 * len(mesh.loops) + len(mesh.polygons)
    np.empty(2 * n_numbers + _MARGIN, np.float32)  # the copies, and what is read


def reserve_for_writing(obj: bpy.types.Object) -> None:
    """Raise MemoryError unless there is room for all that writing a result takes.

    A result is written in several steps, which cannot all be taken back. What they need is asked for before
    the first one, and given back at once.
    """
    import numpy as np

    mesh = obj.data
    n_keys = 0 if mesh.shape_keys is None else len(mesh.shape_keys.key_blocks)
    n_vectors = (16 + 4 * n_keys) * len(mesh.vertices) + 8 * len(mesh.loops)
    np.empty(3 * n_vectors + _MARGIN, np.float32)
