# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a region accepts, what it refuses in which words, and what users' options become."""

from dataclasses import fields

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import PRESETS, Region, denoise
from framelet.operators.properties.region_options import RegionOptions
from meshes import noisy, triangle_torus

TRI_2 = PRESETS["TRI_2"].settings


@pytest.fixture
def mesh(rng):
    return noisy(triangle_torus(), rng)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"weights": np.array([0.5, 1.5])}, r"weight of vertex 1 is 1\.5; weights must be between 0 and 1"),
        ({"weights": np.array([-0.1, 1.0])}, r"weight of vertex 0 is -0\.1"),
        ({"weights": np.array([0.0, np.nan])}, "weight of vertex 1 is nan"),
        ({"weights": np.ones((3, 1))}, r"float64 of shape \(3, 1\); expected one real number a vertex"),
        ({"weights": np.ones(3, complex)}, r"weights are complex128 of shape \(3,\)"),
        ({"feature_edges": np.zeros((2, 3), int)}, r"int64 of shape \(2, 3\); expected whole numbers"),
        ({"feature_edges": np.zeros((2, 2))}, r"float64 of shape \(2, 2\)"),
        ({"max_displacement": -1.0}, "largest displacement is -1; it must be 0 or a positive number"),
        ({"max_displacement": np.nan}, "largest displacement is nan"),
        ({"max_displacement": np.inf}, "largest displacement is inf"),
        ({"max_displacement": "far"}, "largest displacement is 'far'; it must be a number"),
        ({"max_displacement": True}, "largest displacement is True"),
        ({"weld_distance": -1e-9}, "weld distance is -1e-09"),
        ({"weights": [[1], [1, 2]]}, r"weights are \[\[1\], \[1, 2\]\]; give an array"),
        ({"feature_edges": [[0, 1], [2]]}, "feature edges are .*; give an array"),
        ({"weldable": [[True], []]}, "weldable vertices are .*; give an array"),
        ({"keep_volume": None}, "choice 'keep volume' is None; it must be True or False"),
        ({"flatten_spikes": "no"}, "choice 'flatten spikes' is 'no'; it must be True or False"),
    ],
)
def test_wrong_values_are_refused(values, message):
    with pytest.raises(ValueError, match=message):
        Region(**values)


@pytest.mark.parametrize(
    ("region", "message"),
    [
        (Region(weights=np.ones(5)), "There are 5 weights for 192 vertices; give one for each"),
        (Region(weights=np.zeros(192)), "All weights are 0, so that no vertex may move"),
        (Region(feature_edges=np.array([[0, 192]])), "names vertex 192, but there are 192 vertices"),
        (Region(feature_edges=np.array([[-1, 2]])), "names vertex -1, but there are 192 vertices"),
        (Region(weld_distance=100.0), "up to 100 apart leaves no face; take a smaller merge distance"),
    ],
)
def test_regions_that_do_not_fit_a_mesh_are_refused(region, message, mesh):
    before = mesh.vertices.copy()
    with pytest.raises(ValueError, match=message):
        denoise(mesh, TRI_2, region=region)
    assert_same_bits(mesh.vertices, before)


def test_selection_and_weights_that_exclude_each_other_are_refused(mesh):
    weights = np.zeros(192)
    weights[:5] = 1.0
    with pytest.raises(ValueError, match="No vertex may move: those that are selected have weight 0"):
        denoise(mesh, TRI_2, movable=weights == 0.0, region=Region(weights=weights))


@pytest.mark.parametrize("preset", ["AUTO", "TRI_1", "TRI_2", "BILATERAL", "POSITIONS"])
def test_a_region_without_limits_changes_nothing(preset, mesh):
    plain = Region(
        weights=np.ones(192), feature_edges=np.zeros((0, 2), int), max_displacement=1e9, weld_distance=0.0
    )
    settings = PRESETS[preset].settings
    assert_same_bits(denoise(mesh, settings, region=plain).vertices, denoise(mesh, settings).vertices)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"vertex_group": 3}, "Vertex Group is 3; it must be a text"),
        ({"keep_sharp": 1}, "Keep Sharp Edges is 1; it must be True or False"),
        ({"limit": "MILES"}, "Limit is 'MILES'; choose one of NONE, EDGES, LENGTH"),
        ({"max_edges": -1.0}, "Farthest is -1; it must be between 0 and 1000"),
        ({"max_length": float("nan")}, "Farthest is nan"),
        ({"weld_distance": "1"}, "Merge Distance is '1'; it must be a number"),
    ],
)
def test_wrong_options_are_refused(values, message):
    with pytest.raises(ValueError, match=message):
        RegionOptions(**values)


def test_options_become_a_region():
    weights, sharp = np.array([0.0, 0.25, 1.0]), np.array([[0, 1]])
    assert RegionOptions().region(2.0, 1.0, None, sharp).feature_edges is None
    options = RegionOptions(
        invert_group=True, keep_sharp=True, limit="EDGES", max_edges=0.5, along_normals=True, keep_volume=True
    )
    region = options.region(2.0, 4.0, weights, sharp)
    assert region.weights.tolist() == [1.0, 0.75, 0.0]
    assert region.feature_edges is sharp
    assert region.max_displacement == 1.0
    assert region.along_normals and region.keep_volume and region.repair_folds
    assert region.weld_distance == 0.0 and region.weldable is None
    border = np.array([True, False, True])
    assert options.region(2.0, border=border).weldable is border
    far = RegionOptions(weld_distance=0.5).region(2.0, border=border)
    assert far.weld_distance == 0.5 and far.weldable is None
    off = RegionOptions(weld=False).region(2.0, border=border)
    assert off.weld_distance is None and off.weldable is None


def test_lengths_in_the_scene_become_those_of_the_mesh():
    options = RegionOptions(limit="LENGTH", max_length=0.5, weld=True, weld_distance=0.2, repair_folds=False)
    region = options.region(9.0, 4.0)
    assert region.max_displacement == 0.125
    assert region.weld_distance == 0.05
    assert not region.repair_folds
    assert options.region(9.0, 0.0).max_displacement == 0.5


def test_every_option_has_words():
    for item in fields(RegionOptions):
        info = item.metadata["info"]
        assert info.label and info.description[0].isupper() and not info.description.endswith(".")
        if item.type == "float":
            assert "larger" in info.description
            assert "edge lengths" in info.description or info.unit == "LENGTH"
