# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The values of a binary PLY file, by their bytes."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.ragged import stretches
from .mesh_file import FileError
from .ply_header import TYPES, Element, Table

_CODES = {
    "i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q",
}  # fmt: skip


class BinaryLayout:
    """Values at bytes."""

    def __init__(self, data: bytes, order: str) -> None:
        self._data, self._order = data, order
        self._bytes = np.frombuffer(data, np.uint8)

    def table(self, element: Element, begin: int) -> Table:
        """Find out where the values of an element are."""
        sizes = [np.dtype(TYPES[each.kind]).itemsize for each in element.properties]
        if not element.count or not element.properties:
            return Table(
                element, [np.zeros(0, np.int64)] * len(sizes), [np.zeros(0, np.int64)] * len(sizes), begin
            )
        uniform = self._uniform(element, sizes, begin)
        return uniform if uniform is not None else self._walked(element, sizes, begin)

    def _uniform(self, element: Element, sizes: list[int], begin: int) -> Table | None:
        """Find the values if all elements have lists as long as those of the first; else None."""
        starts, lengths, at = [], [], begin
        for each, size in zip(element.properties, sizes, strict=True):
            if each.count_kind:
                kind = np.dtype(self._order + TYPES[each.count_kind])
                length = int(self._one(at, kind))
                at += kind.itemsize
                starts.append(at)
                lengths.append(length)
                at += length * size
            else:
                starts.append(at)
                lengths.append(-1)
                at += size
        step = at - begin
        end = begin + step * element.count
        if end > len(self._data):
            if not any(each.count_kind for each in element.properties):
                raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")
            return None
        row = np.arange(element.count, dtype=np.int64) * step
        for each, start, length in zip(element.properties, starts, lengths, strict=True):
            if length >= 0:
                kind = np.dtype(self._order + TYPES[each.count_kind])
                found = np.ndarray((element.count,), kind, self._data, start - kind.itemsize, strides=(step,))
                if not (found == length).all():
                    return None
        counts = [None if length < 0 else np.full(element.count, length) for length in lengths]
        return Table(element, [start + row for start in starts], counts, end)

    def _one(self, at: int, kind: np.dtype) -> int:
        """Return one count."""
        if at + kind.itemsize > len(self._data):
            raise FileError("The file ends within a list; it was cut off.")
        count = int(np.frombuffer(self._data, kind, 1, at)[0])
        if kind.kind == "f" or count < 0:
            raise FileError(f"A list has {count} values; the file is damaged.")
        return count

    def _walked(self, element: Element, sizes: list[int], begin: int) -> Table:
        """Find the values of elements whose lists have different lengths, one element after the other."""
        steps: list[tuple[int, struct.Struct, int]] = []
        before = 0
        for each, size in zip(element.properties, sizes, strict=True):
            if each.count_kind:
                steps.append(
                    (before, struct.Struct((self._order or "<") + _CODES[TYPES[each.count_kind]]), size)
                )
                before = 0
            else:
                before += size
        fixed = before
        data, at, n_lists = self._data, begin, len(steps)
        found = np.empty((element.count, 2 * n_lists), np.int64)
        limit = len(data)
        for row in range(element.count):
            marks = []
            for skipped, count_of, size in steps:
                at += skipped
                if at + count_of.size > limit:
                    raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")
                (count,) = count_of.unpack_from(data, at)
                if count < 0:
                    raise FileError(f"A list has {count} values; the file is damaged.")
                at += count_of.size
                marks += [at, count]
                at += count * size
            found[row] = marks
            at += fixed
            if at > limit:
                raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")
        columns: list[NDArray[np.int64]] = []
        lengths: list[NDArray[np.int64] | None] = []
        which, last = 0, np.concatenate(([begin], np.zeros(element.count - 1, np.int64)))
        if n_lists:
            ends = found[:, -2] + found[:, -1] * steps[-1][2] + fixed
            last[1:] = ends[:-1]
        for each, size in zip(element.properties, sizes, strict=True):
            if each.count_kind:
                columns.append(found[:, 2 * which])
                lengths.append(found[:, 2 * which + 1])
                last = found[:, 2 * which] + found[:, 2 * which + 1] * size
                which += 1
            else:
                columns.append(last)
                lengths.append(None)
                last = last + size
        return Table(element, columns, lengths, at)

    def values(self, at: NDArray[np.int64], kind: str) -> NDArray[Any]:
        """Return the values at some bytes, shape (n,)."""
        dtype = np.dtype(self._order + kind)
        if not len(at):
            return np.zeros(0, kind)
        step = _common_step(at)
        if step:
            return np.ndarray((len(at),), dtype, self._data, int(at[0]), strides=(step,)).astype(kind)
        return self._gathered(at, dtype).astype(kind)

    def lists(self, at: NDArray[np.int64], lengths: NDArray[np.int64], kind: str) -> NDArray[np.int64]:
        """Return the values of all lists, one after the other."""
        dtype = np.dtype(self._order + kind)
        step = _common_step(at)
        if step and lengths[0] > 0 and (lengths == lengths[0]).all():
            shape, strides = (len(at), int(lengths[0])), (step, dtype.itemsize)
            rows = np.ndarray(shape, dtype, self._data, int(at[0]), strides=strides)
            return rows.reshape(-1).astype(np.int64)
        within = stretches(np.zeros_like(lengths), lengths)
        return self._gathered(np.repeat(at, lengths) + within * dtype.itemsize, dtype).astype(np.int64)

    def _gathered(self, at: NDArray[np.int64], dtype: np.dtype) -> NDArray[Any]:
        """Return values that begin at any bytes."""
        parts = self._bytes[at[:, None] + np.arange(dtype.itemsize)]
        return np.ascontiguousarray(parts).view(dtype).reshape(-1)

    def replaced(
        self,
        places: list[NDArray[np.int64]],
        kinds: list[str],
        moved: NDArray[np.bool_],
        after: NDArray[np.floating],
        _before: NDArray[np.float64],
    ) -> bytes:
        """Return the file with other values at some bytes."""
        result = bytearray(self._data)
        for axis, (at, kind) in enumerate(zip(places, kinds, strict=True)):
            dtype = np.dtype(self._order + kind)
            step = _common_step(at)
            if step:
                column = np.ndarray((len(at),), dtype, result, int(at[0]), strides=(step,))
                np.copyto(column, after[:, axis], where=moved, casting="unsafe")
                continue
            values = np.ascontiguousarray(after[moved, axis], dtype).view(np.uint8)
            letters = np.frombuffer(result, np.uint8)
            letters[at[moved, None] + np.arange(dtype.itemsize)] = values.reshape(-1, dtype.itemsize)
        return bytes(result)


def _common_step(at: NDArray[np.int64]) -> int:
    """Return the distance between places if it is the same everywhere; else 0."""
    if len(at) < 2:
        return len(at)
    step = int(at[1] - at[0])
    return step if (np.diff(at) == step).all() else 0
