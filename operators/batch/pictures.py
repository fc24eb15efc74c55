# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of surfaces, drawn with NumPy alone, as PNG files."""

from __future__ import annotations

import struct
import zlib
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..files.convert import triangles_of

SMOOTHING = 2
"""Points for each pixel in each direction, whose mean it is."""

MOST_SAMPLES = 2**22
_LIGHT = np.array([-0.45, 0.5, 0.74])
_BACKGROUND = 1.0


class View(NamedTuple):
    """From where surfaces are seen."""

    axes: NDArray[np.float64]
    """Shape (3, 3): right, up, and towards the eye."""
    center: NDArray[np.float64]
    """Shape (3,)."""
    width: float
    """Length that the picture shows."""


def view_of(positions: NDArray[np.floating]) -> View:
    """Return a view on which a surface is as wide as can be.

    Parameters
    ----------
    positions : ndarray, shape (N, 3)
        The vertices; those that are no finite points are left out.

    Examples
    --------
    >>> view_of(np.array([[0, 0, 0], [4, 0, 0], [0, 2, 0], [4, 2, 0]])).width
    4.0
    """
    points = np.asarray(positions, np.float64)
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return View(np.eye(3), np.zeros(3), 1.0)
    low, high = points.min(axis=0), points.max(axis=0)
    center = (low + high) / 2
    step = max(1, len(points) // 20000)
    scaled = (points[::step] - center) / (float((high - low).max()) or 1.0)
    axes = np.linalg.eigh(scaled.T @ scaled)[1][:, ::-1].T
    # The same side whatever the sign that the solver gives.
    for axis in axes[:2]:
        axis *= np.sign(axis[np.abs(axis).argmax()]) or 1.0
    axes[2] = np.cross(axes[0], axes[1])
    across = (points - center) @ axes[:2].T
    center = center + axes[:2].T @ ((across.min(axis=0) + across.max(axis=0)) / 2)
    return View(axes, center, float(np.ptp(across, axis=0).max()) or 1.0)


def picture(
    positions: NDArray[np.floating],
    face_offset: NDArray[np.integer],
    corner_vertex: NDArray[np.integer],
    view: View,
    size: int = 240,
) -> NDArray[np.uint8]:
    """Draw a surface in flat shades of gray.

    Parameters
    ----------
    positions : ndarray, shape (N, 3)
        Vertices.
    face_offset : ndarray, shape (F + 1,), int
        First corner of each face, and the number of corners.
    corner_vertex : ndarray, shape (C,), int
        Vertex of each corner.
    view : View
        From where it is seen.
    size : int
        Pixels on each side.

    Returns
    -------
    ndarray, shape (size, size), uint8
        White where there is nothing; the first row is the top.

    Examples
    --------
    >>> points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> drawn = picture(points, np.array([0, 4]), np.arange(4), view_of(points), 40)
    >>> drawn.shape, bool(drawn[20, 20] < 255), int(drawn[0, 0])
    ((40, 40), True, 255)
    """
    n = size * SMOOTHING
    triangles = triangles_of(np.asarray(face_offset, np.int64), corner_vertex)
    scale = n * 0.94 / view.width
    seen = (np.asarray(positions, np.float64) - view.center) @ view.axes.T * scale
    seen[:, :2] += n / 2
    corners = seen[triangles]
    corners = corners[np.isfinite(corners).all(axis=(1, 2))]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    corners, normals = corners[lengths > 0], normals[lengths > 0] / lengths[lengths > 0][:, None]
    normals *= np.where(normals[:, 2:] < 0, -1.0, 1.0)  # both sides are lit
    shade = 0.12 + 0.8 * np.clip(normals @ _LIGHT, 0.0, 1.0)
    depth, image = np.full(n * n, -np.inf), np.full(n * n, _BACKGROUND)
    edges = np.abs(corners - np.roll(corners, 1, axis=1))[:, :, :2].max(axis=(1, 2), initial=0.0)
    steps = 2 ** np.ceil(np.log2(np.clip(edges * 1.5 + 1.0, 1.0, 2.0 * n))).astype(int)
    for step in np.unique(steps).tolist():
        same = np.flatnonzero(steps == step)
        weights = _weights(step)
        for part in np.array_split(same, len(same) * len(weights) // MOST_SAMPLES + 1):
            _draw(depth, image, corners[part], shade[part], weights, n)
    small = image.reshape(size, SMOOTHING, size, SMOOTHING).mean(axis=(1, 3))
    return np.round(small * 255).astype(np.uint8)


def _weights(step: int) -> NDArray[np.float64]:
    """Return barycentric weights of points that lie evenly in a triangle, shape (K, 3)."""
    first, second = np.meshgrid(np.arange(step), np.arange(step), indexing="ij")
    inside = first + second < step
    u, v = (first[inside] + 1 / 3) / step, (second[inside] + 1 / 3) / step
    return np.stack((u, v, 1.0 - u - v), axis=1)


def _draw(
    depth: NDArray[np.float64],
    image: NDArray[np.float64],
    corners: NDArray[np.float64],
    shade: NDArray[np.float64],
    weights: NDArray[np.float64],
    n: int,
) -> None:
    """Draw triangles where nothing nearer is drawn yet."""
    points = np.einsum("kc,tcd->tkd", weights, corners).reshape(-1, 3)
    column, row = points[:, 0].astype(np.int64), n - 1 - points[:, 1].astype(np.int64)
    inside = (column >= 0) & (column < n) & (row >= 0) & (row < n)
    pixel = row[inside] * n + column[inside]
    near, color = points[inside, 2], np.repeat(shade, len(weights))[inside]
    np.maximum.at(depth, pixel, near)
    is_seen = near >= depth[pixel]
    image[pixel[is_seen]] = color[is_seen]


def as_png(gray: NDArray[np.uint8]) -> bytes:
    """Return a picture as the bytes of a PNG file.

    Parameters
    ----------
    gray : ndarray, shape (H, W), uint8

    Examples
    --------
    >>> as_png(np.zeros((2, 3), np.uint8))[:8]
    b'\\x89PNG\\r\\n\\x1a\\n'
    """
    height, width = gray.shape
    rows = np.zeros((height, width + 1), np.uint8)  # each begins with its filter: none
    rows[:, 1:] = gray

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        chunk(kind, data)
        for kind, data in ((b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b""))
    )
