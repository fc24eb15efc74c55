# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A batch with files that Blender alone reads: each in a Blender of its own, bad ones among them."""

import json

import bpy
from framelet.operators.command_line import main


def save_blend(path, vertices, faces):
    """Write a .blend file with one mesh."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = bpy.data.meshes.new("Scan")
    mesh.from_pydata([tuple(map(float, vertex)) for vertex in vertices], [], [list(face) for face in faces])
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Scan", mesh))
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def test_blend_files_among_others(grid, write_obj, tmp_path):
    scans, out = tmp_path / "scans", tmp_path / "out"
    scans.mkdir()
    vertices, faces = grid.used_vertices, grid.faces_of_used
    save_blend(scans / "good.blend", vertices, faces)
    write_obj(scans / "plain.obj", vertices, faces)
    good = (scans / "good.blend").read_bytes()
    (scans / "half.blend").write_bytes(good[: len(good) // 2])
    (scans / "noise.fbx").write_bytes(bytes(range(256)))
    assert main(["batch", str(scans), "--out", str(out), "--preset", "tri-2"]) == 1
    rows = {row["output"]: row for row in map(json.loads, (out / "report.jsonl").read_text().splitlines())}
    assert {name: row["status"] for name, row in rows.items()} == {
        "good.blend": "done", "plain.obj": "done", "half.blend": "failed", "noise.fbx": "failed",
    }  # fmt: skip
    assert rows["good.blend"]["blender"] == bpy.app.version_string.split()[0]
    assert rows["plain.obj"]["blender"] is None
    for name in ("good.blend", "plain.obj"):
        assert rows[name]["n_vertices"] == len(vertices) and rows[name]["n_moved"] > 0
        assert rows[name]["peak_bytes"] is None or rows[name]["peak_bytes"] > 10**7
    assert all(rows[name]["error"] for name in ("half.blend", "noise.fbx"))
    assert sorted(path.name for path in out.iterdir() if not path.name.startswith("report")) == [
        "good.blend", "plain.obj",
    ]  # fmt: skip
    assert (scans / "good.blend").read_bytes() == good
    # Only what failed is done once more.
    assert main(["batch", str(scans), "--out", str(out), "--preset", "tri-2"]) == 1
    assert len((out / "report.jsonl").read_text().splitlines()) == 6


def test_scripts_in_files_do_not_run(grid, tmp_path):
    """Neither when a batch opens them nor when it writes them; that they would run is seen first."""
    scans, out, ran = tmp_path / "scans", tmp_path / "out", tmp_path / "ran"
    scans.mkdir()
    save_blend(scans / "scan.blend", grid.used_vertices, grid.faces_of_used)
    text = bpy.data.texts.new("start.py")
    text.write(f"open({str(ran)!r}, 'w').close()")
    text.use_module = True  # run when the file is opened
    bpy.ops.wm.save_as_mainfile(filepath=str(scans / "scan.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(scans / "scan.blend"), use_scripts=True)
    assert ran.exists()
    ran.unlink()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert main(["batch", str(scans), "--out", str(out), "--preset", "tri-2"]) == 0
    assert (out / "scan.blend").exists() and not ran.exists()
