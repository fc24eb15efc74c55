# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator says in words why it cannot be used, and can be used otherwise."""

import bpy
import meshes
import pytest
import translatable
from framelet.operators import registration
from framelet.operators.preview import current_preview
from framelet.operators.run import current_run, run_memory

OBJECT = "Switch to Object Mode"
SELECT = "Select at least one mesh object"
ACTIVE = "The active object must be a mesh"
FIRST = "Denoise a selected mesh first"
BANDS = "Analyze a selected mesh first: none has stored bands"
PREVIEW_OFF = "The live preview is off"
NOT_RUNNING = "Framelet is not running"
NO_MODIFIER = "The selected meshes have no modifier of Framelet"

# What each operator says of an empty scene, of a camera, of a mesh, of a mesh in Sculpt Mode, and of one in
# Edit Mode; None where it can be used.
REASONS = {
    "denoise": (SELECT, SELECT, None, None, None),
    "estimate_noise": (SELECT, SELECT, None, None, None),
    "add_noise": (SELECT, SELECT, None, None, None),
    "select_spikes": (SELECT, SELECT, None, None, None),
    "flatten_spikes": (SELECT, SELECT, None, None, None),
    "select_islands": (SELECT, SELECT, None, None, None),
    "equalize": (SELECT, SELECT, None, None, None),
    "live_equalizer": (SELECT, SELECT, None, OBJECT, OBJECT),
    "apply_modifier": (SELECT, SELECT, NO_MODIFIER, NO_MODIFIER, NO_MODIFIER),
    "remove_modifier": (SELECT, SELECT, NO_MODIFIER, NO_MODIFIER, NO_MODIFIER),
    "sculpt_mask": (SELECT, SELECT, NO_MODIFIER, OBJECT, OBJECT),
    "compare": (ACTIVE, ACTIVE, None, None, None),
    "analyze": (SELECT, SELECT, None, OBJECT, OBJECT),
    "show_band": (SELECT, SELECT, BANDS, OBJECT, OBJECT),
    "synthesize": (SELECT, SELECT, BANDS, OBJECT, OBJECT),
    "clear": (SELECT, SELECT, "The selected meshes have nothing to remove", OBJECT, OBJECT),
    "before_after": (SELECT, SELECT, FIRST, FIRST, FIRST),
    "heat_map": (SELECT, SELECT, FIRST, OBJECT, OBJECT),
    "hide_colors": (SELECT, SELECT, "The selected meshes have no colors of Framelet", OBJECT, OBJECT),
    "pick_face_set": ("Make a mesh object active", "Make a mesh object active", None, None, None),
    "preview": ("Make a mesh object active", "Make a mesh object active", None, OBJECT, OBJECT),
    "apply_preview": (PREVIEW_OFF,) * 5,
    "cancel": (NOT_RUNNING,) * 5,
    "preset_add": (None,) * 5,
}


@pytest.fixture(autouse=True)
def quiet():
    """Leave no preview, run or memory behind."""
    run_memory.forget_runs()
    yield
    current_preview.stop_preview()
    current_run.stop_current()
    run_memory.forget_runs()


def reason(name):
    """Return why an operator cannot be used, in the words of its button; None if it can."""
    operator = getattr(bpy.ops.object, f"framelet_{name}")
    if operator.poll():
        return None
    with pytest.raises(RuntimeError) as caught:
        operator()
    return str(caught.value).strip().partition("poll() ")[2]


def make_scene(kind, make_object):
    if kind == "camera":
        bpy.ops.object.camera_add()
    elif kind != "empty":
        make_object(meshes.triangle_torus(), "Torus")
    if kind in ("SCULPT", "EDIT"):
        bpy.ops.object.mode_set(mode=kind)


def test_every_operator_is_here():
    names = {
        each.bl_idname.removeprefix("object.framelet_")
        for each in registration.classes
        if issubclass(each, bpy.types.Operator)
    }
    assert names == set(REASONS)


@pytest.mark.parametrize("name", REASONS)
@pytest.mark.parametrize("number", range(5), ids=["empty", "camera", "mesh", "sculpt", "edit"])
def test_gray_buttons_say_why(make_object, name, number):
    make_scene(("empty", "camera", "mesh", "SCULPT", "EDIT")[number], make_object)
    expected = REASONS[name][number]
    assert reason(name) == expected
    if expected is not None:
        assert ("*", expected) in translatable.messages()
        assert not expected.endswith(".")


def test_they_can_be_used_once_there_is_something(make_object, rng):
    make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    bpy.ops.object.framelet_analyze()
    assert [reason(name) for name in ("show_band", "synthesize", "clear")] == [None] * 3
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert [reason(name) for name in ("before_after", "heat_map")] == [None] * 2
    bpy.ops.object.framelet_denoise(preset="TRI_2", output="MODIFIER")
    assert reason("sculpt_mask") == "The selected meshes have no mask of Sculpt Mode"
    assert [reason(name) for name in ("apply_modifier", "remove_modifier")] == [None] * 2
    bpy.ops.object.framelet_heat_map()
    assert reason("hide_colors") is None
