# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Files appear whole or not at all, whatever happens meanwhile."""

import errno
import os
import signal
import stat
import subprocess
import sys
import threading

import pytest
from framelet.operators.files import FileError, safe_write
from framelet.operators.files.safe_write import Outputs, check_target
from framelet.operators.files.signals import Interrupted


def names(folder):
    """Return the names in a folder."""
    return sorted(path.name for path in folder.iterdir())


def test_nothing_is_seen_before_it_is_published(tmp_path):
    target = tmp_path / "out.ply"
    target.write_text("old")
    with Outputs() as outputs:
        outputs.write(target, b"new")
        assert target.read_text() == "old"
        assert outputs.publish() == [target]
        assert target.read_text() == "new"
    assert names(tmp_path) == ["out.ply"]


def test_an_error_leaves_no_trace(tmp_path):
    with pytest.raises(KeyError), Outputs() as outputs:
        outputs.write(tmp_path / "out.ply", b"new")
        raise KeyError
    assert names(tmp_path) == []


def test_mode_links_and_backups(tmp_path):
    real, link = tmp_path / "real.ply", tmp_path / "link.ply"
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to("real.ply")
    with Outputs() as outputs:
        outputs.write(link, b"new")
        (backup,) = outputs.keep_backups()
        outputs.publish()
    assert link.is_symlink() and real.read_text() == "new"
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert backup == tmp_path / "real.ply.bak" and backup.read_text() == "old"
    with Outputs() as outputs:
        outputs.write(real, b"newer")
        assert outputs.keep_backups() == [tmp_path / "real.ply.bak2"]
        outputs.publish()
    assert backup.read_text() == "old"


def test_a_dangling_link_gets_its_target(tmp_path):
    (tmp_path / "link.ply").symlink_to("real.ply")
    check_target(tmp_path / "link.ply")
    with Outputs() as outputs:
        outputs.write(tmp_path / "link.ply", b"new")
        outputs.publish()
    assert (tmp_path / "link.ply").is_symlink() and (tmp_path / "real.ply").read_bytes() == b"new"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_written_to_and_stays(tmp_path):
    pipe = tmp_path / "pipe.ply"
    os.mkfifo(pipe)
    found = []
    reader = threading.Thread(target=lambda: found.append(pipe.read_bytes()))
    reader.start()
    check_target(pipe)
    with Outputs() as outputs:
        outputs.write(pipe, b"through")
        outputs.publish()
    reader.join(10)
    assert found == [b"through"] and stat.S_ISFIFO(pipe.stat().st_mode)


@pytest.mark.parametrize("call", ["fsync", "replace", "open"])
def test_a_full_disk(tmp_path, monkeypatch, call):
    target = tmp_path / "out.ply"
    target.write_text("precious")

    def fail(*_arguments, **_options):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    if call == "open":
        monkeypatch.setattr(safe_write.Path, "open", fail)
    else:
        monkeypatch.setattr(safe_write.os, call, fail)
    with pytest.raises(FileError, match=r"could not be written: No space left"), Outputs() as outputs:
        outputs.write(target, b"new")
        outputs.publish()
    monkeypatch.undo()
    assert target.read_text() == "precious" and names(tmp_path) == ["out.ply"]


def test_what_cannot_be_read_again_is_not_published(tmp_path, monkeypatch):
    target = tmp_path / "out.ply"
    target.write_text("precious")
    monkeypatch.setattr(safe_write.os, "fsync", lambda number: os.ftruncate(number, 3))
    with pytest.raises(FileError, match="cannot be read again"), Outputs() as outputs:
        outputs.write(target, b"longer")
    assert target.read_text() == "precious"


@pytest.mark.skipif(sys.platform != "linux" or os.geteuid() != 0, reason="mounts a small disk")
def test_a_disk_that_is_really_full(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip("mounting is not allowed here")
    try:
        target = disk / "out.ply"
        target.write_bytes(b"precious")
        with pytest.raises(FileError, match="No space left"), Outputs() as outputs:
            outputs.write(target, bytes(200_000))
        assert target.read_bytes() == b"precious" and names(disk) == ["out.ply"]
    finally:
        subprocess.run(["umount", disk], check=False)


def test_an_interrupt_between_two_files(tmp_path, monkeypatch):
    replace = os.replace
    first, second = tmp_path / "a.ply", tmp_path / "b.json"

    def replace_and_interrupt(source, target):
        replace(source, target)
        if str(target) == str(first):
            raise KeyboardInterrupt

    monkeypatch.setattr(safe_write.os, "replace", replace_and_interrupt)
    with pytest.raises(Interrupted) as caught, Outputs() as outputs:
        outputs.write(first, b"mesh")
        outputs.write(second, b"report")
        outputs.publish()
    assert caught.value.published == [first, second] and caught.value.exit_code == 130
    assert names(tmp_path) == ["a.ply", "b.json"]


def test_a_signal_between_two_files(tmp_path, monkeypatch):
    """Both are in place before it counts, and it is the code that shells know it by."""
    replace = os.replace

    def replace_and_end(source, target):
        replace(source, target)
        if str(target) == str(tmp_path / "a.ply"):
            os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr(safe_write.os, "replace", replace_and_end)
    with pytest.raises(Interrupted) as caught, Outputs() as outputs:
        outputs.write(tmp_path / "a.ply", b"mesh")
        outputs.write(tmp_path / "b.json", b"report")
        outputs.publish()
    assert caught.value.published == [tmp_path / "a.ply", tmp_path / "b.json"]
    assert caught.value.exit_code == 128 + signal.SIGTERM and names(tmp_path) == ["a.ply", "b.json"]


def test_a_backup_that_cannot_be_kept_stops_before_anything_is_replaced(tmp_path, monkeypatch):
    def full(*_paths):
        raise OSError(errno.ENOSPC, "No space left on device")

    (tmp_path / "a.ply").write_bytes(b"precious")
    monkeypatch.setattr(safe_write.os, "link", full)
    monkeypatch.setattr(safe_write.shutil, "copy2", full)
    with (
        pytest.raises(FileError, match=r"The backup .*a\.ply\.bak could not be written"),
        Outputs() as outputs,
    ):
        outputs.write(tmp_path / "a.ply", b"new")
        outputs.keep_backups()
        outputs.publish()
    assert (tmp_path / "a.ply").read_bytes() == b"precious" and names(tmp_path) == ["a.ply"]


def test_leftovers_of_dead_runs_are_removed(tmp_path):
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    host = safe_write._host()
    dead = tmp_path / f".framelet-{host}_{process.pid}_0123abcd"
    alive = tmp_path / f".framelet-{host}_{os.getpid()}_0123abcd"
    elsewhere = tmp_path / f".framelet-{host}x_{process.pid}_0123abcd"
    for folder in (dead, alive, elsewhere):
        folder.mkdir()
        (folder / "out.ply").write_text("half")
    (tmp_path / f".framelet-{host}_{process.pid}_0123abcd.blend").write_text("half")
    (tmp_path / ".framelet-mine").mkdir()
    with Outputs() as outputs:
        outputs.write(tmp_path / "out.ply", b"new")
    assert names(tmp_path) == sorted([".framelet-mine", alive.name, elsewhere.name])


def test_targets_that_cannot_be_written(tmp_path):
    (tmp_path / "loop.ply").symlink_to("loop.ply")
    (tmp_path / "folder.ply").mkdir()
    for target, message in (
        (tmp_path / "loop.ply", "cannot be written: Too many levels"),
        (tmp_path / ("x" * 300 + ".ply"), "cannot be written: File name too long"),
        (tmp_path / "none" / "out.ply", "does not exist; make it first"),
        (tmp_path / "folder.ply", "is a folder"),
    ):
        with pytest.raises(FileError, match=message):
            check_target(target)
