# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spikes come down before the run, with every method and in every precision."""

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, lengths, wild_mesh
from framelet.core import PRESETS, DenoiseSettings, Region, denoise
from framelet.core.mesh.geometry import vertex_normals
from meshes import faces_of, noisy, triangle_torus
from region_cases import METHODS, exploded

FLATTEN = Region(flatten_spikes=True)
SETTINGS = {name: PRESETS[name].settings for name in METHODS}
SETTINGS["FROM_NOISE"] = DenoiseSettings(method="POSITIONS", tuning="NOISE")


@pytest.fixture
def spiked():
    """A clean torus, the same with five spikes and a pair, and the vertices of these."""
    clean = triangle_torus(36, 96)
    edge = edge_length(clean)
    vertices = clean.vertices.copy()
    spikes = np.array([100, 700, 1300, 1301, 2000, 2600, 3200])
    vertices[spikes] += 5.0 * edge * vertex_normals(clean)[spikes]
    return clean, clean.with_vertices(vertices), spikes


def height_left(clean, vertices, spikes):
    """Return the share of the height of 5 edges that is left, of the highest spike."""
    return lengths(vertices - clean.vertices)[spikes].max() / (5.0 * edge_length(clean))


@pytest.mark.parametrize("name", SETTINGS)
def test_spikes_come_down(name, spiked):
    clean, mesh, spikes = spiked
    found = denoise(mesh, SETTINGS[name], region=FLATTEN)
    assert height_left(clean, found.vertices, spikes) < 0.12
    if name != "AUTO":  # which brings them down by itself
        assert height_left(clean, denoise(mesh, SETTINGS[name]).vertices, spikes) > 0.8


def test_without_noise_the_rest_stays(spiked):
    """The spikes were taken for impulsive noise, so that all vertices moved."""
    clean, mesh, spikes = spiked
    settings = SETTINGS["FROM_NOISE"]
    found = denoise(mesh, settings, region=FLATTEN).vertices
    others = np.setdiff1d(np.arange(mesh.n_vertices), spikes)
    assert lengths(found - clean.vertices)[others].max() < 0.02 * edge_length(clean)


@pytest.mark.parametrize("name", SETTINGS)
def test_without_spikes_nothing_changes(name, rng):
    mesh = noisy(triangle_torus(24, 64), rng, 0.1 * edge_length(triangle_torus(24, 64)))
    expected = denoise(mesh, SETTINGS[name])
    assert_same_bits(denoise(mesh, SETTINGS[name], region=FLATTEN).vertices, expected.vertices)


@pytest.mark.parametrize("name", METHODS)
def test_spikes_that_may_not_move_stay(name, spiked):
    clean, mesh, spikes = spiked
    movable = np.ones(mesh.n_vertices, bool)
    movable[spikes[:2]] = False
    found = denoise(mesh, SETTINGS[name], movable=movable, region=FLATTEN).vertices
    assert_same_bits(found[spikes[:2]], mesh.vertices[spikes[:2]])
    assert height_left(clean, found, spikes[2:]) < 0.3


@pytest.mark.parametrize("name", METHODS)
def test_the_limit_holds_for_spikes(name, spiked):
    clean, mesh, _ = spiked
    limit = 2.0 * edge_length(clean)
    region = Region(flatten_spikes=True, max_displacement=limit)
    found = denoise(mesh, SETTINGS[name], region=region).vertices
    assert limit * 0.99 < lengths(found - mesh.vertices).max() < limit * 1.000001


def test_a_soup_has_its_spikes_at_welded_vertices(spiked):
    clean, mesh, spikes = spiked
    soup, corner = exploded(mesh)
    region = Region(flatten_spikes=True, weld_distance=0.0)
    found = denoise(soup, SETTINGS["TRI_2"], region=region).vertices
    expected = denoise(mesh, SETTINGS["TRI_2"], region=FLATTEN).vertices
    assert height_left(clean, expected, spikes) < 0.12
    assert lengths(found - expected[corner]).max() < 0.02 * edge_length(clean)


def test_numbers_do_not_matter(spiked, rng):
    _, mesh, _ = spiked
    new = rng.permutation(mesh.n_vertices)
    vertices = np.empty_like(mesh.vertices)
    vertices[new] = mesh.vertices
    other = wild_mesh(vertices, [new[face] for face in faces_of(mesh)])
    found = denoise(other, SETTINGS["TRI_2"], region=FLATTEN, dtype=np.float64).vertices
    expected = denoise(mesh, SETTINGS["TRI_2"], region=FLATTEN, dtype=np.float64).vertices
    assert lengths(found[new] - expected).max() < 1e-9
