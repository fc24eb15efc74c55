# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""PLY, OBJ and STL in and out: positions to the last bit, order, faces, UVs, colors, names, materials."""

import numpy as np
import pytest
from framelet.core import PRESETS, SurfaceMesh, denoise

TOLERANCE = 1e-5  # another order of edges and faces changes the rounding
POSITIONS = ("--preset", "positions")


@pytest.fixture
def denoised(grid):
    """The grid's positions after a run with the preset POSITIONS."""
    surface = SurfaceMesh.from_faces(grid.vertices, grid.faces)
    return denoise(surface, PRESETS["POSITIONS"].settings).vertices


def same_faces(first, second):
    """Return whether faces are equal up to where each begins."""
    turned = [{face[i:] + face[:i] for i in range(len(face))} for face in first]
    return len(first) == len(second) and all(b in a for a, b in zip(turned, second, strict=True))


def test_ply_keeps_order_faces_uvs_and_colors(command, grid, denoised, write_ply, read_ply, tmp_path):
    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces, grid.colors, grid.uvs)
    assert command("denoise", source, tmp_path / "out.ply", *POSITIONS).code == 0
    result = read_ply(tmp_path / "out.ply")
    np.testing.assert_allclose(result.vertices, denoised, atol=TOLERANCE)
    assert not np.array_equal(result.vertices, grid.vertices)
    assert same_faces(grid.faces, result.faces)
    for index, name in enumerate(("red", "green", "blue", "alpha")):
        np.testing.assert_array_equal(result.fields[name], grid.colors[:, index])
    used = np.unique(np.concatenate(grid.faces))
    for index, name in enumerate("st"):
        np.testing.assert_array_equal(result.fields[name][used], grid.uvs[used, index])


def test_obj_keeps_order_faces_and_uvs(command, grid, denoised, write_obj, read_obj, tmp_path):
    source = write_obj(tmp_path / "in.obj", grid.vertices, grid.faces, grid.uvs, "o Cube")
    result = command("denoise", source, tmp_path / "out.obj", *POSITIONS)
    assert (result.code, result.err) == (0, "")
    result = read_obj(tmp_path / "out.obj")
    np.testing.assert_allclose(result.vertices, denoised, atol=TOLERANCE)
    assert same_faces(grid.faces, result.faces)
    for face, uv_face in zip(result.faces, result.uv_faces, strict=True):
        np.testing.assert_allclose(result.uvs[uv_face], grid.uvs[list(face)], atol=1e-5)
    assert "o Cube" in result.others
    assert not any(line.startswith("vn") for line in result.others)


def test_stl(command, grid, denoised, write_ply, tmp_path):
    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    assert command("denoise", source, tmp_path / "first.stl", *POSITIONS).code == 0
    assert command("denoise", tmp_path / "first.stl", tmp_path / "second.stl", *POSITIONS).code == 0
    triangle = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("count", "<u2")])
    n_triangles = sum(len(face) - 2 for face in grid.faces)
    known = {row.tobytes() for row in denoised}
    for name in ("first.stl", "second.stl"):
        triangles = np.fromfile(tmp_path / name, triangle, offset=84)
        assert len(triangles) == n_triangles
        assert np.isfinite(triangles["corners"]).all()
    first = np.fromfile(tmp_path / "first.stl", triangle, offset=84)["corners"].reshape(-1, 3)
    distance = np.abs(first[:, None] - denoised[None]).max(axis=2).min(axis=1)
    assert distance.max() < TOLERANCE and known


def test_formats_agree(command, grid, write_ply, write_obj, read_ply, read_obj, tmp_path):
    write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    write_obj(tmp_path / "in.obj", grid.vertices, grid.faces)
    results = []
    for source in ("in.ply", "in.obj"):
        for suffix, read in ((".ply", read_ply), (".obj", read_obj)):
            target = tmp_path / f"{source[-3:]}{suffix}"
            assert command("denoise", tmp_path / source, target, *POSITIONS).code == 0
            results.append(read(target).vertices)
    for other in results[1:]:
        np.testing.assert_allclose(other, results[0], atol=TOLERANCE)  # a text has a precision of its own


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_obj_carries_all_digits(command, grid, write_obj, read_obj, tmp_path, scale):
    vertices = (grid.vertices * np.float32(scale)).astype(np.float32)
    source = write_obj(tmp_path / "in.obj", vertices, grid.faces)
    assert command("denoise", source, tmp_path / "out.obj", *POSITIONS, "--lambda", "0").code == 0
    result = read_obj(tmp_path / "out.obj").vertices
    np.testing.assert_allclose(result, vertices, rtol=1e-5, atol=1e-6 * scale)


def test_several_objects_keep_names_and_order(command, grid, write_obj, read_obj, tmp_path):
    vertices, faces = grid.used_vertices, grid.faces_of_used
    n = len(vertices)
    source = write_obj(tmp_path / "in.obj", vertices, faces, before="o Zebra")
    second = write_obj(tmp_path / "b.obj", vertices + 50, faces, before="o Ape").read_text()
    shifted = [
        line if line[0] != "f" else "f " + " ".join(str(int(v) + n) for v in line.split()[1:])
        for line in second.splitlines()
    ]
    source.write_text(source.read_text() + "\n".join(shifted) + "\n")
    result = command("denoise", source, tmp_path / "out.obj", *POSITIONS)
    assert result.code == 0 and "in 2 objects" in result.out
    result = read_obj(tmp_path / "out.obj")
    assert [line for line in result.others if line[0] == "o"] == ["o Zebra", "o Ape"]
    assert len(result.vertices) == 2 * n
    np.testing.assert_allclose(result.vertices[n:] - 50, result.vertices[:n], atol=0.2)


def test_objects_that_share_vertices_are_one_surface(command, grid, write_obj, read_obj, tmp_path):
    source = write_obj(tmp_path / "in.obj", grid.vertices, grid.faces[:10], before="o Zebra")
    faces = ["f " + " ".join(str(v + 1) for v in face) for face in grid.faces[10:]]
    source.write_text("\n".join([source.read_text(), "o Ape", *faces]) + "\n")
    assert command("denoise", source, tmp_path / "out.obj", *POSITIONS).code == 0
    result = read_obj(tmp_path / "out.obj")
    assert len(result.vertices) == len(grid.vertices)
    assert same_faces(grid.faces, result.faces)


def test_unused_vertices_of_an_obj_keep_their_numbers(command, grid, write_obj, read_obj, tmp_path):
    vertices = np.concatenate([[[-9, -9, 0]], grid.vertices, [[7, 8, 9], [1, 2, 3]]]).astype(np.float32)
    faces = [tuple(v + 1 for v in face) for face in grid.faces]
    source = write_obj(tmp_path / "in.obj", vertices, faces)
    result = command("denoise", source, tmp_path / "out.obj", *POSITIONS)
    assert (result.code, result.err) == (0, "")
    assert "4 loose" in result.out
    result = read_obj(tmp_path / "out.obj")
    assert len(result.vertices) == len(vertices)
    for unused in (0, 11, -2, -1):
        np.testing.assert_array_equal(result.vertices[unused], vertices[unused])
    assert same_faces(faces, result.faces)


def test_materials_and_textures(command, grid, write_obj, read_obj, tmp_path):
    import bpy

    (tmp_path / "tex").mkdir()
    image = bpy.data.images.new("skin", 2, 2)
    image.filepath_raw = str(tmp_path / "tex" / "skin.png")
    image.file_format = "PNG"
    image.save()
    bpy.data.images.remove(image)
    (tmp_path / "in.mtl").write_text("newmtl Material\nKd 1 0.5 0\nmap_Kd tex/skin.png\n")
    before = "mtllib in.mtl\no Cube\nusemtl Material"
    source = write_obj(tmp_path / "in.obj", grid.vertices, grid.faces, grid.uvs)
    source.write_text(before + "\n" + source.read_text())
    result = command("denoise", source, tmp_path / "out.obj", *POSITIONS)
    assert (result.code, result.err) == (0, "")
    others = read_obj(tmp_path / "out.obj").others
    assert "mtllib in.mtl" in others and "usemtl Material" in others
    assert "map_Kd tex/skin.png" in (tmp_path / "in.mtl").read_text()


def test_groups_and_colors_of_an_obj(command, grid, write_obj, read_obj, tmp_path):
    source = write_obj(tmp_path / "in.obj", grid.vertices, grid.faces)
    colors = np.round(grid.colors[:, :3] / 255, 4)
    rows = iter(colors)
    lines = [
        line + " " + " ".join(map(str, next(rows))) if line.startswith("v ") else line
        for line in source.read_text().splitlines()
    ]
    first_face = next(i for i, line in enumerate(lines) if line.startswith("f "))
    lines.insert(first_face, "g left")
    lines.insert(first_face + 12, "g right")
    source.write_text("\n".join(lines) + "\n")
    assert command("denoise", source, tmp_path / "out.obj", *POSITIONS).code == 0
    result = read_obj(tmp_path / "out.obj")
    np.testing.assert_allclose(result.colors, colors, atol=2e-4)
    assert {"g left", "g right"} <= set(result.others)


def test_upper_case_suffix_and_in_place(command, grid, write_ply, read_ply, tmp_path):
    source = write_ply(tmp_path / "In File.PLY", grid.vertices, grid.faces)
    assert command("denoise", source, "--in-place", *POSITIONS).code == 0
    assert len(read_ply(source).vertices) == len(grid.vertices)
    assert [path.name for path in tmp_path.iterdir()] == ["In File.PLY"]
