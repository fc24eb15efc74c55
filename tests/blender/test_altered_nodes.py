# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""People edit the nodes of Framelet's modifiers: inputs get other names or go, numbers are none."""

import bpy
import meshes
import numpy as np
import pytest
from drawing import draw
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.modifier.inputs import get_input, set_input
from framelet.operators.modifier.node_groups import KIND
from framelet.operators.modifier.recipes import DISPLACEMENT, EQUALIZER
from framelet.operators.modifier.stack import find_modifier
from framelet.ui.panels import band_panels, output_panel, panel, see_panel

PANELS = (
    panel.VIEW3D_PT_framelet,
    see_panel.VIEW3D_PT_framelet_see,
    *output_panel.classes,
    *band_panels.classes,
)
INPUTS = ("Amount", "Mask", "Invert", "On")


@pytest.fixture
def torus(make_object, rng):
    """An object with the modifier."""
    obj = make_object(meshes.noisy(meshes.quad_torus(), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER")
    return obj


def socket(obj, name):
    items = obj.modifiers[0].node_group.interface.items_tree
    return next(item for item in items if item.name == name and item.in_out == "INPUT")


def draw_all():
    for each in PANELS:
        draw(each)


@pytest.mark.parametrize("name", INPUTS)
def test_an_input_with_another_name_still_works(torus, name):
    """Operators and panels ended in StopIteration."""
    before = read_positions(torus.data)
    socket(torus, name).name = "Stärke"
    draw_all()
    assert bpy.ops.object.framelet_denoise(preset="TRI_1", output="MODIFIER") == {"FINISHED"}
    assert len(torus.modifiers) == 1
    set_input(torus.modifiers[0], "Amount", 0.5)
    assert get_input(torus.modifiers[0], "Amount") == 0.5
    assert bpy.ops.object.framelet_apply_modifier() == {"FINISHED"}
    assert not torus.modifiers and not np.array_equal(read_positions(torus.data), before)


@pytest.mark.parametrize("name", INPUTS)
@pytest.mark.parametrize("change", ["removed", "retyped"])
def test_a_modifier_without_an_input_is_nobodys(torus, name, change):
    item = socket(torus, name)
    if change == "removed":
        torus.modifiers[0].node_group.interface.remove(item)
    else:
        item.socket_type = "NodeSocketVector"
    assert find_modifier(torus, DISPLACEMENT) is None
    draw_all()
    before = read_positions(torus.data)
    with pytest.raises(
        RuntimeError, match=r"^Error: The nodes of the modifier ‘Framelet Denoise’ of ‘Torus’ lost"
    ):
        bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER")
    assert not bpy.ops.object.framelet_apply_modifier.poll()
    assert len(torus.modifiers) == 1 and read_positions(torus.data).tobytes() == before.tobytes()
    torus.modifiers.clear()
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER") == {"FINISHED"}
    assert find_modifier(torus, DISPLACEMENT).node_group.interface.items_tree["Amount"]


@pytest.mark.parametrize(
    "kind", ["equalizer x", "equalizer x 1", "equalizer 0 1", "equalizer 99 1", "displacement 2"]
)
def test_a_kind_that_there_is_not(torus, kind):
    """The panel of the equalizer drew nothing but an error."""
    torus.modifiers[0].node_group[KIND] = kind
    draw_all()
    assert find_modifier(torus, EQUALIZER) is None


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
@pytest.mark.parametrize("name", ["Amount", "Level 1"])
def test_values_that_are_no_numbers_are_not_applied(torus, name, value):
    """The mesh was all NaN afterwards."""
    if name == "Level 1":
        bpy.ops.object.framelet_remove_modifier()
        bpy.ops.object.framelet_live_equalizer(levels=1)
    kind = DISPLACEMENT if name == "Amount" else EQUALIZER
    set_input(find_modifier(torus, kind), name, value)
    if np.isfinite(get_input(find_modifier(torus, kind), name)):
        pytest.skip("this Blender limits the value")
    before = read_positions(torus.data)
    with pytest.raises(
        RuntimeError, match=r"^Error: The modifier ‘Framelet .*’ of ‘Torus’ moves vertices by what"
    ):
        bpy.ops.object.framelet_apply_modifier(kind=kind)
    assert read_positions(torus.data).tobytes() == before.tobytes() and len(torus.modifiers) == 1


@pytest.mark.parametrize(("value", "sentence"), [(float("nan"), "is not a finite number"), (3e38, "")])
def test_displacements_that_are_no_numbers_are_not_applied(torus, value, sentence):
    torus.data.attributes["framelet_displacement"].data[0].vector = (value, 0, 0)
    torus.data.vertices[0].co.x = 3e38 if value > 0 else 0.0
    before = read_positions(torus.data)
    with pytest.raises(RuntimeError, match=sentence or "move vertices beyond the largest number"):
        bpy.ops.object.framelet_apply_modifier()
    assert read_positions(torus.data).tobytes() == before.tobytes() and len(torus.modifiers) == 1


@pytest.mark.parametrize("value", [5, "one", {"a": 1}, ""])
def test_marks_of_the_cage_that_somebody_altered(torus, value):
    torus.data["framelet_cage"] = value
    draw_all()
    labels = draw(output_panel.VIEW3D_PT_framelet_output)["label"]
    assert "Other vertices or faces since; run it again" in labels
