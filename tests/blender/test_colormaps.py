# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The color maps are even to the eye, and their colors can be shown."""

import numpy as np
import pytest
from framelet.operators.colors import colormaps
from framelet.operators.colors.colormaps import DIVERGING, SEQUENTIAL, map_colors

LINEAR_TO_CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
"""From Ottosson's definition of OKLab, the other way than the module goes."""

CUBE_ROOTS_TO_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


def lab_of(colors):
    return np.cbrt(colors[:, :3].astype(np.float64) @ LINEAR_TO_CONES.T) @ CUBE_ROOTS_TO_LAB.T


@pytest.fixture(params=[DIVERGING, SEQUENTIAL], ids=["diverging", "sequential"])
def colormap(request):
    return request.param


def samples(colormap):
    return map_colors(colormap, np.linspace(colormap.low, colormap.high, 2001))


def test_colors_are_scene_linear_and_in_range(colormap):
    colors = samples(colormap)
    assert colors.shape == (2001, 4) and colors.dtype == np.float32
    assert (colors[:, 3] == 1).all()
    assert colors.min() >= 0 and colors.max() <= 1
    # Nothing is clipped, so that what the eye sees is what was interpolated.
    assert colors[:, :3].min() > 0.001 and colors[:, :3].max() < 0.999


def test_anchors_have_the_colors_they_are_given(colormap):
    places = np.linspace(colormap.low, colormap.high, len(colormap.anchors))
    lab = lab_of(map_colors(colormap, places))
    lightness, chroma, hue = np.array(colormap.anchors).T
    assert np.allclose(lab[:, 0], lightness, atol=1e-5)
    assert np.allclose(np.hypot(lab[:, 1], lab[:, 2]), chroma, atol=1e-5)
    is_colored = chroma > 0
    found = np.degrees(np.arctan2(lab[:, 2], lab[:, 1])) % 360
    assert np.allclose(found[is_colored], hue[is_colored], atol=0.01)


def test_lightness_is_monotone():
    lightness = lab_of(samples(SEQUENTIAL))[:, 0]
    assert (np.diff(lightness) < 0).all()
    lightness = lab_of(samples(DIVERGING))[:, 0]
    assert (np.diff(lightness[:1001]) > 0).all() and (np.diff(lightness[1000:]) < 0).all()


def test_both_sides_are_alike():
    lab = lab_of(samples(DIVERGING))
    assert np.allclose(lab[:, 0], lab[::-1, 0], atol=1e-5)
    chroma = np.hypot(lab[:, 1], lab[:, 2])
    assert np.allclose(chroma, chroma[::-1], atol=0.01)


def test_zero_is_gray(colormap):
    color = map_colors(colormap, [0.0])[0]
    assert np.ptp(color[:3]) < 1e-3 and color[0] > 0.7


def test_steps_look_alike(colormap):
    steps = np.linalg.norm(np.diff(lab_of(samples(colormap)), axis=0), axis=1)
    assert steps.max() < 2.0 * steps.min()


def test_signs_can_be_told_apart():
    blue, red = map_colors(DIVERGING, [-0.7, 0.7])
    assert blue[2] > 3 * blue[0] and red[0] > 3 * red[2]


def test_values_beyond_take_the_last_color(colormap):
    ends = map_colors(colormap, [colormap.low, colormap.high])
    assert np.array_equal(map_colors(colormap, [colormap.low - 5, colormap.high + 5]), ends)


def test_black_and_white():
    colors = colormaps.lab_to_linear(np.array([[0.0, 0, 0], [1, 0, 0]]))
    assert np.allclose(colors, [[0, 0, 0], [1, 1, 1]], atol=1e-6)
