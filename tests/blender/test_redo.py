# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Values that are changed in the panel for adjusting the last operation, F9, go back to the sidebar."""

import bpy
import pytest
from blender_objects import noisy_monkey
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.properties.own_settings import shown_settings


@pytest.fixture
def monkey(settings):
    return noisy_monkey()


@pytest.mark.parametrize("has_own", [False, True])
def test_amount_and_output_go_back_to_the_sidebar(monkey, settings, has_own):
    settings.strength = 1.5
    if has_own:
        monkey.framelet.amount = 0.8
    surface = mesh_bridge.read_surface(monkey)
    bpy.ops.object.framelet_denoise("EXEC_DEFAULT", True, preset="POSITIONS", output="IN_PLACE")
    operator = bpy.context.window_manager.operators[-1]
    mesh_bridge.write_vertices(monkey, surface, surface.vertices)
    operator.properties.amount, operator.properties.output = 0.25, "SHAPE_KEY"
    assert bpy.ops.screen.repeat_history(index=0) == {"FINISHED"}
    shown = shown_settings(bpy.context)
    assert (shown.amount, shown.output) == (0.25, "SHAPE_KEY")
    assert (shown.preset, shown.strength) == ("POSITIONS", 1.5)  # all else is as it was
    assert (settings.amount, settings.output) == (0.25, "SHAPE_KEY")
    assert monkey.data.shape_keys.key_blocks["Denoised"].value == 0.25


def test_a_script_leaves_the_sidebar_alone(monkey, settings):
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output="SHAPE_KEY", amount=0.3)
    assert (settings.amount, settings.output) == (1.0, "IN_PLACE")
