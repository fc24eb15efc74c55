# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""`equalize`: gains for each scale, in any format, with everything but positions intact."""

import numpy as np
import pytest
from framelet.core import SurfaceMesh, equalize

TOLERANCE = 1e-5  # another order of edges and faces changes the rounding


@pytest.fixture
def source(grid, write_ply, tmp_path):
    """A good file with quads, triangles and a loose vertex."""
    return write_ply(tmp_path / "in.ply", grid.vertices, grid.faces, grid.colors)


def test_gains(command, source, grid, read_ply, tmp_path):
    result = command("equalize", source, tmp_path / "out.ply", "--gains", "0.2, 1,1.5")
    assert (result.code, result.err) == (0, "")
    read, done, wrote = result.out.splitlines()
    assert read.startswith(f"Read {source}: ")
    assert done.startswith("Equalized in: vertices moved by ") and done.endswith(" at most.")
    assert wrote == f"Wrote {tmp_path / 'out.ply'}."
    surface = SurfaceMesh.from_faces(grid.vertices, grid.faces)
    found = read_ply(tmp_path / "out.ply")
    np.testing.assert_allclose(found.vertices, equalize(surface, [0.2, 1.0, 1.5]), atol=TOLERANCE)
    assert not np.array_equal(found.vertices, grid.vertices)
    np.testing.assert_array_equal(found.fields["red"], grid.colors[:, 0])


@pytest.mark.parametrize("gains", ["1", "1,1", "1.0,1e0,1"])
def test_gains_of_one_change_no_bit(command, source, grid, read_ply, tmp_path, gains):
    assert command("equalize", source, tmp_path / "out.ply", "--gains", gains).code == 0
    np.testing.assert_array_equal(read_ply(tmp_path / "out.ply").vertices, grid.vertices)


@pytest.mark.parametrize(
    "options",
    [
        {"frame": "ADAPTIVE"},
        {"frame": "LINEAR_SPLINE", "stencil": "MEAN"},
        {"frame": "B_SPLINE_3", "boundary": "FREE"},
        {"frame": "AUTO", "boundary": "FIXED"},
    ],
    ids=str,
)
def test_options(command, source, grid, read_ply, tmp_path, options):
    words = [word for name, value in options.items() for word in (f"--{name}", value.lower())]
    assert command("equalize", source, tmp_path / "out.ply", "--gains", "0,2", *words).code == 0
    expected = equalize(SurfaceMesh.from_faces(grid.vertices, grid.faces), [0.0, 2.0], **options)
    np.testing.assert_allclose(read_ply(tmp_path / "out.ply").vertices, expected, atol=TOLERANCE)


def test_formats_agree(command, source, grid, write_obj, read_obj, read_ply, tmp_path):
    write_obj(tmp_path / "in.obj", grid.vertices, grid.faces)
    words = ["--gains", "0.5"]
    assert command("equalize", source, tmp_path / "out.ply", *words).code == 0
    assert command("equalize", tmp_path / "in.obj", tmp_path / "out.obj", *words).code == 0
    first, second = read_ply(tmp_path / "out.ply").vertices, read_obj(tmp_path / "out.obj").vertices
    np.testing.assert_allclose(first, second, atol=TOLERANCE)  # a text has a precision of its own


def test_blend(command, grid, read_ply, tmp_path):
    import bpy

    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(grid.vertices.tolist(), [], grid.faces)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Sheet", mesh))
    wire = bpy.data.meshes.new("Wire")
    wire.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Wire", wire))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    result = command("equalize", tmp_path / "in.blend", tmp_path / "out.ply", "--gains", "0.5,0.5")
    assert result.code == 0
    assert "‘Wire’ has no faces; Framelet works on surfaces. It was skipped." in result.err
    expected = equalize(SurfaceMesh.from_faces(grid.vertices, grid.faces), [0.5, 0.5])
    np.testing.assert_allclose(read_ply(tmp_path / "out.ply").vertices, expected, atol=TOLERANCE)


def test_quiet(command, source, tmp_path):
    result = command("equalize", source, tmp_path / "out.ply", "--gains", "0.5", "--quiet")
    assert (result.code, result.out, result.err) == (0, "", "")


@pytest.mark.parametrize("names", [("in.3mf", "out.ply"), ("in.ply", "out.npz")])
def test_unknown_types_are_usage_errors(fails, source, tmp_path, names):
    words = [*(tmp_path / name for name in names), "--gains", "1"]
    assert "is no mesh file; its name must end in .ply, .obj" in fails("equalize", *words, code=2)


def test_refusals_leave_files_alone(fails, source, tmp_path):
    target = tmp_path / "out.ply"
    target.write_text("precious")
    assert "does not exist" in fails("equalize", tmp_path / "none.ply", target, "--gains", "1")
    assert "too small for" in fails("equalize", source, target, "--gains", "1,1,1,1,1,0")
    fails("equalize", source, target, "--gains", "1,nan", code=2)
    assert target.read_text() == "precious"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.ply", "out.ply"]
