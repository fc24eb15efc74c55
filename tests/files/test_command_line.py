# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The command line without Blender: what it refuses, what it says, and what is on the disk afterwards."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from framelet.operators.files import open_file, safe_write

from .made import full_gltf, full_obj, full_ply, sheet

ROOT = Path(__file__).resolve().parents[2]
QUICK = ("--preset", "tri-2")

PROGRAM = f"""
import importlib.util, sys
sys.modules["bpy"] = None
root = {str(ROOT)!r}
spec = importlib.util.spec_from_file_location(
    "framelet", root + "/__init__.py", submodule_search_locations=[root]
)
package = importlib.util.module_from_spec(spec)
sys.modules["framelet"] = package
spec.loader.exec_module(package)
from framelet.operators.command_line import main
sys.exit(main())
"""


def start(*arguments, **options):
    """Start the command line in a Python that has no Blender."""
    words = [sys.executable, "-c", PROGRAM, *map(os.fspath, arguments)]
    return subprocess.Popen(words, **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options})


@pytest.fixture
def source(tmp_path):
    """A good file."""
    path = tmp_path / "in.ply"
    path.write_bytes(full_ply("binary_little_endian")[0])
    return path


def names(folder):
    """Return the names in a folder."""
    return sorted(path.name for path in folder.iterdir())


def test_without_blender(source, tmp_path):
    process = start("denoise", source, tmp_path / "out.ply", "--report", tmp_path / "r.json", *QUICK)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, b"")
    assert out.splitlines()[-1] == f"Wrote {tmp_path / 'out.ply'} and {tmp_path / 'r.json'}.".encode()
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["blender"] is None and report["error"] is None
    assert report["objects"][0]["name"] == "in"


@pytest.mark.parametrize(
    ("words", "frame"),
    [
        ((), ""),
        (("--preset", "positions"), "ADAPTIVE"),  # the file has polygons
        (("--preset", "tri-2"), "BOX_SPLINE_111"),
        (("--preset", "tri-2", "--stencil", "adaptive"), "ADAPTIVE"),
    ],
)
def test_the_report_names_the_frame_that_ran(command, source, tmp_path, words, frame):
    assert command("denoise", source, tmp_path / "out.ply", *words, "--report", tmp_path / "r.json").code == 0
    assert json.loads((tmp_path / "r.json").read_text())["objects"][0]["frame"] == frame


def test_a_file_for_blender_alone_is_refused_without_it(tmp_path):
    (tmp_path / "in.blend").write_bytes(b"BLENDER")
    process = start("denoise", tmp_path / "in.blend", tmp_path / "out.ply")
    _out, err = process.communicate(timeout=60)
    assert process.returncode == 1 and b"pip install bpy" in err and err.count(b"\n") == 1
    assert names(tmp_path) == ["in.blend"]


def test_out_that_is_in_is_refused(fails, command, source, tmp_path):
    before = source.read_bytes()
    (tmp_path / "link.ply").symlink_to("in.ply")
    for target in (source, tmp_path / "link.ply", tmp_path / "." / "in.ply"):
        assert "add --in-place" in fails("denoise", source, target, *QUICK, code=2)
    assert "There is no OUT" in fails("denoise", source, code=2)
    assert "no effect without --in-place" in fails("denoise", source, tmp_path / "o.ply", "--backup", code=2)
    assert source.read_bytes() == before
    result = command("denoise", source, "--in-place", "--backup", *QUICK)
    assert result.code == 0
    assert result.out.endswith(f"Wrote {source}. What was there is in {source}.bak.\n")
    assert source.read_bytes() != before
    assert (tmp_path / "in.ply.bak").read_bytes() == before
    assert names(tmp_path) == ["in.ply", "in.ply.bak", "link.ply"]


def test_in_place_with_buffers(command, tmp_path):
    data, buffer = full_gltf("separate")
    (tmp_path / "in.gltf").write_bytes(data)
    (tmp_path / "sheet data.bin").write_bytes(buffer)
    result = command("denoise", tmp_path / "in.gltf", "--in-place", "--backup", *QUICK)
    assert result.code == 0, result.err
    assert names(tmp_path) == ["in.gltf", "in.gltf.bak", "sheet data.bin", "sheet data.bin.bak"]
    assert (
        (tmp_path / "sheet data.bin.bak").read_bytes() == buffer != (tmp_path / "sheet data.bin").read_bytes()
    )


def test_buffers_of_others_are_not_overwritten(command, fails, tmp_path):
    data, buffer = full_gltf("separate")
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (tmp_path / "in.gltf").write_bytes(data)
    (tmp_path / "sheet data.bin").write_bytes(buffer)
    (tmp_path / "my texture.png").write_bytes(b"picture")
    assert command("denoise", tmp_path / "in.gltf", folder / "out.gltf", *QUICK).code == 0
    assert names(folder) == ["my texture.png", "out.gltf", "sheet data.bin"]
    assert (folder / "my texture.png").read_bytes() == b"picture"
    # Again: these are the file's own. But those of another file are not.
    assert command("denoise", tmp_path / "in.gltf", folder / "out.gltf", *QUICK).code == 0
    assert command("denoise", tmp_path / "in.gltf", folder / "other.gltf", *QUICK).code == 0
    assert names(folder) == ["my texture.png", "other.bin", "other.gltf", "out.gltf", "sheet data.bin"]
    (folder / "third.bin").write_bytes(b"precious")
    assert "would be overwritten" in fails("denoise", tmp_path / "in.gltf", folder / "third.gltf", *QUICK)
    assert (folder / "third.bin").read_bytes() == b"precious" and not (folder / "third.gltf").exists()


def test_materials_and_textures_go_along(command, tmp_path):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (tmp_path / "in.obj").write_bytes(full_obj())
    (tmp_path / "my materials.mtl").write_text(
        "newmtl A\nmap_Kd -s 1 1 1 tex/tile 1.png\nmap_Ks /far/away.png\n"
    )
    (tmp_path / "tex").mkdir()
    (tmp_path / "tex" / "tile 1.png").write_bytes(b"picture")
    assert command("denoise", tmp_path / "in.obj", folder / "out.obj", *QUICK).code == 0
    assert names(folder) == ["my materials.mtl", "out.obj", "tex"]
    assert (folder / "tex" / "tile 1.png").read_bytes() == b"picture"
    (folder / "my materials.mtl").write_text("another")
    result = command("denoise", tmp_path / "in.obj", folder / "out.obj", *QUICK)
    assert "is another file than" in result.err and "was left alone" in result.err
    assert (folder / "my materials.mtl").read_text() == "another"


def test_of_names_with_spaces_the_whole_one_counts(command, tmp_path):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (tmp_path / "in.obj").write_bytes(full_obj())
    (tmp_path / "my materials.mtl").write_text("newmtl A\nmap_Kd tile 1.png\n")
    for name in ("tile 1.png", "1.png"):
        (tmp_path / name).write_bytes(b"picture")
    assert command("denoise", tmp_path / "in.obj", folder / "out.obj", *QUICK).code == 0
    assert names(folder) == ["my materials.mtl", "out.obj", "tile 1.png"]


def test_several_material_files_and_textures_of_a_ply_go_along(command, tmp_path):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (tmp_path / "in.obj").write_bytes(full_obj().replace(b"mtllib my materials.mtl", b"mtllib a.mtl b.mtl"))
    for name in ("a", "b"):
        (tmp_path / f"{name}.mtl").write_text(f"newmtl {name}\nmap_Kd {name}.png\n")
        (tmp_path / f"{name}.png").write_bytes(b"picture")
    assert command("denoise", tmp_path / "in.obj", folder / "out.obj", *QUICK).code == 0
    assert names(folder) == ["a.mtl", "a.png", "b.mtl", "b.png", "out.obj"]
    (tmp_path / "in.ply").write_bytes(full_ply("ascii")[0])
    (tmp_path / "my texture.png").write_bytes(b"picture")
    assert command("denoise", tmp_path / "in.ply", folder / "out.ply", *QUICK).code == 0
    assert (folder / "my texture.png").read_bytes() == b"picture"


def test_stale_normals_are_told(command, tmp_path):
    (tmp_path / "in.obj").write_bytes(full_obj())
    result = command("denoise", tmp_path / "in.obj", tmp_path / "out.obj", *QUICK)
    assert "keeps its normals, which are those of the noisy surface" in result.err


def test_groups_of_an_obj_limit_a_run(command, fails, tmp_path):
    (tmp_path / "in.obj").write_bytes(full_obj())
    words = ["denoise", tmp_path / "in.obj", tmp_path / "out.obj", *QUICK]
    assert command(*words, "--vertex-group", "first").code == 0
    before, after = open_file(tmp_path / "in.obj"), open_file(tmp_path / "out.obj")
    moved = (before.positions != after.positions).any(axis=1)
    assert 0 < moved.sum() < len(moved)
    assert not moved[before.weights("first") == 0].any()


def test_several_objects_are_denoised_by_themselves(command, tmp_path):
    points, faces = sheet()
    lines = []
    for number, name in enumerate(("Zebra", "Ape")):
        lines.append(f"o {name}")
        lines += ["v " + " ".join(f"{v:.6f}" for v in point) for point in points * (1 + 9 * number)]
        lines += ["f " + " ".join(map(str, face)) for face in faces + 1 + number * len(points)]
    (tmp_path / "in.obj").write_text("\n".join(lines))
    result = command("denoise", tmp_path / "in.obj", tmp_path / "out.obj", *QUICK)
    assert "in 2 objects" in result.out
    assert "Denoised Zebra" in result.out and "Denoised Ape" in result.out
    after = open_file(tmp_path / "out.obj").positions
    np.testing.assert_allclose(after[len(points) :], 10 * after[: len(points)], atol=1e-3)


def test_nan_is_refused(fails, tmp_path):
    data = full_ply("ascii")[0].split(b"\r\n")
    at = data.index(b"end_header") + 3
    words = data[at].split()
    words[1] = b"nan"
    data[at] = b" ".join(words)
    (tmp_path / "in.ply").write_bytes(b"\r\n".join(data))
    sentence = fails("denoise", tmp_path / "in.ply", tmp_path / "out.ply")
    assert "is not a finite point" in sentence and not (tmp_path / "out.ply").exists()


@pytest.mark.parametrize("failure", ["missing", "damaged", "interrupt", "memory", "disk"])
def test_a_report_says_why_a_run_failed(command, source, tmp_path, monkeypatch, failure):
    from framelet import core

    report = tmp_path / "r.json"
    target = tmp_path / "out.ply"
    code = 1
    if failure == "missing":
        source.unlink()
    elif failure == "damaged":
        source.write_bytes(source.read_bytes()[:-3000])
    elif failure == "disk":
        write = safe_write.Outputs.write

        def full(outputs, path, data):
            if path == target:
                raise safe_write.FileError("The disk is full.")
            write(outputs, path, data)

        monkeypatch.setattr(safe_write.Outputs, "write", full)
    else:
        error = KeyboardInterrupt if failure == "interrupt" else MemoryError
        code = 130 if failure == "interrupt" else 1

        def fail(*_arguments, **_options):
            raise error

        monkeypatch.setattr(core, "denoise", fail)
    result = command("denoise", source, target, "--report", report, *QUICK)
    assert result.code == code and result.err.count("\n") == 1
    content = json.loads(report.read_text())
    assert result.err == f"framelet: {content['error']}\n"
    assert not target.exists() and content["objects"] == []


def test_an_interrupt_after_publishing_does_not_lie(command, source, tmp_path, monkeypatch):
    replace = os.replace

    def replace_and_interrupt(old, new):
        replace(old, new)
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", replace_and_interrupt)
    words = ["denoise", source, tmp_path / "out.ply", "--report", tmp_path / "r.json", *QUICK]
    result = command(*words, "--quiet")
    monkeypatch.undo()
    assert result.code == 130
    assert (
        result.err
        == f"framelet: Interrupted; {tmp_path / 'out.ply'}, {tmp_path / 'r.json'} had been written.\n"
    )
    assert (tmp_path / "out.ply").exists()


def test_a_full_disk_keeps_the_only_copy(command, source, monkeypatch):
    before = source.read_bytes()

    def fail(_number):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(safe_write.os, "fsync", fail)
    result = command("denoise", source, "--in-place", *QUICK)
    assert result.code == 1 and "could not be written: No space left on device" in result.err
    assert source.read_bytes() == before and names(source.parent) == ["in.ply"]


@contextmanager
def as_handled(number, action):
    """Start processes with an action for a signal, which they inherit: `nohup` has hangups ignored."""
    before = signal.signal(number, action)
    try:
        yield
    finally:
        signal.signal(number, before)


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_a_hangup_that_is_ignored_ends_nothing(source, tmp_path):
    with as_handled(signal.SIGHUP, signal.SIG_IGN):
        process = start("denoise", source, tmp_path / "out.ply", *QUICK)
    process.stdout.readline()
    process.send_signal(signal.SIGHUP)
    _out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, b"") and (tmp_path / "out.ply").exists()


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGHUP, 129)]
)
def test_signals_clean_up(tmp_path, number, code):
    n = 400
    points, faces = sheet(n=n)
    source = tmp_path / "in.obj"
    source.write_bytes(
        (b"v %f %f %f\n" * len(points)) % tuple(points.ravel().tolist())
        + (b"f %d %d %d\n" * len(faces)) % tuple((faces + 1).ravel().tolist())
    )
    words = ["denoise", source, tmp_path / "out.obj", "--report", tmp_path / "r.json", "--passes", "6"]
    with as_handled(number, signal.SIG_DFL):
        process = start(*words)
    assert process.stdout.readline().startswith(b"Read ")
    time.sleep(0.3)
    process.send_signal(number)
    _out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (code, b"framelet: Interrupted; nothing was written.\n")
    assert names(tmp_path) == ["in.obj", "r.json"]


@pytest.mark.skipif(os.name == "nt", reason="names and devices of Unix")
def test_names_and_streams_that_are_odd(source, tmp_path):
    long = "x" * 300 + ".ply"
    loop = tmp_path / "loop.ply"
    loop.symlink_to("loop.ply")
    bytes_name = os.fsencode(tmp_path) + b"/a\xe9.ply"
    shutil.copy(source, bytes_name)
    for words, code in (
        ([tmp_path / long, tmp_path / "o.ply"], 1),
        ([source, tmp_path / long], 1),
        ([source, tmp_path / "o.ply", "--report", tmp_path / ("x" * 300 + ".json")], 1),
        ([source, loop, "--report", tmp_path / "r.json"], 1),
        ([bytes_name, tmp_path / "o.ply", "--report", tmp_path / "r.json"], 0),
    ):
        process = start("denoise", *words, "--quiet", *QUICK)
        _out, err = process.communicate(timeout=60)
        assert process.returncode == code, err
        assert err.count(b"\n") == (code != 0) and b"Traceback" not in err
    assert json.loads((tmp_path / "r.json").read_text("utf-8"))["input"].endswith("a\udce9.ply")
    (tmp_path / "o.ply").unlink()
    with open("/dev/full", "wb") as full:
        process = start("denoise", source, tmp_path / "o.ply", *QUICK, stdout=full)
        _out, err = process.communicate(timeout=60)
    assert process.returncode == 1 and b"could not be printed: No space left" in err
    assert err.count(b"\n") == 1 and (tmp_path / "o.ply").exists()


@pytest.mark.skipif(os.name == "nt", reason="streams of Unix")
def test_closed_streams(source, tmp_path):
    for number in (1, 2):
        process = start(
            "denoise",
            source,
            tmp_path / f"{number}.ply",
            *QUICK,
            preexec_fn=lambda number=number: os.close(number),
        )
        out, err = process.communicate(timeout=60)
        assert process.returncode == 0 and b"Traceback" not in out + err
        assert len(open_file(tmp_path / f"{number}.ply").positions) == len(open_file(source).positions)
    assert names(tmp_path) == ["1.ply", "2.ply", "in.ply"]


def test_bands_and_equalize_without_blender(command, source, tmp_path):
    (tmp_path / "in.glb").write_bytes(full_gltf("glb")[0])
    for name in ("in.ply", "in.glb"):
        result = command("bands", tmp_path / name, "--out", tmp_path / f"{name}.npz")
        assert result.code == 0, result.err
        with np.load(tmp_path / f"{name}.npz", allow_pickle=False) as arrays:
            assert np.abs(arrays["L1"]).max() > 0.01
        target = tmp_path / f"out-{name}"
        assert command("equalize", tmp_path / name, target, "--gains", "0").code == 0
        assert target.stat().st_size > 0 and target.read_bytes() != (tmp_path / name).read_bytes()
    # Vertices that the format had to split stay together.
    before, after = open_file(tmp_path / "in.glb"), open_file(tmp_path / "out-in.glb")
    n_places = len(np.unique(before.positions, axis=0))
    assert n_places < len(before.positions) and len(np.unique(after.positions, axis=0)) == n_places


@pytest.mark.parametrize(("coordinate", "is_coarse"), [("float", True), ("double", False)])
def test_coarse_positions_are_told(command, tmp_path, coordinate, is_coarse):
    points, faces = sheet()
    kind = "f4" if coordinate == "float" else "f8"
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty {coordinate} x\n"
        f"property {coordinate} y\nproperty {coordinate} z\nelement face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    rows = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", 3)])
    rows["n"], rows["v"] = 3, faces
    (tmp_path / "in.ply").write_bytes(head.encode() + (points + 3e6).astype(kind).tobytes() + rows.tobytes())
    result = command("denoise", tmp_path / "in.ply", tmp_path / "out.ply", *QUICK)
    assert result.code == 0
    assert ("in steps of 0.2" in result.err) == is_coarse
