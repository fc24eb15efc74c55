# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The live equalizer shows what Equalize gives, changes at once, and leaves nothing behind."""

import bpy
import meshes
import numpy as np
import pytest
from blender_objects import noisy_monkey, read, select_only
from checks import edge_length, lengths
from drawing import draw
from framelet.core import equalize
from framelet.core.equalizer import Equalizer
from framelet.operators.bands import transforms
from framelet.operators.bands.transforms import forget_transforms
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.modifier.inputs import get_input, input_property, set_input
from framelet.operators.modifier.offsets import offset_of
from framelet.operators.modifier.recipes import DISPLACEMENT, EQUALIZER, OURS
from framelet.operators.modifier.stack import find_modifier
from framelet.ui.panels import band_panels

GAINS = (0.2, 1.7, 0.0)


@pytest.fixture(autouse=True)
def no_transforms():
    forget_transforms()
    yield
    forget_transforms()


@pytest.fixture
def torus(make_object, rng):
    return make_object(meshes.noisy(meshes.triangle_torus(16, 24), rng), "Torus")


def shown(obj):
    graph = bpy.context.evaluated_depsgraph_get()
    return mesh_bridge.read_positions(obj.evaluated_get(graph).data)


def live(obj, **options):
    select_only(obj)
    assert bpy.ops.object.framelet_live_equalizer(**({"levels": 3} | options)) == {"FINISHED"}
    return find_modifier(obj, EQUALIZER)


def turn(modifier, gains=GAINS):
    for level, gain in enumerate(gains, 1):
        set_input(modifier, f"Level {level}", gain)


MESHES = {
    "torus": lambda: meshes.triangle_torus(16, 24),
    "grid with a border": lambda: meshes.triangle_grid(12, 16),
    "quads": lambda: meshes.quad_torus(16, 24),
    "mixed": lambda: meshes.mixed_sheet(),
}


@pytest.mark.parametrize("boundary", ["ALONG", "FIXED", "FREE"])
@pytest.mark.parametrize("name", MESHES)
def test_it_shows_what_equalize_gives(make_object, rng, name, boundary):
    obj = make_object(meshes.noisy(MESHES[name](), rng))
    surface = mesh_bridge.read_surface(obj)
    gains = GAINS[:2]
    modifier = live(obj, levels=2, boundary=boundary)
    assert np.array_equal(shown(obj), surface.vertices), "all gains are 1"
    turn(modifier, gains)
    expected = equalize(surface, gains, boundary=boundary)
    assert lengths(shown(obj) - expected).max() < 1e-4 * edge_length(surface)
    assert lengths(expected - surface.vertices).max() > 0.01
    assert read(obj).tobytes() == surface.vertices.tobytes()


def test_gains_do_not_compound_and_can_be_keyed(torus):
    modifier = live(torus)
    before = read(torus)
    turn(modifier)
    first = shown(torus)
    turn(modifier, (1.0, 1.0, 1.0))
    assert np.array_equal(shown(torus), before)
    turn(modifier)
    assert np.array_equal(shown(torus), first)
    owner, key = input_property(modifier, "Level 1")
    assert owner.keyframe_insert(key)


def test_gains_and_group_of_the_sidebar_are_the_first_values(torus):
    group = torus.vertex_groups.new(name="Half")
    group.add(list(range(len(torus.data.vertices) // 2)), 1.0, "REPLACE")
    before = read(torus)
    modifier = live(torus, gain_1=0.0, vertex_group="Half")
    assert (get_input(modifier, "Level 1"), get_input(modifier, "Mask")) == (0.0, "Half")
    moved = (shown(torus) != before).any(axis=1)
    half = len(before) // 2
    assert moved[:half].all() and not moved[half:].any()


def test_again_with_other_levels(torus):
    modifier = live(torus, levels=3)
    turn(modifier)
    modifier = live(torus, levels=2)
    assert len(torus.modifiers) == 1 and "framelet_level_3" not in torus.data.attributes
    modifier = live(torus, levels=3, gain_3=0.5)
    assert len(torus.modifiers) == 1 and len(bpy.data.node_groups) == 1
    surface = mesh_bridge.read_surface(torus)
    turn(modifier)
    assert lengths(shown(torus) - equalize(surface, GAINS)).max() < 1e-4 * edge_length(surface)


@pytest.mark.parametrize("ending", ["apply", "remove", "clear"])
def test_the_ways_to_end_it(torus, ending):
    before = read(torus)
    turn(live(torus))
    expected = shown(torus) if ending == "apply" else before
    if ending == "clear":
        bpy.ops.object.framelet_clear()
    else:
        getattr(bpy.ops.object, f"framelet_{ending}_modifier")(kind=EQUALIZER)
    assert np.array_equal(read(torus), expected)
    assert not torus.modifiers and not bpy.data.node_groups and not torus.data.keys()
    assert not [item.name for item in torus.data.attributes if OURS.fullmatch(item.name)]


def test_both_modifiers_at_once():
    """The levels are those of the surface that is shown."""
    obj = noisy_monkey()
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER")
    surface = mesh_bridge.read_surface(obj)
    clean = surface.with_vertices(surface.vertices + offset_of(obj, DISPLACEMENT))
    modifier = live(obj, levels=2)
    turn(modifier, (0.0, 2.0))
    expected = equalize(clean, (0.0, 2.0))
    assert lengths(shown(obj) - expected).max() < 1e-4 * edge_length(surface)
    assert len(bpy.data.node_groups) == 2
    bpy.ops.object.framelet_remove_modifier(kind=DISPLACEMENT)
    assert len(bpy.data.node_groups) == 1 and find_modifier(obj, EQUALIZER)
    bpy.ops.object.framelet_remove_modifier(kind=EQUALIZER)
    assert not obj.modifiers and not obj.data.keys()


def test_the_panel_has_the_gains_of_the_modifier(torus):
    record = draw(band_panels.VIEW3D_PT_framelet_equalizer)
    assert record["operator"] == ["object.framelet_equalize", "object.framelet_live_equalizer"]
    assert "gain_1" in record["prop"]
    modifier = live(torus)
    record = draw(band_panels.VIEW3D_PT_framelet_equalizer)
    keys = [input_property(modifier, f"Level {level}")[1] for level in (1, 2, 3)]
    assert record["prop"][:3] == keys and "gain_1" not in record["prop"]
    assert record["operator"] == ["object.framelet_apply_modifier", "object.framelet_remove_modifier"]
    assert record["object.framelet_apply_modifier"].kind == EQUALIZER


def test_it_needs_object_mode_and_a_mesh_that_is_large_enough(torus, make_object):
    make_object(meshes.triangle_grid(2, 2), "Small")
    with pytest.raises(RuntimeError, match=r"‘Small’: .*too small for 3 levels"):
        bpy.ops.object.framelet_live_equalizer(levels=3)
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Switch to Object Mode"):
        bpy.ops.object.framelet_live_equalizer()


# Kept transforms -------------------------------------------------------------------------------------------


@pytest.fixture
def counted(monkeypatch):
    """Count how often a transform is made."""
    from framelet.core import equalizer
    from framelet.core.transform import make

    made, original = [], make.make_transform

    def make_transform(*arguments, **options):
        made.append(1)
        return original(*arguments, **options)

    monkeypatch.setattr(equalizer, "make_transform", make_transform)
    monkeypatch.setattr("framelet.core.transform.make_transform", make_transform)
    return made


def test_equalize_makes_its_transform_once(torus, counted):
    noisy = mesh_bridge.read_surface(torus)
    for gain in (0.1, 0.5, 2.0):
        mesh_bridge.write_vertices(torus, mesh_bridge.read_surface(torus), noisy.vertices)
        bpy.ops.object.framelet_equalize(levels=2, gain_1=gain)
        assert read(torus).tobytes() == equalize(noisy, (gain, 1.0)).tobytes()
    # Those of the expected results above are counted too.
    assert len(counted) == 1 + 3


def test_an_edit_makes_it_anew(torus):
    noisy = mesh_bridge.read_surface(torus)
    bpy.ops.object.framelet_equalize(levels=2, gain_1=0.5)
    moved = noisy.vertices.copy()
    moved[3] += 0.5
    mesh_bridge.show_positions(torus.data, moved)
    bpy.ops.object.framelet_equalize(levels=2, gain_1=0.5)
    assert read(torus).tobytes() == equalize(noisy.with_vertices(moved), (0.5, 1.0)).tobytes()


def test_analyze_makes_its_transform_once(torus, counted):
    bpy.ops.object.framelet_analyze(levels=2)
    first = {item.name: item for item in torus.data.attributes if item.name.startswith("framelet_L")}
    assert first and len(counted) == 1
    bpy.ops.object.framelet_analyze(levels=2)
    bpy.ops.object.framelet_synthesize()
    assert len(counted) == 1
    bpy.ops.object.framelet_analyze(levels=1)
    assert len(counted) == 2


def test_what_is_kept_is_bounded_and_forgotten(torus, monkeypatch):
    bpy.ops.object.framelet_analyze(levels=2)
    assert len(transforms._kept) == 1
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert not transforms._kept
    monkeypatch.setattr(transforms, "MOST_BYTES", 1000)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    bpy.ops.object.framelet_analyze(levels=2)
    assert not transforms._kept


def test_the_wrong_number_of_gains_is_refused(rng):
    equalizer = Equalizer(meshes.noisy(meshes.triangle_torus(), rng), 2)
    with pytest.raises(ValueError, match="There are 1 gains for 2 levels; give one for each"):
        equalizer.equalized([0.5])
