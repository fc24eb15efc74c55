# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Batches on disks that are full or read-only, and inputs that vanish: words, no traceback, and no loss."""

import os
import subprocess
import sys

import pytest

from .conftest import obj, rows_of, run, start, state_of

needs_mounts = pytest.mark.skipif(
    sys.platform != "linux" or os.geteuid() != 0, reason="mounts a small disk, which needs Linux and root"
)


@pytest.fixture
def disk(tmp_path):
    """Give a function that mounts a disk with these options; it is unmounted at the end."""
    folder = tmp_path / "disk"
    folder.mkdir()

    def mount(options):
        command = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder]
        if subprocess.run(command, capture_output=True, check=False).returncode:
            pytest.skip("mounting is not allowed here")
        return folder

    yield mount
    subprocess.run(["umount", folder], capture_output=True, check=False)


@needs_mounts
def test_a_disk_that_fills_up(scans, tmp_path, disk):
    """What was written before stays whole, the rest is said, and with room again the rest is done."""
    for number in range(4, 12):
        (scans / f"{number}.obj").write_text(obj(number, 20))
    run("batch", scans, "--out", tmp_path / "whole")
    whole = state_of(tmp_path / "whole")
    out = disk("size=64k") / "out"
    _, err = run("batch", scans, "--out", out, code=1)
    assert "Traceback" not in err and "No space left" in err, err
    for path in out.rglob("*.obj"):
        assert path.read_bytes() == whole[0][path.relative_to(out).as_posix()], path
    assert not [path.name for path in out.rglob(".framelet-*")]
    subprocess.run(["mount", "-o", "remount,size=10m", out.parent], check=True)
    run("batch", scans, "--out", out)
    assert state_of(out)[0] == whole[0]


@needs_mounts
def test_a_read_only_folder(scans, disk):
    folder = disk("size=1m")
    subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
    for out in (folder, folder / "out"):
        _, err = run("batch", scans, "--out", out, code=1)
        assert "Traceback" not in err and "Read-only file system" in err, err
        assert len(err.strip().splitlines()) <= 3, err


@needs_mounts
def test_a_folder_that_becomes_read_only(scans, disk):
    for number in range(4, 9):
        (scans / f"{number}.obj").write_text(obj(number, 60))
    folder = disk("size=10m")
    report = folder / "out" / "report.jsonl"
    run("batch", scans, "--out", folder / "out", "--limit", "2")
    before = report.read_bytes()
    subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
    _, err = run("batch", scans, "--out", folder / "out", code=1)
    assert "Traceback" not in err and "Read-only file system" in err, err
    assert report.read_bytes() == before
    subprocess.run(["mount", "-o", "remount,rw", folder], check=True)
    run("batch", scans, "--out", folder / "out")
    assert len(rows_of(report)) == 11


def test_inputs_that_vanish(scans, tmp_path):
    for number in range(4, 9):
        (scans / f"{number}.obj").write_text(obj(number, 60))
    process = start("batch", scans, "--out", tmp_path / "out")
    process.stdout.readline()
    (scans / "left" / "1.obj").unlink()
    _, err = process.communicate(timeout=120)
    assert process.returncode == 1 and "Traceback" not in err, err
    rows = {row["output"]: row for row in rows_of(tmp_path / "out" / "report.jsonl")}
    assert rows["left/1.obj"]["status"] == "failed" and "does not exist" in rows["left/1.obj"]["error"]
    assert [row["status"] for row in rows.values()].count("done") == 10
