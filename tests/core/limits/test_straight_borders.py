# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frayed and zigzag borders become smooth, whatever the method; smooth ones and corners stay."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import PRESETS, Region, SurfaceMesh, denoise
from framelet.core.limits.straight_borders import find_curves, straightened
from framelet.core.mesh.borders import border_vertices
from meshes import triangle_grid, triangle_torus

METHODS = ("AUTO", "TRI_2", "BILATERAL")
STRAIGHT = Region(straighten_borders=True)
SIZE = 40


def sheet():
    """Return a flat triangle grid of SIZE x SIZE vertices with edges of length 1, float64."""
    grid = triangle_grid(SIZE, SIZE)
    points = np.stack((np.arange(SIZE**2) // SIZE, np.arange(SIZE**2) % SIZE, np.zeros(SIZE**2)), axis=1)
    return grid.with_vertices(points.astype(np.float64))


def disk(rings=16):
    """Return a disk of triangles around the origin, with edges of about 1, and its border."""
    points, faces, begin = [(0.0, 0.0, 0.0)], [], 1
    number = 6 * rings
    for ring in range(1, rings + 1):
        turn = 2.0 * np.pi * np.arange(number) / number
        points += np.stack((ring * np.cos(turn), ring * np.sin(turn), 0.0 * turn), axis=1).tolist()
        for k in range(number):
            after = (k + 1) % number
            if ring == 1:
                faces.append((0, 1 + k, 1 + after))
            else:
                faces.append((begin + k - number, begin + k, begin + after))
                faces.append((begin + k - number, begin + after, begin + after - number))
        begin += number
    return SurfaceMesh.from_faces(points, faces)


def off_square(points):
    """Return how far points are from the square that the border of the sheet was."""
    x, y, z = points.T
    side = np.minimum.reduce([np.abs(x), np.abs(y), np.abs(x - SIZE + 1), np.abs(y - SIZE + 1)])
    return np.hypot(side, z)


@pytest.fixture
def frayed(rng):
    """A sheet with a jitter of 0.3 edges at its border alone, in all directions; and the border."""
    clean = sheet()
    border = border_vertices(clean)
    points = clean.vertices.copy()
    points[border] += 0.3 * rng.standard_normal((border.sum(), 3))
    return clean.with_vertices(points), border


@pytest.mark.parametrize("method", METHODS)
def test_a_frayed_border_becomes_straight_and_keeps_its_corners(frayed, method):
    surface, border = frayed
    before = np.sqrt((off_square(surface.vertices[border]) ** 2).mean())
    result = denoise(surface, PRESETS[method].settings, region=STRAIGHT).vertices
    after = np.sqrt((off_square(result[border]) ** 2).mean())
    assert before > 0.35
    assert after < 0.5 * before
    corners = [0, SIZE - 1, SIZE**2 - SIZE, SIZE**2 - 1]
    assert np.linalg.norm(result[corners] - sheet().vertices[corners], axis=1).max() < 0.9


@pytest.mark.parametrize("method", METHODS)
def test_a_zigzag_around_a_disk_becomes_round(method):
    surface = disk()
    border = border_vertices(surface)
    points = surface.vertices.copy()
    points[border] *= 1.0 + 0.025 * (-1.0) ** np.arange(border.sum())[:, None]
    given = np.ptp(np.linalg.norm(points[border], axis=1))
    result = denoise(surface.with_vertices(points), PRESETS[method].settings, region=STRAIGHT).vertices
    assert given > 0.79
    radius = np.linalg.norm(result[border], axis=1)
    assert np.ptp(radius) < 0.02
    assert abs(radius.mean() - 16.0) < 0.1


def test_without_the_option_the_fray_stays_longer(frayed):
    surface, border = frayed
    settings = PRESETS["TRI_2"].settings
    without, with_it = (denoise(surface, settings, region=each).vertices for each in (Region(), STRAIGHT))
    rms = [np.sqrt((off_square(each[border]) ** 2).mean()) for each in (without, with_it)]
    assert rms[0] > 2.0 * rms[1]


@pytest.mark.parametrize("surface", [sheet(), disk()], ids=["sheet", "disk"])
def test_smooth_borders_stay(surface):
    result = denoise(surface, PRESETS["AUTO"].settings, region=STRAIGHT).vertices
    border = border_vertices(surface)
    assert_same_bits(result[border], surface.vertices[border])


def test_vertices_that_may_not_move_stay(frayed):
    surface, border = frayed
    movable = surface.vertices[:, 0] > SIZE / 2
    result = denoise(surface, PRESETS["TRI_2"].settings, movable=movable, region=STRAIGHT).vertices
    assert_same_bits(result[~movable], surface.vertices[~movable])
    assert (result[movable & border] != surface.vertices[movable & border]).any(axis=1).mean() > 0.9


def test_a_fixed_boundary_stays(frayed):
    surface, border = frayed
    settings = PRESETS["TRI_2"].settings.with_changes(boundary="FIXED")
    result = denoise(surface, settings, region=STRAIGHT).vertices
    assert_same_bits(result[border], surface.vertices[border])


def test_the_unit_does_not_matter(frayed):
    surface, _ = frayed
    settings = PRESETS["TRI_2"].settings
    one = denoise(surface, settings, region=STRAIGHT, dtype=np.float64).vertices
    large = surface.with_vertices(1024.0 * surface.vertices)
    other = denoise(large, settings, region=STRAIGHT, dtype=np.float64).vertices
    np.testing.assert_allclose(other / 1024.0, one, atol=1e-9)


def test_a_closed_mesh_has_no_border():
    torus = triangle_torus()
    settings = PRESETS["TRI_2"].settings
    assert_same_bits(denoise(torus, settings, region=STRAIGHT).vertices, denoise(torus, settings).vertices)


def test_curves_are_told_apart_and_short_ones_stay(rng):
    around = np.concatenate(
        [(np.arange(n)[:, None] + [-1, 1]) % n + first for n, first in ((40, 0), (6, 40))]
    )
    curves = find_curves(around)
    assert curves.curve.tolist() == [0] * 40 + [1] * 6
    turn = np.concatenate([np.linspace(0, 2 * np.pi, n, endpoint=False) for n in (40, 6)])
    points = (
        np.stack((np.cos(turn), np.sin(turn), 0.0 * turn)) * np.repeat([40.0, 6.0], (40, 6)) / (2 * np.pi)
    )
    points += 0.2 * rng.standard_normal(points.shape)
    motion = straightened(points, curves, np.zeros(46, bool))
    assert motion[:, :40].any(axis=0).all()
    assert not motion[:, 40:].any()
