# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small files with a known truth, if they are there: a frayed border, and spikes."""

import numpy as np
import pytest
from framelet.core import PRESETS, Region, denoise
from framelet.core.mesh.borders import border_vertices
from framelet.core.mesh.geometry import mean_edge_length
from framelet.core.mesh.spikes import find_spikes, flattened
from mesh_files import read_mesh


@pytest.fixture
def case(shared_meshes):
    """Give a function that returns a mesh and how far, in mean edges, a result is off the clean one."""

    def read(name):
        folder = shared_meshes.parent / "cases"
        if not (folder / "clean" / f"{name}.npy").is_file():
            pytest.skip(f"needs {name} among the small files with a known truth")
        noisy = read_mesh(folder / f"{name}.ply")
        clean = noisy.with_vertices(np.load(folder / "clean" / f"{name}.npy").astype(np.float32))
        edge = mean_edge_length(clean)
        return noisy, lambda vertices: np.linalg.norm(vertices - clean.vertices, axis=1) / edge

    return read


def test_the_frayed_border_becomes_as_smooth_as_the_inside(case):
    noisy, error = case("frayed_border")
    border = border_vertices(noisy)
    found = error(denoise(noisy, PRESETS["AUTO"].settings, region=Region(straighten_borders=True)).vertices)
    rms = np.sqrt((found**2).mean(where=border)), np.sqrt((found**2).mean(where=~border))
    assert error(noisy.vertices)[border].max() > 3.0
    assert rms[0] < 1.1 * rms[1] < 0.5 and found[border].max() < 1.2


def test_all_spikes_of_the_terrain_come_down(case):
    noisy, error = case("spikes")
    high = error(noisy.vertices) > 0.5
    spikes = find_spikes(noisy)
    assert high.sum() == 25
    np.testing.assert_array_equal(spikes, high)
    assert error(flattened(noisy, spikes)).max() < 0.2


@pytest.mark.parametrize("preset", ["AUTO", "POSITIONS", "TRI_1", "BILATERAL"])
def test_spikes_come_down_as_part_of_denoising(preset, case):
    """Of their height 84 to 100 % was left, except with Automatic."""
    noisy, error = case("spikes")
    high = error(noisy.vertices)
    found = error(denoise(noisy, PRESETS[preset].settings, region=Region(flatten_spikes=True)).vertices)
    spikes = high > 0.5
    assert found[spikes].sum() < 0.05 * high[spikes].sum()
    assert found.max() < 0.5
