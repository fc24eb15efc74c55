# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Pictures of the virtual screen: read, written as small PNG files, and measured."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

N_COLORS = 256


def read_screen(path: Path) -> np.ndarray:
    """Return what Xvfb shows, from its framebuffer in the format XWD.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        Rows from the top.
    """
    content = path.read_bytes()
    header = struct.unpack(">25I", content[:100])
    header_size, width, height = header[0], header[4], header[5]
    bits, row_size, n_colors = header[11], header[12], header[19]
    if bits != 32:
        raise ValueError(f"The screen has {bits} bits a pixel; start it with a depth of 24.")
    start = header_size + 12 * n_colors
    rows = np.frombuffer(content, np.uint8, height * row_size, start).reshape(height, row_size)
    blue_first = rows[:, : 4 * width].reshape(height, width, 4)
    if header[7] == 1:  # most significant byte first
        return blue_first[:, :, 1:].copy()
    return blue_first[:, :, 2::-1].copy()


def write_png(path: Path, picture: np.ndarray, n_colors: int = N_COLORS) -> None:
    """Write a picture, shape (height, width, 3), with at most 256 colors; fewer make a smaller file."""
    palette, indices = to_palette(picture, n_colors)
    height, width = indices.shape
    rows = np.zeros((height, width + 1), np.uint8)  # each row begins with the number of a filter, none
    rows[:, 1:] = indices
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        _write_chunk(file, b"IHDR", struct.pack(">2I5B", width, height, 8, 3, 0, 0, 0))
        _write_chunk(file, b"PLTE", palette.tobytes())
        _write_chunk(file, b"IDAT", zlib.compress(rows.tobytes(), 9))
        _write_chunk(file, b"IEND", b"")


def _write_chunk(file, name: bytes, content: bytes) -> None:
    file.write(struct.pack(">I", len(content)) + name + content)
    file.write(struct.pack(">I", zlib.crc32(name + content)))


def to_palette(picture: np.ndarray, n_colors: int = N_COLORS) -> tuple[np.ndarray, np.ndarray]:
    """Return at most `n_colors` colors, shape (n, 3), and the index of each pixel's color.

    The colors are boxes of the color cube, each cut in two where it is longest, the fullest and widest first.
    """
    packed = picture.astype(np.uint32) @ np.array([65536, 256, 1], np.uint32)
    codes, inverse, counts = np.unique(packed, return_inverse=True, return_counts=True)
    colors = np.stack([codes >> 16, codes >> 8 & 255, codes & 255], axis=1).astype(np.float64)
    boxes = [np.arange(len(codes))]
    spreads = [_spread(colors, counts, boxes[0])]
    while len(boxes) < n_colors and max(spreads) > 0:
        place = int(np.argmax(spreads))
        box = boxes[place]
        axis = int(np.argmax(np.ptp(colors[box], axis=0)))
        values = colors[box, axis]
        is_low = values <= 0.5 * (values.min() + values.max())
        parts = box[is_low], box[~is_low]
        boxes[place : place + 1] = parts
        spreads[place : place + 1] = [_spread(colors, counts, part) for part in parts]
    place_of = np.empty(len(codes), np.uint8)
    palette = np.empty((len(boxes), 3), np.uint8)
    for number, box in enumerate(boxes):
        place_of[box] = number
        palette[number] = np.round(np.average(colors[box], axis=0, weights=counts[box]))
    return palette, place_of[inverse.reshape(packed.shape)]


def _spread(colors: np.ndarray, counts: np.ndarray, box: np.ndarray) -> float:
    """Return how urgently a box of colors wants to be cut."""
    return float(np.ptp(colors[box], axis=0).max() ** 2 * np.sqrt(counts[box].sum()))


def changed(before: np.ndarray, after: np.ndarray, threshold: int = 12) -> float:
    """Return the share of pixels of which a color has changed by more than a threshold."""
    difference = np.abs(before.astype(np.int16) - after.astype(np.int16)).max(axis=2)
    return float((difference > threshold).mean())


def saturated(picture: np.ndarray, threshold: int = 30) -> float:
    """Return the share of pixels with a color that is far from gray."""
    return float((np.ptp(picture.astype(np.int16), axis=2) > threshold).mean())


def changed_box(before: np.ndarray, after: np.ndarray, threshold: int = 12) -> tuple[int, int, int, int]:
    """Return left, bottom, width and height of what has changed, as Blender counts pixels.

    Columns and rows of which less than half of the most changed one has changed do not count.
    """
    difference = np.abs(before.astype(np.int16) - after.astype(np.int16)).max(axis=2) > threshold
    ranges = []
    for axis in (0, 1):
        counts = difference.sum(axis=axis)
        places = np.flatnonzero(counts > 0.5 * max(counts.max(), 1))
        ranges.append((int(places[0]), int(places[-1]) + 1) if len(places) else (0, 0))
    (left, right), (top, bottom) = ranges
    return left, before.shape[0] - bottom, right - left, bottom - top
