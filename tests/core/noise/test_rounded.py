# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rounded coordinates are noise that AUTO sees; vertices that stand in steps of their own are none."""

import numpy as np
import pytest
from checks import assert_same_bits, lengths
from framelet.core import DenoiseSettings, SurfaceMesh, compare, denoise
from meshes import triangle_grid

SIDE = 50
AUTO = DenoiseSettings(threads=1)


def hills(step=0.0):
    """Return ground over a grid, with heights in whole steps if these are not 0."""
    rows, columns = np.mgrid[:SIDE, :SIDE].astype(float)
    heights = 6 * np.sin(rows / 9) * np.cos(columns / 7)
    heights = np.round(heights / step) * step if step else heights
    return triangle_grid(SIDE, SIDE).with_vertices(np.stack((columns, rows, heights), -1).reshape(-1, 3))


def lathe(radius_at):
    """Return a body of revolution whose rings stand one step apart."""
    angle, height = np.mgrid[:40, :60] * np.array([2 * np.pi / 40, 0.15])[:, None, None]
    radius = radius_at(height)
    points = np.stack((radius * np.cos(angle), radius * np.sin(angle), height), axis=-1)
    number = np.arange(2400).reshape(40, 60)
    quads = np.stack(
        (number, np.roll(number, -1, 0), np.roll(number, (-1, -1), (0, 1)), np.roll(number, -1, 1))
    )
    return SurfaceMesh.from_faces(points.reshape(-1, 3), quads[..., :-1].reshape(4, -1).T)


@pytest.mark.parametrize("step", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("strength", [1.0, 0.8])
def test_heights_in_steps_become_hills_again(step, strength):
    clean, rounded = hills(), hills(step)
    result = denoise(rounded, AUTO.with_changes(strength=strength))
    before, after = compare(rounded, clean), compare(clean.with_vertices(result.vertices), clean)
    assert result.report.noise.steps == "ROUNDED" and result.report.noise.wide == 1
    assert after.mean_angle < 0.3 * before.mean_angle and after.rms_distance < 0.8 * before.rms_distance


def test_who_says_fine_gets_fine():
    result = denoise(hills(1.0), AUTO.with_changes(noise="FINE"))
    assert result.report.noise.steps != "ROUNDED" and result.report.noise.wide == 0


@pytest.mark.parametrize(
    "radius_at", [np.ones_like, lambda z: 0.3 + z / 9, lambda z: 1 + 0.5 * np.sin(2 * z)]
)
def test_rings_in_steps_are_no_rounding(radius_at):
    mesh = lathe(radius_at)
    result = denoise(mesh, AUTO)
    assert result.report.noise.steps == "" and result.report.noise.wide == 0
    assert lengths(result.vertices - mesh.vertices).max() < 0.1 * result.report.mean_edge_length


def test_slopes_of_whole_steps_are_no_rounding():
    rows, columns = np.mgrid[:SIDE, :SIDE].astype(float)
    roof = triangle_grid(SIDE, SIDE).with_vertices(
        np.stack((columns, rows, SIDE / 2 - np.abs(rows - SIDE / 2)), -1).reshape(-1, 3)
    )
    assert_same_bits(denoise(roof, AUTO).vertices, roof.vertices)


def test_a_rounded_mesh_of_which_nothing_may_move_stays(recwarn):
    rounded = hills(1.0)
    stays = np.zeros(rounded.n_vertices, bool)
    stays[: SIDE + 1] = True  # on the border, which is fixed
    result = denoise(rounded, AUTO.with_changes(boundary="FIXED"), movable=stays)
    moved = lengths(result.vertices - rounded.vertices) > 0
    assert np.count_nonzero(moved) <= 1 and not recwarn.list
