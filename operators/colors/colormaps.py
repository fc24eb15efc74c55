# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two color maps for numbers on surfaces, even to the eye. Knows numpy only.

Colors are interpolated in OKLab (Ottosson 2020), where equal steps look equal, between a few anchors given
as lightness, chroma and hue. Zero is a light gray in both maps, so that the surface's shading stays visible.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class Colormap(NamedTuple):
    """Colors for values from `low` to `high`.

    The anchors are evenly spaced, each given as lightness, chroma, and hue in degrees.
    """

    low: float
    high: float
    anchors: tuple[tuple[float, float, float], ...]


DIVERGING = Colormap(
    -1.0,
    1.0,
    (
        (0.36, 0.130, 262.0),
        (0.56, 0.150, 255.0),
        (0.76, 0.085, 248.0),
        (0.93, 0.000, 0.0),
        (0.76, 0.085, 45.0),
        (0.56, 0.150, 35.0),
        (0.36, 0.130, 25.0),
    ),
)
"""Blue, light gray, red: for signed values; both sides have the same lightness and chroma."""

SEQUENTIAL = Colormap(
    0.0,
    1.0,
    (
        (0.93, 0.000, 0.0),
        (0.84, 0.110, 85.0),
        (0.69, 0.150, 55.0),
        (0.53, 0.165, 22.0),
        (0.38, 0.130, 350.0),
        (0.25, 0.085, 310.0),
    ),
)
"""Light gray through orange to dark violet: for magnitudes."""

WITHIN = (0.72, 0.16, 150.0)
"""Green, which is in neither map: for values within a tolerance."""

_LAB_TO_CUBE_ROOTS = np.array(
    [
        [1.0, 0.3963377774, 0.2158037573],
        [1.0, -0.1055613458, -0.0638541728],
        [1.0, -0.0894841775, -1.2914855480],
    ]
)
_CONES_TO_LINEAR = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)


def map_colors(colormap: Colormap, values: ArrayLike, tolerance: float | None = None) -> NDArray[np.float32]:
    """Return the colors of values.

    Parameters
    ----------
    colormap : Colormap
        Which colors.
    values : array_like, shape (N,)
        From `colormap.low` to `colormap.high`; values beyond take the color of the end.
    tolerance : float, optional
        Values of at most this magnitude are green.

    Returns
    -------
    ndarray, shape (N, 4), float32
        Scene-linear red, green, blue (Rec. 709), from 0 to 1, and alpha 1.
    """
    values = np.asarray(values, np.float64)
    lightness, chroma, hue = np.array((*colormap.anchors, WITHIN)).T
    anchors = np.stack((lightness, chroma * np.cos(np.radians(hue)), chroma * np.sin(np.radians(hue))))
    places = np.linspace(colormap.low, colormap.high, len(colormap.anchors))
    lab = np.stack([np.interp(values, places, row[:-1]) for row in anchors], axis=-1)
    if tolerance is not None:
        lab[np.abs(values) <= tolerance] = anchors[:, -1]
    colors = np.ones((len(lab), 4), np.float32)
    colors[:, :3] = np.clip(lab_to_linear(lab), 0.0, 1.0)
    return colors


def lab_to_linear(lab: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return linear Rec. 709 colors of OKLab colors, both shape (N, 3); not clipped."""
    return (lab @ _LAB_TO_CUBE_ROOTS.T) ** 3 @ _CONES_TO_LINEAR.T
