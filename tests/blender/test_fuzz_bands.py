# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stored bands, levels and displacements, and what is noted beside them, changed at random: sentences only.

`FRAMELET_FUZZ=1000` tries as many meshes as it says; `make hunt-blender` does so.
"""

import contextlib
import io
import os
import random
import warnings

import bpy
import meshes
import numpy as np
import pytest
from drawing import draw
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.mesh_io.own_names import is_own
from framelet.operators.modifier.inputs import set_input
from framelet.operators.modifier.node_groups import KIND
from framelet.operators.preview import current_preview
from framelet.ui.panels import band_panels

N_MESHES = int(os.environ.get("FRAMELET_FUZZ", "30"))

NOTE = "framelet_bands"
ODD = [0, -1, 2**31 - 1, 1.5, float("nan"), True, "", "AUTO", "ADAPTIVE", "B_SPLINE_3", "x" * 5000, "‘\n"]
ODD += [[], [1], [8, -8], [8, 2**31 - 1], ["a", "b"], [0.5], {"a": 1}, b"\xff\0", [[8], [8]]]
NUMBERS = [float("nan"), float("inf"), -3e38, 3e38, 1e30, 1e-45, 0.0]
TYPES = ["FLOAT", "FLOAT_VECTOR", "FLOAT2", "INT", "BOOLEAN", "FLOAT_COLOR"]
SHAPES = [
    lambda rng: meshes.noisy(meshes.quad_torus(), rng),
    lambda rng: meshes.noisy(meshes.triangle_grid(), rng),
    lambda rng: meshes.noisy(meshes.mixed_sheet(), rng),
]


def alter_note(obj, dice):
    """Put something else into a field, leave one out, or add one."""
    note = obj.data.get(NOTE)
    values = note.to_dict() if hasattr(note, "to_dict") else {}
    key = dice.choice([*values, "more"])
    if dice.random() < 0.2:
        values.pop(key, None)
    else:
        values[key] = dice.choice(ODD)
    with contextlib.suppress(TypeError):  # what a property cannot hold
        obj.data[NOTE] = values


def replace_note(obj, dice):
    with contextlib.suppress(TypeError):
        obj.data[NOTE] = dice.choice(ODD)


def ours(obj):
    return sorted(item.name for item in obj.data.attributes if item.name.startswith("framelet"))


def remove_attribute(obj, dice):
    if ours(obj):
        obj.data.attributes.remove(obj.data.attributes[dice.choice(ours(obj))])


def retype_attribute(obj, dice):
    if ours(obj):
        name = dice.choice(ours(obj))
        obj.data.attributes.remove(obj.data.attributes[name])
        obj.data.attributes.new(name, dice.choice(TYPES), dice.choice(["POINT", "EDGE", "FACE", "CORNER"]))


def swap_attributes(obj, dice):
    if len(ours(obj)) > 1:
        one, other = dice.sample(ours(obj), 2)
        obj.data.attributes[one].name = "between"
        obj.data.attributes[other].name = one
        obj.data.attributes["between"].name = other


def spoil_numbers(obj, dice):
    if ours(obj):
        attribute = obj.data.attributes[dice.choice(ours(obj))]
        if attribute.data_type == "FLOAT_VECTOR" and len(attribute.data):
            attribute.data[dice.randrange(len(attribute.data))].vector = dice.choices(NUMBERS, k=3)


def more_attributes(obj, dice):
    name = dice.choice(["framelet_L9_B1", "framelet_L1_B0", "framelet_L1_B1_edges", "framelet_level_9"])
    if name not in obj.data.attributes:
        obj.data.attributes.new(name, dice.choice(TYPES), "POINT")


def change_mesh(obj, dice):
    """Delete, add, turn over, move far away, or take everything."""
    import bmesh  # which is there after bpy

    work = bmesh.new()
    work.from_mesh(obj.data)
    work.verts.ensure_lookup_table()
    what = dice.randrange(5)
    if what == 0 and len(work.verts):
        bmesh.ops.delete(work, geom=[dice.choice(work.verts)], context="VERTS")
    elif what == 1:
        work.verts.new(dice.choices(NUMBERS, k=3))
    elif what == 2 and len(work.verts):
        dice.choice(work.verts).co = dice.choices(NUMBERS, k=3)
    elif what == 3:
        bmesh.ops.reverse_faces(work, faces=work.faces[:])
    elif dice.random() < 0.3:
        work.clear()
    work.to_mesh(obj.data)
    work.free()


def change_object(obj, dice):
    what = dice.randrange(3)
    if what == 0:
        obj.scale = dice.choices([0.0, -1.0, 1e-20, 1e20], k=3)
    elif what == 1:
        obj.shape_key_add(name="Key")
    else:
        obj.vertex_groups.new(name=dice.choice([*ours(obj), "group"]))


def change_modifier(obj, dice):
    """Set odd gains, take the nodes away, or note that they are of another kind."""
    for modifier in obj.modifiers:
        group = modifier.node_group
        what = dice.randrange(4)
        if group is None:
            continue
        if what == 0 and any(item.name == "Level 1" for item in group.interface.items_tree):
            with contextlib.suppress(KeyError):
                set_input(modifier, "Level 1", dice.choice([-1e30, 1e30, 0.0]))
        elif what == 1:
            bpy.data.node_groups.remove(group)
        elif what == 2:
            group.nodes.clear()
        else:
            with contextlib.suppress(TypeError):
                group[KIND] = dice.choice(
                    [*ODD, "equalizer", "equalizer x", "equalizer 99", "displacement 2"]
                )


DAMAGES = [alter_note, alter_note, replace_note, remove_attribute, retype_attribute, swap_attributes]
DAMAGES += [spoil_numbers, spoil_numbers, more_attributes, change_mesh, change_object, change_modifier]


def actions(dice):
    """Return the operators by name, with arguments, in any order."""
    show = {"content": dice.choice(["BAND", "LEVEL", "LOW"]), "level": dice.randint(1, 3)}
    show |= {"band": dice.choice([1, 2, 9]), "component": dice.choice(["NORMAL", "LENGTH"])}
    found = {
        "synthesize": {},
        "show_band": show,
        "equalize": {"levels": dice.randint(1, 3), "gain_1": dice.choice([0.0, 3.0])},
        "live_equalizer": {"levels": dice.randint(1, 3)},
        "analyze": {"levels": dice.randint(1, 2)},
        "denoise": {"preset": "POSITIONS", "output": dice.choice(["MODIFIER", "IN_PLACE"])},
    }
    names = list(found)
    dice.shuffle(names)
    return [(name, found[name]) for name in names]


def tried(name, **arguments):
    """Call an operator; return whether it did something. A refusal is a sentence and no traceback."""
    try:
        return getattr(bpy.ops.object, f"framelet_{name}")(**arguments) == {"FINISHED"}
    except RuntimeError as error:
        assert "Traceback" not in str(error), str(error)
        return False


@pytest.mark.parametrize("seed", range(N_MESHES))
def test_stored_bands_that_were_altered(make_object, seed):
    dice = random.Random(seed)
    obj = make_object(dice.choice(SHAPES)(np.random.default_rng(seed)), "Torus")
    assert tried("denoise", preset="POSITIONS", output="MODIFIER")
    assert tried("live_equalizer", levels=dice.randint(1, 2))
    assert tried("analyze", levels=2)
    log, errors = [], io.StringIO()
    try:
        with contextlib.redirect_stderr(errors), warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            for _ in range(dice.randint(1, 3)):
                damage = dice.choice(DAMAGES)
                log.append(damage.__name__)
                damage(obj, dice)
            for name, arguments in actions(dice):
                log.append(f"{name} {arguments}")
                before = mesh_bridge.read_positions(obj.data)
                done = tried(name, **arguments)
                after = mesh_bridge.read_positions(obj.data)
                assert done or after.tobytes() == before.tobytes()
                assert np.isfinite(after).all() or not np.isfinite(before).all()
                for panel in band_panels.classes:
                    draw(panel)
            assert "Traceback" not in errors.getvalue(), errors.getvalue()
            tried("clear")
            assert not any(map(is_own, obj.data.attributes)) and NOTE not in obj.data
    except BaseException:
        print("\n".join(log))  # noqa: T201
        raise


@pytest.mark.parametrize(
    ("group", "name", "arguments"),
    [
        ("framelet_rest", "analyze", {}),
        ("framelet_L1_B5", "analyze", {}),
        ("framelet_level_1", "live_equalizer", {}),
        ("framelet_displacement", "denoise", {"preset": "POSITIONS", "output": "MODIFIER"}),
        ("framelet_heat_map", "denoise", {"preset": "POSITIONS", "output": "IN_PLACE"}),
    ],
)
def test_a_vertex_group_with_a_name_of_ours_is_refused(make_object, group, name, arguments):
    """Blender gave the attribute another name, under which it stayed in the mesh for good."""
    obj = make_object(meshes.noisy(meshes.quad_torus(), np.random.default_rng(0)), "Torus")
    obj.vertex_groups.new(name=group)
    names = [item.name for item in obj.data.attributes]
    with pytest.raises(RuntimeError, match=f"The vertex group ‘{group}’ of ‘Torus’ has a name that Framelet"):
        getattr(bpy.ops.object, f"framelet_{name}")(**arguments)
    assert [item.name for item in obj.data.attributes] == names and not obj.modifiers
    obj.vertex_groups[0].name = "group"
    assert tried(name, **arguments)


def test_clear_takes_no_vertex_group(make_object):
    """Blender removed the group of the same name, and left the attribute."""
    obj = make_object(meshes.noisy(meshes.quad_torus(), np.random.default_rng(0)), "Torus")
    assert tried("analyze") and tried("denoise", preset="POSITIONS", output="MODIFIER")
    groups = ["framelet_rest", "framelet_displacement", "framelet_noise"]
    for name in groups:
        obj.vertex_groups.new(name=name)
    assert tried("clear")
    assert obj.vertex_groups.keys() == groups and ours(obj) == []


@pytest.mark.parametrize("kind", ["MULTIRES", "SOFT_BODY"])
def test_a_modifier_that_must_be_the_first_is_named(make_object, kind):
    """Blender lets none before it: the live equalizer ended in a traceback, and left attributes."""
    obj = make_object(meshes.noisy(meshes.quad_torus(), np.random.default_rng(0)), "Torus")
    obj.modifiers.new("Own", kind)
    names = [item.name for item in obj.data.attributes]
    for name, arguments in (
        ("live_equalizer", {}),
        ("denoise", {"preset": "POSITIONS", "output": "MODIFIER"}),
    ):
        with pytest.raises(RuntimeError, match="The modifier ‘Own’ of ‘Torus’ must be the first one"):
            getattr(bpy.ops.object, f"framelet_{name}")(**arguments)
        assert [item.name for item in obj.data.attributes] == names
        assert [each.name for each in obj.modifiers] == ["Own"]
    assert tried("denoise", preset="POSITIONS", output="IN_PLACE")


def test_a_preview_takes_the_place_of_attributes_of_other_kinds(make_object):
    obj = make_object(meshes.noisy(meshes.quad_torus(), np.random.default_rng(0)), "Torus")
    obj.data.attributes.new(".framelet_original", "FLOAT", "EDGE")
    assert tried("preview")
    current_preview.stop_preview()
    assert ".framelet_original" not in obj.data.attributes
