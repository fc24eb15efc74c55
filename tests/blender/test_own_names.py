# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An attribute that has a name of Framelet's and is of another kind is somebody else's: it is not lost."""

import bpy
import meshes
import numpy as np
import pytest
from framelet.operators.mesh_io.own_names import is_own

NUMBERS = np.arange(1.0, 1000.0, dtype=np.float32)


@pytest.fixture
def torus(make_object, rng):
    return make_object(meshes.noisy(meshes.quad_torus(), rng), "Torus")


def add(obj, name, domain="CORNER"):
    """Add an attribute as a script may do, and return a function that tells whether it still is there."""
    attribute = obj.data.attributes.new(name, "FLOAT", domain)
    values = NUMBERS[: len(attribute.data)]
    attribute.data.foreach_set("value", values)

    def is_there():
        now = obj.data.attributes.get(name)
        if now is None or (now.data_type, now.domain) != ("FLOAT", domain):
            return False
        found = np.empty(len(now.data), np.float32)
        now.data.foreach_get("value", found)
        return np.array_equal(found, values)

    return is_there


@pytest.mark.parametrize(
    ("name", "operator", "arguments"),
    [
        ("framelet_displacement", "denoise", {"preset": "POSITIONS", "output": "MODIFIER"}),
        ("framelet_rest", "analyze", {}),
        ("framelet_L1_B2", "analyze", {}),
        ("framelet_level_1", "live_equalizer", {}),
        ("framelet_band", "show_band", {}),
        ("framelet_heat_map", "heat_map", {}),
        ("framelet_noise", "heat_map", {"quantity": "NOISE"}),
        ("framelet_mask", "sculpt_mask", {}),
    ],
)
def test_what_would_take_its_place_is_refused(torus, name, operator, arguments):
    """It was removed without a word; colors were added under another name, with a traceback."""
    torus.data.attributes.new(".sculpt_mask", "FLOAT", "POINT")
    bpy.ops.object.framelet_denoise(
        preset="POSITIONS", output="MODIFIER" if operator == "sculpt_mask" else "IN_PLACE"
    )
    if operator == "show_band":
        bpy.ops.object.framelet_analyze()
    is_there = add(torus, name)
    names = [item.name for item in torus.data.attributes]
    with pytest.raises(
        RuntimeError, match=f"^Error: The attribute {name} of ‘Torus’ is FLOAT on CORNER instead"
    ):
        getattr(bpy.ops.object, f"framelet_{operator}")(**arguments)
    assert is_there() and [item.name for item in torus.data.attributes] == names
    torus.data.attributes[name].name = "mine"
    assert getattr(bpy.ops.object, f"framelet_{operator}")(**arguments) == {"FINISHED"}


def test_in_edit_mode_too(torus):
    """There the displacement went into an attribute with another name, which no node read."""
    is_there = add(torus, "framelet_displacement", "POINT")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    with pytest.raises(RuntimeError, match="is FLOAT on POINT instead of FLOAT_VECTOR on POINT"):
        bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert is_there() and not torus.modifiers
    assert not any(item.name.startswith("framelet_displacement.") for item in torus.data.attributes)


def test_clear_and_hide_colors_leave_it(torus):
    bpy.ops.object.framelet_analyze()
    bpy.ops.object.framelet_show_band()
    stay = [add(torus, name, "FACE") for name in ("framelet_heat_map", "framelet_level_1", "framelet_noise")]
    assert bpy.ops.object.framelet_hide_colors() == {"FINISHED"}
    assert bpy.ops.object.framelet_clear() == {"FINISHED"}
    assert all(is_there() for is_there in stay)
    assert not any(map(is_own, torus.data.attributes))
    assert not bpy.ops.object.framelet_clear.poll(), "there is nothing of Framelet's"


def test_colors_that_somebody_converted_stay(torus):
    """Blender's Convert Attribute gives colors another type, and leaves their name."""
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    bpy.ops.object.framelet_heat_map()
    torus.data.attributes.active = torus.data.attributes["framelet_heat_map"]
    bpy.ops.geometry.attribute_convert(mode="GENERIC", domain="CORNER", data_type="BYTE_COLOR")
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS", from_original=False) == {"FINISHED"}
    assert torus.data.attributes["framelet_heat_map"].data_type == "BYTE_COLOR"
    with pytest.raises(
        RuntimeError, match="is BYTE_COLOR on CORNER instead of FLOAT_COLOR on POINT or CORNER"
    ):
        bpy.ops.object.framelet_heat_map()


@pytest.mark.parametrize("name", ["framelet_band", "framelet_heat_map"])
def test_a_vertex_group_with_the_name_of_colors(torus, name):
    """The heat map ended in a traceback, and left colors that nothing removed."""
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    torus.vertex_groups.new(name=name)
    names = [item.name for item in torus.data.attributes]
    with pytest.raises(RuntimeError, match=f"^Error: The vertex group ‘{name}’ of ‘Torus’ has a name that"):
        bpy.ops.object.framelet_heat_map()
    assert [item.name for item in torus.data.attributes] == names


def test_a_vertex_group_with_the_name_of_the_copied_mask(torus):
    """The modifier took the group for the mask of Sculpt Mode."""
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER")
    torus.data.attributes.new(".sculpt_mask", "FLOAT", "POINT")
    torus.vertex_groups.new(name="framelet_mask")
    with pytest.raises(RuntimeError, match=r"^Error: The vertex group framelet_mask of ‘Torus’ is in"):
        bpy.ops.object.framelet_sculpt_mask()
    assert "framelet_mask" not in torus.data.attributes


BUILT_IN = [
    ("crease_edge", "FLOAT_VECTOR", "EDGE"),
    ("sharp_edge", "INT", "EDGE"),
    (".hide_vert", "FLOAT", "FACE"),
    (".hide_poly", "INT", "POINT"),
    (".sculpt_mask", "FLOAT", "FACE"),
    (".sculpt_mask", "FLOAT_VECTOR", "POINT"),
    (".sculpt_mask", "STRING", "POINT"),
    (".sculpt_face_set", "INT", "POINT"),
    (".sculpt_face_set", "FLOAT", "FACE"),
]


@pytest.mark.parametrize(("name", "data_type", "domain"), BUILT_IN)
def test_names_of_blender_with_other_kinds_are_not_read(torus, name, data_type, domain):
    """Each was a traceback."""
    torus.data.attributes.new(name, data_type, domain)
    known = torus.data.attributes.get(name)
    if known is None or (known.data_type, known.domain) != (data_type, domain):
        pytest.skip("this Blender makes no such attribute")
    done = bpy.ops.object.framelet_denoise(preset="POSITIONS", keep_sharp=True, face_set=1, output="MODIFIER")
    assert done == {"FINISHED"}
    if name == ".sculpt_mask":
        assert not bpy.ops.object.framelet_sculpt_mask.poll()
    assert torus.data.attributes[name].data_type == data_type


@pytest.mark.parametrize("value", [3, [1, 2], ["one"], "one", {"a": 1}])
def test_the_note_on_earlier_colors_may_be_altered(torus, value):
    """Colors could not be taken away any more."""
    torus.data.color_attributes.new("Own", "FLOAT_COLOR", "POINT")
    bpy.ops.object.framelet_analyze()
    bpy.ops.object.framelet_show_band()
    torus.data["framelet_colors_before"] = value
    assert bpy.ops.object.framelet_hide_colors() == {"FINISHED"}
    assert torus.data.color_attributes.keys() == ["Own"] and "framelet_colors_before" not in torus.data
    assert torus.data.attributes.active_color_name == "Own"
