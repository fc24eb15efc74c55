# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Batches whose processes are killed at any moment."""

import json
import os
import random
import signal
import subprocess
import time

import pytest
from framelet.operators.command_line import main

from .conftest import obj, rows_of, run, start, state_of

KILLS = int(os.environ.get("FRAMELET_KILLS", "20"))

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no SIGKILL")


def test_killed_at_random_moments(tmp_path):
    scans = tmp_path / "scans"
    scans.mkdir()
    for number in range(12):
        (scans / f"{number}.obj").write_text(obj(number, 20))
    # A quick preset: more of the time is spent between files, where a kill could do harm.
    words = ("batch", scans, "--preset", "tri-2", "--out")
    begun = time.monotonic()
    run(*words, tmp_path / "whole")
    whole, seconds = state_of(tmp_path / "whole"), time.monotonic() - begun
    assert len(whole[0]) == len(whole[1]) == 12
    moments = random.Random(16)
    n_rounds, n_cut_off, n_kills = 0, 0, 0
    while n_kills < KILLS:
        out = tmp_path / f"cut{n_rounds}"
        n_rounds += 1
        for _ in range(min(4, KILLS - n_kills)):
            process = start(*words, out)
            # Some files later, and anywhere within the next one: or most moments would be before the work.
            for _ in range(moments.randrange(4)):
                process.stdout.readline()
            time.sleep(moments.uniform(0.0, 0.3) * seconds)
            process.kill()
            process.communicate()
            n_kills += 1
            report = out / "report.jsonl"
            n_cut_off += report.exists() and 0 < len(report.read_bytes().splitlines()) < 12
        run(*words, out)
        assert state_of(out) == whole
        assert sorted(p.name for p in out.iterdir() if p.name.startswith(".framelet")) == []
    assert n_cut_off  # in the middle of the work


def test_a_power_cut_finds_rows_of_what_is_on_the_disk_only(scans, tmp_path, monkeypatch):
    """Each result is on the disk before it has its name, and has its name there before it has a row."""
    out = tmp_path / "out"
    synced, written, events = set(), {}, []
    fsync, replace, write = os.fsync, os.replace, os.write

    def watched_fsync(number):
        fsync(number)
        synced.add(os.fstat(number).st_ino)

    def watched_replace(source, target):
        assert os.stat(source).st_ino in synced, f"{source} may not be on the disk"
        replace(source, target)
        synced.discard(os.stat(os.path.dirname(target)).st_ino)
        events.append(os.path.relpath(target, out))

    def watched_write(number, data):
        text = bytes(data)
        if text.startswith(b"{") and b'"output"' in text:
            name = json.loads(text)["output"]
            assert name in events and os.stat((out / name).parent).st_ino in synced
            assert all(number in synced for number in written.values())
            written[name] = os.fstat(number).st_ino
            synced.discard(written[name])
        return write(number, data)

    for name, function in (("fsync", watched_fsync), ("replace", watched_replace), ("write", watched_write)):
        monkeypatch.setattr(os, name, function)
    assert main(["batch", str(scans), "--out", str(out), "--preset", "tri-2"]) == 0
    assert sorted(written) == sorted(events) and len(events) == 6
    assert all(number in synced for number in written.values())


def test_a_result_whose_row_was_not_written_is_its_own(scans, tmp_path):
    out = tmp_path / "out"
    run("batch", scans, "--out", out)
    whole = state_of(out)
    report = out / "report.jsonl"
    lines = report.read_bytes().splitlines(keepends=True)
    # Killed as the last row was written, after its result.
    report.write_bytes(b"".join(lines[:-1]) + lines[-1][:100])
    (out / "report.jsonl.begun").write_text("\n" + '"left/1.obj"' + '\n"left')
    run("batch", scans, "--out", out)
    assert state_of(out) == whole
    assert not (out / "report.jsonl.begun").exists()


def test_a_result_of_a_slice_that_was_killed_before_its_row_is_known_to_the_whole(scans, tmp_path):
    out, words = tmp_path / "out", (str(scans), "--preset", "tri-2")
    assert main(["batch", *words, "--out", str(out), "--slice", "1/2"]) == 0
    report = out / "report-1-of-2.jsonl"
    lines = report.read_bytes().splitlines(keepends=True)
    name = json.loads(lines[-1])["output"]
    report.write_bytes(b"".join(lines[:-1]))
    (out / "report-1-of-2.jsonl.begun").write_text("\n" + json.dumps(name))
    assert main(["batch", *words, "--out", str(out)]) == 0
    assert len(rows_of(out / "report.jsonl")) == 6 - len(lines) + 1


def test_interrupted_from_the_keyboard(tmp_path):
    for number in range(8):
        (tmp_path / f"{number}.obj").write_text(obj(number, 60))
    process = start("batch", f"{tmp_path}/*.obj", "--out", tmp_path / "out", stdout=subprocess.PIPE)
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    _out, err = process.communicate(timeout=600)
    assert process.returncode == 130
    assert "Traceback" not in err and "Interrupted" in err
    n_rows = len(rows_of(tmp_path / "out" / "report.jsonl"))
    assert 0 < n_rows < 8
    run("batch", f"{tmp_path}/*.obj", "--out", tmp_path / "out")
    assert len(rows_of(tmp_path / "out" / "report.jsonl")) == 8
