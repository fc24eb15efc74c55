# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Files of Blender in and out: all meshes denoised, everything else intact."""

import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from framelet.core import PRESETS, SurfaceMesh, denoise

CASES = Path(__file__).resolve().parents[4] / "shared" / "cases" / "reliability"


def positions(mesh):
    """Return the positions of a mesh."""
    return np.array([vertex.co for vertex in mesh.vertices], np.float32)


def open_file(path):
    """Open a .blend file in the session."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(path))


def mesh_object(name, vertices, faces, edges=()):
    """Add a mesh object to the scene."""
    import bpy

    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, v)) for v in vertices], edges, faces)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


@pytest.fixture
def blend(grid, tmp_path):
    """A .blend file with a modifier, a parent, a twin, a hidden mesh in Edit Mode, a camera and a wire."""
    import bpy

    surface = mesh_object("Surface", grid.vertices, grid.faces)
    surface.modifiers.new("Subdivision", "SUBSURF")
    surface.location = (1, 2, 3)
    twin = bpy.data.objects.new("Twin", surface.data)
    twin.parent = surface
    twin.location = (100, 0, 0)
    bpy.context.scene.collection.objects.link(twin)
    hidden = mesh_object("Hidden", grid.vertices * 2, grid.faces)
    mesh_object("Wire", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)])
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    bpy.context.scene.collection.objects.link(camera)
    image = bpy.data.images.new("Skin", 2, 2)
    image.use_fake_user = True
    image.filepath = "//textures/skin.png"
    image.source = "FILE"
    bpy.context.view_layer.objects.active = hidden
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    hidden.hide_viewport = True
    path = tmp_path / "in.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def test_blend_to_blend(command, blend, grid, tmp_path):
    import bpy

    (tmp_path / "deeper").mkdir()
    target = tmp_path / "deeper" / "out.blend"
    target.write_text("old")
    original = blend.read_bytes()
    result = command("denoise", blend, target, "--preset", "positions")
    assert result.code == 0
    assert (
        result.err == "framelet: warning: ‘Wire’ has no faces; Framelet works on surfaces. It was skipped.\n"
    )
    assert result.out.count("Denoised") == 2  # the twins share a mesh
    assert blend.read_bytes() == original
    assert [path.name for path in target.parent.iterdir()] == ["out.blend"]

    open_file(target)
    assert set(bpy.context.scene.objects.keys()) == {"Surface", "Twin", "Hidden", "Wire", "Eye"}
    assert bpy.data.objects["Surface"].modifiers.keys() == ["Subdivision"]
    assert bpy.data.objects["Hidden"].hide_viewport
    assert bpy.data.objects["Twin"].data == bpy.data.objects["Surface"].data
    assert (
        bpy.path.abspath(bpy.data.images["Skin"].filepath) == str(tmp_path / "textures" / "skin.png")
        or bpy.data.images["Skin"].filepath == "//../textures/skin.png"
    )
    expected = denoise(
        SurfaceMesh.from_faces(grid.vertices, grid.faces), PRESETS["POSITIONS"].settings
    ).vertices
    np.testing.assert_allclose(positions(bpy.data.objects["Surface"].data), expected, atol=1e-5)
    np.testing.assert_allclose(positions(bpy.data.objects["Hidden"].data), 2 * expected, atol=1e-5)


@pytest.mark.parametrize("suffix", [".ply", ".obj"])
def test_blend_to_mesh_file(command, blend, grid, read_ply, read_obj, tmp_path, suffix):
    target = tmp_path / f"out{suffix}"
    assert command("denoise", blend, target, "--preset", "positions").code == 0
    result = (read_ply if suffix == ".ply" else read_obj)(target)
    expected = denoise(
        SurfaceMesh.from_faces(grid.vertices, grid.faces), PRESETS["POSITIONS"].settings
    ).vertices
    parts = np.split(result.vertices, 3)
    wanted = [expected + np.array([1, 2, 3]), expected + np.array([101, 2, 3]), 2 * expected]
    for part, points in zip(parts, wanted, strict=True):
        np.testing.assert_allclose(part, points, atol=1e-4)
    assert len(result.vertices) == 3 * len(grid.vertices)
    assert len(result.faces) == 3 * len(grid.faces)


def test_mesh_file_to_blend(command, grid, write_ply, read_ply, tmp_path):
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=False)
    source = write_ply(tmp_path / "bust.ply", grid.vertices, grid.faces)
    assert command("denoise", source, tmp_path / "out.ply", "--preset", "positions").code == 0
    assert command("denoise", source, tmp_path / "out.blend", "--preset", "positions").code == 0
    open_file(tmp_path / "out.blend")
    assert bpy.context.scene.objects.keys() == ["bust"]
    assert bpy.data.meshes.keys() == ["bust"]
    expected = read_ply(tmp_path / "out.ply").vertices
    np.testing.assert_array_equal(positions(bpy.data.objects["bust"].data), expected)


def test_active_shape_key_is_exported(command, grid, read_ply, tmp_path):
    import bpy

    obj = mesh_object("Face", grid.vertices, grid.faces)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Smile")
    key.points.foreach_set("co", (grid.vertices + np.float32([0, 0, 5])).ravel())
    obj.active_shape_key_index = 1
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    assert command("denoise", tmp_path / "in.blend", tmp_path / "out.ply", "--preset", "positions").code == 0
    result = read_ply(tmp_path / "out.ply").vertices
    assert abs(np.median(result[:, 2]) - 5) < 0.2


def test_blend_without_a_mesh(fails, tmp_path):
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    assert "has no mesh objects" in fails("denoise", tmp_path / "in.blend", tmp_path / "out.ply")


def test_blend_in_which_no_mesh_can_be_denoised(fails, tmp_path):
    import bpy

    mesh_object("Wire", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    sentence = fails("denoise", tmp_path / "in.blend", tmp_path / "out.blend")
    assert "‘Wire’ has no faces" in sentence
    assert not (tmp_path / "out.blend").exists()


@pytest.mark.parametrize("output", ["shape-key", "new-object"])
def test_output_goes_where_the_option_says(command, blend, grid, tmp_path, output):
    import bpy

    target = tmp_path / "out.blend"
    assert command("denoise", blend, target, "--preset", "tri-2", "--output", output).code == 0
    open_file(target)
    noisy = grid.vertices.astype(np.float32)
    expected = denoise(SurfaceMesh.from_faces(noisy, grid.faces), PRESETS["TRI_2"].settings).vertices
    surface = bpy.data.objects["Surface"]
    assert np.array_equal(positions(surface.data), noisy)
    if output == "shape-key":
        key = surface.data.shape_keys.key_blocks["Denoised"]
        assert key.value == 1.0
        assert np.array_equal(np.array([point.co for point in key.data], np.float32), expected)
    else:
        new = bpy.data.objects["Surface.denoised"]
        assert np.array_equal(positions(new.data), expected)
        assert len([obj for obj in bpy.data.objects if obj.name.endswith(".denoised")]) == 2
        assert bpy.data.objects["Twin"].data == surface.data


def test_output_needs_a_blend_file(fails, blend, tmp_path):
    sentence = fails("denoise", blend, tmp_path / "out.ply", "--output", "shape-key", code=2)
    assert "--output shape-key needs a .blend file as OUT" in sentence
    assert not (tmp_path / "out.ply").exists()


@pytest.mark.parametrize("suffix", [".fbx", ".usd", ".abc", ".glb"])
def test_other_files_of_blender(command, grid, tmp_path, suffix):
    import bpy

    mesh_object("Sheet", grid.used_vertices, grid.faces_of_used)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    target = tmp_path / f"out{suffix}"
    result = command("denoise", tmp_path / "in.blend", target, "--preset", "positions")
    assert result.code == 0, result.err
    assert target.stat().st_size > 0
    # And in again, to where every vertex can be looked at.
    result = command("denoise", target, tmp_path / "again.ply", "--preset", "positions")
    assert result.code == 0, result.err
    if suffix != ".glb":  # which has a vertex of its own for each corner of a flat face
        assert f"{len(grid.used_vertices)} vertices" in result.out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again.ply", "in.blend", target.name]


def test_a_driver_does_not_keep_the_command_from_ending(command, grid, tmp_path):
    import bpy

    obj = mesh_object("Sheet", grid.vertices, grid.faces)
    obj.driver_add("location", 0).driver.expression = "len('abc') * 1.0"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    began = time.monotonic()
    assert command("denoise", tmp_path / "in.blend", tmp_path / "out.ply", "--preset", "tri-2").code == 0
    assert time.monotonic() - began < 60 and (tmp_path / "out.ply").exists()


def test_a_blender_that_dies_is_told(fails, grid, tmp_path, monkeypatch):
    from framelet.operators.command_line import blender_process

    mesh_object("Sheet", grid.vertices, grid.faces)
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    worker = tmp_path / "dies.py"
    worker.write_text("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    monkeypatch.setattr(blender_process, "WORKER", worker)
    sentence = fails("denoise", tmp_path / "in.blend", tmp_path / "out.ply")
    assert "Blender ended by signal 11 while it worked on" in sentence
    assert sorted(path.name for path in tmp_path.iterdir()) == ["dies.py", "in.blend"]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_end_blender_too(python, launcher, grid, tmp_path, number):
    import bpy

    big = np.stack(np.meshgrid(np.arange(300.0), np.arange(300.0), [0.0]), axis=-1).reshape(-1, 3)
    big[:, 2] = np.random.default_rng(1).normal(0, 0.2, len(big))
    k = np.arange(300 * 300).reshape(300, 300)
    faces = np.stack((k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]), axis=-1).reshape(-1, 4).tolist()
    mesh_object("Sheet", big, faces)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    code = launcher + "from framelet.operators.command_line import main\nsys.exit(main())"
    words = [python, "-c", code, "denoise", tmp_path / "in.blend", tmp_path / "out.ply", "--passes", "6"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")
    assert process.stdout.readline().startswith("Read ")
    process.send_signal(number)
    _out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (128 + number, "framelet: Interrupted; nothing was written.\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.blend"]


def test_damaged_indices(fails, tmp_path):
    import gzip

    packed = CASES / "corrupt_indices.blend.gz"
    if not packed.exists():
        pytest.skip(f"there is no file {packed}")
    (tmp_path / "in.blend").write_bytes(gzip.decompress(packed.read_bytes()))
    fails("denoise", tmp_path / "in.blend", tmp_path / "out.ply", "--preset", "tri-2")
    assert not (tmp_path / "out.ply").exists()
