# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What goes wrong: one sentence, an exit code, and all files as they were."""

import os

import numpy as np
import pytest

HEADER = (
    "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
    "element face {}\nproperty list uchar int vertex_indices\nend_header\n"
)

# For runs that are to reach their end.
QUICK = ("--preset", "positions")


@pytest.fixture
def source(grid, write_ply, tmp_path):
    """A good file."""
    return write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)


@pytest.fixture
def unchanged(tmp_path):
    """Remember the files of a folder when called, and check in the end that they are the same."""
    (tmp_path / "out.ply").write_text("precious")
    before = {}

    def content():
        # The report says why, always.
        paths = [path for path in tmp_path.rglob("*") if path.name != "r.json"]
        return {path: path.read_bytes() for path in paths if path.is_file()}

    yield lambda: before.update(content())
    assert content() == before


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("empty.ply", b"", "is empty"),
        ("empty.obj", b"", "is empty"),
        ("empty.stl", b"", "is empty"),
        ("empty.blend", b"", "is empty"),
        ("noise.ply", bytes(range(256)) * 20, "does not begin with ‘ply’"),
        ("noise.obj", bytes(range(256)) * 20, "has no faces"),
        ("noise.stl", bytes(range(256)) * 20, ""),
        ("noise.blend", bytes(range(256)) * 20, "cannot be read: Blender says"),
        ("comment.obj", b"# nothing here\n", "has no faces"),
        ("none.ply", HEADER.format(0, 0).encode(), "has no faces"),
        ("short.ply", HEADER.format(4, 2).encode() + b"0 0 0\n1 0 0\n", "cut off"),
        ("cloud.ply", HEADER.format(2, 0).encode() + b"0 0 0\n1 0 0\n", "‘cloud’ has no faces"),
        ("cloud.obj", b"v 0 0 0\nv 1 0 0\n", "‘cloud’ has no faces"),
        ("wire.obj", b"v 0 0 0\nv 1 0 0\nl 1 2\n", "‘wire’ has no faces"),
        ("zero.stl", bytes(84), "has no faces"),
        ("words.stl", b"this is not a surface\n", "begins neither with ‘solid’ nor"),
        ("point.obj", b"v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", ""),
    ],
)
def test_files_that_cannot_be_denoised(fails, unchanged, tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    unchanged()
    sentence = fails("denoise", tmp_path / name, tmp_path / "out.ply", "--report", tmp_path / "r.json")
    assert message in sentence and name in sentence


def test_missing_input(fails, unchanged, tmp_path):
    unchanged()
    assert "does not exist" in fails("denoise", tmp_path / "none.ply", tmp_path / "out.ply")


def test_folder_as_input(fails, tmp_path):
    (tmp_path / "folder.ply").mkdir()
    assert "is a folder" in fails("denoise", tmp_path / "folder.ply", tmp_path / "out.ply")


@pytest.mark.parametrize("names", [("in.3mf", "out.ply"), ("in.ply", "out.xyz"), ("in.ply", "out")])
def test_unknown_types_are_usage_errors(fails, source, tmp_path, names):
    sentence = fails("denoise", *(tmp_path / name for name in names), code=2)
    assert "is no mesh file; its name must end in .ply, .obj" in sentence


def test_missing_output_folder(fails, source, tmp_path):
    sentence = fails("denoise", source, tmp_path / "none" / "out.ply")
    assert "does not exist" in sentence
    sentence = fails("denoise", source, tmp_path / "out.ply", "--report", tmp_path / "none" / "r.json")
    assert "does not exist" in sentence
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.ply"]


def test_folder_as_output(fails, source, tmp_path):
    (tmp_path / "out.ply").mkdir()
    assert "is a folder" in fails("denoise", source, tmp_path / "out.ply")


def test_folder_that_cannot_be_written_to(fails, source, tmp_path, monkeypatch):
    # The mode of a folder does not stop the administrator, so the answer is pretended.
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert "cannot be written to" in fails("denoise", source, tmp_path / "out.ply")


def test_report_over_a_mesh_is_a_usage_error(fails, source, unchanged, tmp_path):
    unchanged()
    fails("denoise", source, tmp_path / "out.ply", "--report", source, code=2)
    fails("denoise", source, tmp_path / "out.ply", "--report", tmp_path / "out.ply", code=2)


def test_a_damaged_blend_file(fails, unchanged, tmp_path):
    (tmp_path / "out.blend").write_text("precious")
    (tmp_path / "broken.blend").write_bytes(b"BLENDER-v405" + bytes(1000))
    unchanged()
    sentence = fails("denoise", tmp_path / "broken.blend", tmp_path / "out.blend", *QUICK)
    assert "broken.blend cannot be read: Blender says" in sentence


def test_interrupt(command, source, unchanged, tmp_path, monkeypatch):
    from framelet import core

    def interrupt(*_arguments, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr(core, "denoise", interrupt)
    unchanged()
    result = command("denoise", source, tmp_path / "out.ply", *QUICK)
    assert result.code == 130
    assert result.err == "framelet: Interrupted; nothing was written.\n"


def test_faces_that_name_nothing_stay_and_are_told(command, tmp_path, read_obj):
    source = tmp_path / "in.obj"
    source.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.1\nf 1 2 3\nf 2 4 3\nf 1 2 30\n")
    result = command("denoise", source, tmp_path / "out.obj", *QUICK)
    assert result.code == 0
    assert "1 face names a vertex that does not exist; it stays in the file, unused." in result.err
    assert len(read_obj(tmp_path / "out.obj").faces) == 3


def test_quiet(command, source, tmp_path):
    result = command("denoise", source, tmp_path / "out.ply", "--quiet", *QUICK)
    assert (result.code, result.out, result.err) == (0, "", "")


def test_the_session_is_as_it_was(command, source, write_obj, grid, tmp_path):
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=False)
    names = sorted(data.name_full for data in bpy.data.user_map())
    cube = np.array([vertex.co for vertex in bpy.data.objects["Cube"].data.vertices])
    other = write_obj(tmp_path / "cube.obj", grid.vertices, grid.faces, before="o Cube")
    assert command("denoise", other, tmp_path / "out.obj", *QUICK).code == 0
    assert command("denoise", tmp_path / "none.ply", tmp_path / "out.obj").code == 1
    assert "o Cube\n" in (tmp_path / "out.obj").read_text()
    assert sorted(data.name_full for data in bpy.data.user_map()) == names
    assert bpy.context.scene.name == "Scene"
    after = np.array([vertex.co for vertex in bpy.data.objects["Cube"].data.vertices])
    np.testing.assert_array_equal(after, cube)
