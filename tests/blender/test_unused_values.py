# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A script hears of every argument that has no effect, and of no other."""

import bpy
import pytest
from framelet.core.settings import PRESETS, DenoiseSettings
from framelet.operators.properties.region_values import REGION_NAMES
from framelet.operators.properties.unused_values import REGION_NEEDS
from meshes import triangle_torus


@pytest.fixture
def warnings(make_object, capfd):
    """Give a function that denoises a torus, and returns the warnings that Blender printed."""

    def call(**arguments):
        make_object(triangle_torus())
        capfd.readouterr()
        assert bpy.ops.object.framelet_denoise(**arguments) == {"FINISHED"}
        return [
            line.removeprefix("Warning: ")
            for line in capfd.readouterr().out.splitlines()
            if line.startswith("Warning: ")
        ]

    return call


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            {"lambda_": 0.4},
            'The engine Automatic does not use lambda_; give preset="POSITIONS" for one that does.',
        ),
        (
            {"lambda_": 0.4, "mu": 2.0, "sigma_c": 0.5},
            "The engine Automatic does not use lambda_, mu, sigma_c; "
            'give preset="POSITIONS" for one that does.',
        ),
        (
            {"preset": "TRI_2", "strength": 0.5, "passes": 1},
            'The engine Positions (paper) does not use passes; give preset="AUTO" for one that does.',
        ),
        (
            {"method": "BILATERAL", "lambda_": 0.7},
            'The engine Bilateral does not use lambda_; give method="POSITIONS" for one that does.',
        ),
        (
            {"preset": "TRI_2", "noise": "WIDE", "passes": 4},
            'The engine Positions (paper) does not use noise, passes; give preset="AUTO" for one that does.',
        ),
        (
            {"preset": "TRI_2", "tuning": "NOISE", "lambda_": 0.4},
            'lambda_ has no effect with tuning="NOISE".',
        ),
        (
            {"method": "POSITIONS", "stencil": "ADAPTIVE", "frame": "B_SPLINE_2"},
            'frame has no effect with stencil="ADAPTIVE".',
        ),
        ({"preset": "TRI_2", "max_edges": 0.5}, 'max_edges has no effect without limit="EDGES".'),
        (
            {"preset": "TRI_2", "max_length": 0.5, "limit": "EDGES"},
            'max_length has no effect without limit="LENGTH".',
        ),
        (
            {"preset": "TRI_2", "weld_distance": 0.5, "weld": False},
            "weld_distance has no effect without weld=True.",
        ),
        ({"preset": "TRI_2", "invert_group": True}, "invert_group has no effect without vertex_group."),
    ],
)
def test_what_has_no_effect_is_said(warnings, arguments, sentence):
    assert warnings(**arguments) == [sentence]


@pytest.mark.parametrize(
    "arguments",
    [
        {},
        {"strength": 0.5, "boundary": "FIXED", "threads": 1},
        {"noise": "FINE", "passes": 1},
        {"preset": "TRI_1", "strength": 0.5},
        {"preset": "TRI_2", "lambda_": 0.4, "mu": 2.0, "iterations": 3},
        {"preset": "BILATERAL", "iterations": 2, "sigma_c": 0.5},
        {"preset": "POSITIONS", "limit": "EDGES", "max_edges": 0.5},
        {"preset": "TRI_2", "method": "BILATERAL"},
        {"preset": "CUSTOM", "method": "POSITIONS", "lambda_": 0.4},
    ],
)
def test_what_has_an_effect_is_not(warnings, arguments):
    assert warnings(**arguments) == []


@pytest.mark.parametrize("preset", ["AUTO", "TRI_1", "PRISMATIC", "BILATERAL"])
def test_a_call_that_names_all_values_of_a_preset_is_no_mistake(warnings, preset):
    """As Blender's own record of a run does, which people copy."""
    settings = PRESETS[preset].settings
    values = {name: getattr(settings, name) for name in DenoiseSettings.__dataclass_fields__}
    assert warnings(preset=preset, **values) == []


def test_nothing_but_a_warning_comes_of_it(make_object):
    first = make_object(triangle_torus(), "First")
    bpy.ops.object.framelet_denoise()
    second = make_object(triangle_torus(), "Second")
    bpy.ops.object.framelet_denoise(lambda_=0.4)
    assert [tuple(v.co) for v in first.data.vertices] == [tuple(v.co) for v in second.data.vertices]


def test_every_option_that_needs_another_has_its_words():
    from types import SimpleNamespace

    from framelet.operators.properties.region_values import shown_region_names

    plain = SimpleNamespace(vertex_group="", limit="NONE", weld=False, boundary="FIXED")
    assert set(REGION_NEEDS) == set(REGION_NAMES) - set(shown_region_names(plain))
