# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that are none, places without a volume, choices that are gone, contexts without a window.

Each was a traceback, or took something away, when people tried.
"""

import contextlib

import bpy
import meshes
import numpy as np
import pytest
from blender_objects import select_only
from drawing import draw
from framelet.operators import heat_map
from framelet.operators.context_objects import active_object, edited_objects, selected_objects
from framelet.operators.mesh_io import kept_original
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.preview import current_preview
from framelet.operators.preview.targets import target_objects
from framelet.ui.panels import band_panels, panel, see_panel

NAN = float("nan")


@pytest.fixture
def torus(make_object, rng):
    return make_object(meshes.noisy(meshes.quad_torus(), rng), "Torus")


@pytest.fixture
def previewed(torus, settings, no_thread_stays):
    """An object that shows a preview, and its positions before."""
    before = read_positions(torus.data)
    session = current_preview.start_preview(torus, bpy.context.scene)
    assert session.wait(60) and current_preview.tick_preview()
    assert not np.array_equal(read_positions(torus.data), before)
    return torus, before


def refused(operator, **arguments):
    """Return the sentence with which an operator refuses."""
    with pytest.raises(RuntimeError) as info:
        operator(**arguments)
    assert "Traceback" not in str(info.value)
    return str(info.value)


# Numbers


@pytest.mark.parametrize("name", ["strength", "lambda_", "mu", "tolerance", "amount"])
def test_settings_that_are_no_numbers(torus, name):
    """A setting was a traceback; with the amount the mesh was all NaN."""
    before = read_positions(torus.data)
    preset = {"strength": "AUTO"}.get(name, "POSITIONS")
    for output in ("IN_PLACE", "MODIFIER", "SHAPE_KEY", "NEW_OBJECT"):
        words = refused(bpy.ops.object.framelet_denoise, preset=preset, output=output, **{name: NAN})
        assert "is nan; it must be between" in words
    assert read_positions(torus.data).tobytes() == before.tobytes()
    assert not torus.modifiers and torus.data.shape_keys is None and len(bpy.data.objects) == 1


def test_a_preview_ends_with_a_setting_that_is_no_number(previewed):
    torus, before = previewed
    bpy.context.scene.framelet.lambda_ = NAN
    assert not current_preview.tick_preview()
    assert read_positions(torus.data).tobytes() == before.tobytes()
    assert "is nan" in current_preview.preview_message()


def test_a_heat_map_with_a_range_that_is_no_number(torus):
    """The run was written, ended in a traceback, and was no step of undo."""
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    bpy.ops.object.framelet_heat_map()
    heat = bpy.context.scene.framelet_heat_map
    heat.range_rule, heat.limit = "FIXED", NAN
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS") == {"FINISHED"}
    assert not bpy.context.window_manager.framelet_band_range.objects


def test_a_heat_map_of_a_mesh_that_is_neither_before_nor_after(torus):
    """Multires keeps the result elsewhere, so that an edit of the mesh made the next run a traceback."""
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    bpy.ops.object.framelet_heat_map()
    torus.modifiers.new("Multires", "MULTIRES")
    bpy.ops.object.multires_subdivide(modifier="Multires")
    torus.data.vertices[0].co.z += 1.0
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS") == {"FINISHED"}
    heat_map.refresh_heat(bpy.context, [torus])


# Places


def test_an_object_with_a_scale_that_is_no_number(torus):
    torus.scale.x = NAN
    bpy.context.view_layer.update()
    words = refused(bpy.ops.object.framelet_denoise, preset="POSITIONS")
    assert "The rotation or scale of ‘Torus’ is not finite" in words


@pytest.mark.parametrize("place", [{"scale": (1, 1, 0)}, {"location": (NAN, 0, 0)}])
def test_together_with_an_object_at_no_place(torus, make_object, rng, place):
    """It was "Singular matrix"."""
    other = make_object(meshes.noisy(meshes.quad_torus(), rng), "Flat")
    for name, value in place.items():
        setattr(other, name, value)
    select_only(other, torus)
    bpy.context.view_layer.update()
    before = [read_positions(obj.data) for obj in (torus, other)]
    words = refused(bpy.ops.object.framelet_denoise, preset="POSITIONS", together=True)
    assert "‘Flat’ is flat by its scale, or at no place" in words
    after = [read_positions(obj.data) for obj in (torus, other)]
    assert np.array_equal(before, after)


def test_an_array_that_shrinks_to_a_point():
    """It was "Singular matrix"."""
    bpy.ops.mesh.primitive_grid_add()
    grid = bpy.context.object
    target = bpy.data.objects.new("Target", None)
    bpy.context.collection.objects.link(target)
    target.scale = (0, 0, 0)
    bpy.context.view_layer.update()
    array = grid.modifiers.new("Array", "ARRAY")
    array.use_relative_offset, array.use_object_offset = False, True
    array.offset_object, array.use_merge_vertices, array.merge_threshold = target, True, 10.0
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS") == {"FINISHED"}


def test_an_array_of_very_many_copies(torus):
    """The box of each copy was kept: this never ended."""
    for count in (2**31 - 1, 2):
        array = torus.modifiers.new("Array", "ARRAY")
        array.use_merge_vertices, array.count = True, count
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS") == {"FINISHED"}


# Choices and settings


@pytest.mark.parametrize("name", ["preset", "method", "frame", "output", "boundary"])
def test_choices_that_a_file_does_not_know(torus, tmp_path, name):
    """As of a later version; a preset or a frame like that let no panel be drawn."""
    for owner in (bpy.context.scene.framelet, torus.framelet):
        is_apart = hasattr(owner, "bl_system_properties_get")
        store = owner.bl_system_properties_get(do_create=True) if is_apart else owner
        store[name] = 99
        store["is_own"] = True
    panels = (panel.VIEW3D_PT_framelet, *band_panels.classes)
    for each in panels:
        draw(each)
    path = str(tmp_path / "later.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    for owner in (bpy.context.scene.framelet, bpy.data.objects["Torus"].framelet):
        assert getattr(owner, name)
    for each in panels:
        draw(each)


def test_a_heat_map_that_a_file_does_not_know(torus, tmp_path):
    heat = bpy.context.scene.framelet_heat_map
    is_apart = hasattr(heat, "bl_system_properties_get")
    store = heat.bl_system_properties_get(do_create=True) if is_apart else heat
    store["quantity"] = 99
    draw(see_panel.VIEW3D_PT_framelet_see)
    path = str(tmp_path / "later.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.context.scene.framelet_heat_map.quantity


def test_settings_of_another_scene_are_its_own(torus):
    """A script that set up a second scene changed the settings of the one that is shown."""
    scene = bpy.context.scene
    scene.framelet.preset = "TRI_1"
    second = bpy.data.scenes.new("Second")
    second.framelet.preset = "BILATERAL"
    assert [each.framelet.preset for each in (scene, torus, second)] == ["TRI_1", "TRI_1", "BILATERAL"]


# What stays


def test_a_locked_key_of_a_run_before_is_not_replaced(torus):
    base = torus.shape_key_add(name="Basis")
    key = torus.shape_key_add(name="Denoised")
    key.points[3].co.z += 2.0
    key.lock_shape = True
    points = [point.co[:] for point in key.points]
    torus.active_shape_key_index = 0
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS", output="SHAPE_KEY") == {"FINISHED"}
    blocks = torus.data.shape_keys.key_blocks
    assert [point.co[:] for point in blocks["Denoised"].points] == points
    assert blocks["Denoised.001"].relative_key == base


@pytest.mark.parametrize("operator", ["select_spikes", "select_islands"])
def test_a_selection_that_is_refused_leaves_the_mode(torus, operator):
    torus.shape_key_add(name="Basis")
    torus.shape_key_add(name="Key").lock_shape = True
    torus.active_shape_key_index = 1
    assert "is locked" in refused(getattr(bpy.ops.object, f"framelet_{operator}"))
    assert torus.mode == "OBJECT"


def test_a_selection_with_a_length_that_is_no_number_leaves_the_mode(torus):
    assert "is nan" in refused(bpy.ops.object.framelet_select_spikes, length=NAN)
    assert torus.mode == "OBJECT"


@pytest.mark.parametrize("output", ["IN_PLACE", "NEW_OBJECT"])
def test_a_level_that_blender_does_not_take_leaves_no_copy(torus, monkeypatch, output):
    """As of a library override, whose modifiers Blender does not edit."""
    from framelet.operators.run import output as output_module

    def refuse(obj, _vertices):
        raise ValueError(f"‘{obj.name}’: its Multires modifier took no new shape.")

    torus.modifiers.new("Multires", "MULTIRES")
    bpy.ops.object.multires_subdivide(modifier="Multires")
    monkeypatch.setattr(output_module, "reshape", refuse)
    words = refused(bpy.ops.object.framelet_denoise, preset="POSITIONS", output=output)
    assert "took no new shape" in words
    assert len(bpy.data.objects) == len(bpy.data.meshes) == 1


# Previews


def change_kept(mesh, data_type, domain):
    for name in kept_original.NAMES:
        mesh.attributes.remove(mesh.attributes[name])
        if domain:
            mesh.attributes.new(name, data_type, domain)


@pytest.mark.parametrize(
    ("data_type", "domain"), [("FLOAT_VECTOR", "FACE"), ("STRING", "POINT"), ("FLOAT", "EDGE"), ("", "")]
)
@pytest.mark.parametrize("end", ["end", "save", "touch"])
def test_a_preview_whose_attributes_were_changed(previewed, tmp_path, capfd, data_type, domain, end):
    """As nodes do that turn vertices into faces. Saving wrote the preview, and ended in a traceback."""
    torus, before = previewed
    change_kept(torus.data, data_type, domain)
    if end == "save":
        path = str(tmp_path / "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
        with bpy.data.libraries.load(path) as (source, target):
            target.meshes = source.meshes
        assert read_positions(target.meshes[0]).tobytes() == before.tobytes()
        bpy.data.meshes.remove(target.meshes[0])
    elif end == "touch":
        torus.data.update()
        bpy.context.view_layer.update()
        current_preview.tick_preview()
    current_preview.end_preview()
    assert read_positions(torus.data).tobytes() == before.tobytes()
    assert not any(name in torus.data.attributes for name in kept_original.NAMES)
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.parametrize("name", kept_original.NAMES)
def test_a_preview_whose_name_a_vertex_group_took(previewed, tmp_path, capfd, name):
    """Saving ended in a traceback."""
    torus, before = previewed
    torus.vertex_groups.new(name=name)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    current_preview.tick_preview()
    current_preview.end_preview()
    assert read_positions(torus.data).tobytes() == before.tobytes()
    assert torus.vertex_groups.keys() == [name] and name not in torus.data.attributes
    assert "Traceback" not in capfd.readouterr().err


# Contexts


class Windowless:
    """Blender's context in a timer: what depends on a screen is missing."""

    def __init__(self, *missing):
        self.missing = missing

    def __getattr__(self, name):
        if name in self.missing:
            raise AttributeError(name)
        return getattr(bpy.context, name)


def test_targets_without_a_window(torus, make_object, rng):
    """In a timer each button's check was a traceback."""
    other = make_object(meshes.noisy(meshes.quad_torus(), rng), "Other")
    select_only(other, torus)
    context = Windowless("active_object", "selected_objects", "objects_in_mode_unique_data")
    for mode in ("OBJECT", "EDIT", "SCULPT"):
        bpy.ops.object.mode_set(mode=mode)
        assert {obj.name for obj in target_objects(context)} == {
            obj.name for obj in target_objects(bpy.context)
        }
        assert active_object(context) == bpy.context.active_object
        assert {obj.name for obj in selected_objects(context)} == {"Torus", "Other"}
        assert {obj.name for obj in edited_objects(context)} == (
            {"Torus", "Other"} if mode == "EDIT" else set()
        )
        with contextlib.suppress(RuntimeError):
            bpy.ops.object.mode_set(mode="OBJECT")
