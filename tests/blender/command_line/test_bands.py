# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""`bands`: plain arrays in the documented layout, from which the surface comes back; all files or none."""

import numpy as np
import pytest
from framelet.core import BANKS, SurfaceMesh, make_transform
from framelet.operators.command_line.arguments import as_word
from framelet.operators.command_line.band_arrays import LAYOUT
from framelet.operators.command_line.version import framelet_version
from framelet.operators.files import safe_write

CELL_ARRAYS = {"cell_corners", "cell_owner", "n_quad_cells"}
ARRAYS = {"vertices", "edges", "corner_vertex", "face_offset", "low", "levels"}
TEXTS = {"frame", "stencil", "boundary", "name", "version"}


@pytest.fixture
def source(grid, write_ply, tmp_path):
    """A good file with quads, triangles and a loose vertex."""
    return write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)


@pytest.fixture
def two_objects(grid, write_obj, tmp_path):
    """A file with two objects; the name of the first is no file name."""
    faces = [tuple(v + len(grid.used_vertices) for v in face) for face in grid.faces_of_used]
    path = write_obj(tmp_path / "in.obj", grid.used_vertices, grid.faces_of_used, before="o Zebra/1")
    second = write_obj(tmp_path / "b.obj", 2 * grid.used_vertices, faces, before="o Ape")
    path.write_text(path.read_text() + second.read_text())
    second.unlink()
    return path


def load(path):
    """Return the arrays of a file, which must not need pickle."""
    with np.load(path, allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


def faces_of(arrays):
    """Return the faces in a file as sets of vertices."""
    return [set(face.tolist()) for face in np.split(arrays["corner_vertex"], arrays["face_offset"][1:-1])]


def rebuilt(arrays):
    """Return positions made from the arrays of a file alone."""
    faces = np.split(arrays["corner_vertex"], arrays["face_offset"][1:-1])
    surface = SurfaceMesh.from_faces(arrays["vertices"].astype(np.float64), faces)
    n_levels = int(arrays["levels"])
    transform = make_transform(
        surface, str(arrays["frame"]), str(arrays["stencil"]), n_levels, boundary=str(arrays["boundary"])
    )
    bands = [arrays[f"L{level + 1}"] for level in range(n_levels)]
    coefficients = transform.analyze(surface.vertices).with_details(bands, arrays["low"])
    return transform.synthesize(coefficients)


def test_layout(command, source, grid, tmp_path):
    result = command("bands", source, "--out", tmp_path / "b.npz", "--levels", "2", "--stencil", "mean")
    assert (result.code, result.err) == (0, "")
    read, analyzed, wrote = result.out.splitlines()
    assert read.startswith(f"Read {source}: ")
    assert analyzed.startswith("Analyzed in with adaptive: level 1 has ")
    assert wrote == f"Wrote {tmp_path / 'b.npz'}."
    arrays = load(tmp_path / "b.npz")
    assert set(arrays) == ARRAYS | TEXTS | {"L1", "L2"}
    for name in TEXTS:
        assert arrays[name].dtype.kind == "U" and arrays[name].shape == ()
    assert {name: str(arrays[name]) for name in TEXTS} == {
        "frame": "ADAPTIVE",
        "stencil": "MEAN",
        "boundary": "ALONG",
        "name": "in",
        "version": framelet_version(),
    }
    assert arrays["levels"] == 2
    np.testing.assert_array_equal(arrays["vertices"], grid.vertices)
    assert faces_of(arrays) == [set(face) for face in grid.faces]
    n = len(grid.vertices)
    assert arrays["low"].shape == (n, 3)
    for name in ("vertices", "low", "L1", "L2"):
        assert arrays[name].dtype == np.float32
    for name in ("L1", "L2"):
        assert arrays[name].shape[1:] == (n, 3) and np.abs(arrays[name]).max() > 1e-3
        # A loose vertex has no details.
        assert not arrays[name][:, 10].any()


def test_the_help_names_every_array(command, source, tmp_path):
    words = "bands", source, "--out", tmp_path / "b.npz", "--frame", "b-spline-1"
    assert command(*words).code == 0
    for name in load(tmp_path / "b.npz"):
        assert name in LAYOUT
    shown = " ".join(command("bands", "--help").out.split())
    assert " ".join(LAYOUT.split()) in shown


@pytest.mark.parametrize("frame", ["AUTO", "ADAPTIVE", "PAIRWISE", *BANKS])
@pytest.mark.parametrize("boundary", ["ALONG", "FREE"])
def test_the_surface_comes_back(command, source, grid, tmp_path, frame, boundary):
    words = ["--frame", as_word(frame), "--levels", "2", "--boundary", as_word(boundary)]
    assert command("bands", source, "--out", tmp_path / "b.npz", *words).code == 0
    arrays = load(tmp_path / "b.npz")
    np.testing.assert_allclose(rebuilt(arrays), grid.vertices, atol=1e-5)
    is_on_cells = frame in BANKS and BANKS[frame].is_cell_centered
    assert CELL_ARRAYS & set(arrays) == (CELL_ARRAYS if is_on_cells else set())


@pytest.mark.parametrize("frame", ["b-spline-1", "b-spline-3", "box-spline-four-direction"])
def test_cells(command, source, grid, tmp_path, frame):
    words = ["--frame", frame, "--levels", "2"]
    result = command("bands", source, "--out", tmp_path / "b.npz", *words)
    assert " cells; level 2 has " in result.out
    arrays = load(tmp_path / "b.npz")
    corners, owner, n_quads = arrays["cell_corners"], arrays["cell_owner"], int(arrays["n_quad_cells"])
    assert arrays["L1"].shape[1] == len(corners) == len(owner) > n_quads
    assert arrays["L2"].shape[1] == len(grid.vertices)
    faces = faces_of(arrays)
    assert n_quads == sum(len(face) == 4 for face in faces)
    for cell, face in zip(corners[:n_quads].tolist(), owner[:n_quads], strict=True):
        assert set(cell) == faces[face]
    for cell, edge in zip(corners[n_quads:].tolist(), owner[n_quads:], strict=True):
        # The common edge is the diagonal from the first corner to the third.
        assert set(arrays["edges"][edge].tolist()) == {cell[0], cell[2]}
        assert all({*diagonal, third} in faces for third in cell[1::2] for diagonal in [cell[::2]])


def test_one_file_for_each_object(command, two_objects, grid, tmp_path):
    result = command("bands", two_objects, "--out", tmp_path / "b.npz")
    assert (result.code, result.err) == (0, "")
    assert result.out.splitlines()[-1] == f"Wrote {tmp_path / 'b-1.npz'} and {tmp_path / 'b-2.npz'}."
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b-1.npz", "b-2.npz", "in.obj"]
    first, second = load(tmp_path / "b-1.npz"), load(tmp_path / "b-2.npz")
    assert (str(first["name"]), str(second["name"])) == ("Zebra/1", "Ape")
    np.testing.assert_array_equal(first["vertices"], grid.used_vertices)
    np.testing.assert_array_equal(second["vertices"], 2 * grid.used_vertices)
    np.testing.assert_allclose(second["L1"], 2 * first["L1"], atol=1e-5)


def test_skipped_objects_keep_their_numbers(command, grid, write_obj, tmp_path):
    wire = "o Wire\nv 9 9 9\nv 9 9 8\nl 1 2\no Zebra"
    faces = [tuple(v + 2 for v in face) for face in grid.faces_of_used]
    path = write_obj(tmp_path / "in.obj", grid.used_vertices, faces, before=wire)
    result = command("bands", path, "--out", tmp_path / "b.npz")
    assert result.code == 0
    assert result.err == (
        "framelet: warning: ‘Wire’ has no faces; Framelet works on surfaces. It was skipped.\n"
    )
    assert sorted(file.name for file in tmp_path.iterdir()) == ["b-2.npz", "in.obj"]


def test_a_blend_file(command, grid, tmp_path):
    import bpy

    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(grid.vertices.tolist(), [], grid.faces)
    for name in ("Sheet", "Twin"):
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    bpy.data.objects["Sheet"].location = (5, 0, 0)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    assert command("bands", tmp_path / "in.blend", "--out", tmp_path / "b.npz").code == 0
    # The twins share their mesh, which is in object space.
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b.npz", "in.blend"]
    np.testing.assert_array_equal(load(tmp_path / "b.npz")["vertices"], grid.vertices)


def test_a_file_is_replaced(command, source, tmp_path):
    (tmp_path / "B.NPZ").write_text("old")
    assert command("bands", source, "--out", tmp_path / "B.NPZ", "--quiet").out == ""
    assert load(tmp_path / "B.NPZ")["levels"] == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["B.NPZ", "in.ply"]


def test_too_large(fails, source, tmp_path):
    sentence = fails("bands", source, "--out", tmp_path / "b.npz", "--max-size", "0.001")
    assert "more than the 0.001 MB that are allowed" in sentence
    assert not (tmp_path / "b.npz").exists()


@pytest.mark.parametrize("name", ["b", "b.npy", "b.ply"])
def test_other_types_are_usage_errors(fails, source, tmp_path, name):
    assert "is no .npz file" in fails("bands", source, "--out", tmp_path / name, code=2)


def test_missing_files_and_folders(fails, source, tmp_path):
    assert "does not exist" in fails("bands", tmp_path / "none.ply", "--out", tmp_path / "b.npz")
    assert "does not exist" in fails("bands", source, "--out", tmp_path / "none" / "b.npz")
    (tmp_path / "b.npz").mkdir()
    assert "is a folder" in fails("bands", source, "--out", tmp_path / "b.npz")


@pytest.mark.parametrize("n_good", [0, 1])
def test_a_full_disk_leaves_no_trace(fails, two_objects, tmp_path, monkeypatch, n_good):
    done = []

    def fsync(number):
        if len(done) == n_good:
            raise OSError(28, "No space left on device")
        done.append(number)

    monkeypatch.setattr(safe_write.os, "fsync", fsync)
    (tmp_path / "b-1.npz").write_text("precious")
    sentence = fails("bands", two_objects, "--out", tmp_path / "b.npz")
    assert "could not be written: No space left on device" in sentence
    assert (tmp_path / "b-1.npz").read_text() == "precious"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b-1.npz", "in.obj"]
