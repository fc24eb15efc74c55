# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Batches whose processes are killed at any moment."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from framelet.operators.batch.workers import Workers

from .conftest import obj, rows_of, run, start, state_of

KILLS = int(os.environ.get("FRAMELET_KILLS", "4"))

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no SIGKILL")

WORKER = """
import json, os, sys, time
for line in sys.stdin:
    job = json.loads(line)
    with open(job["log"], "a") as file:
        file.write(job["source"] + "\\n")
    if job["source"] == "killer" or (job["source"] == "once" and not os.path.exists(job["log"] + ".once")):
        open(job["log"] + ".once", "w").close()
        os.kill(os.getpid(), 9)
    print("\\x1eframelet-row " + json.dumps({"did": job["source"]}), flush=True)
"""


def test_killed_at_random_moments(tmp_path):
    scans = tmp_path / "scans"
    scans.mkdir()
    for number in range(12):
        (scans / f"{number}.obj").write_text(obj(number, 20))
    words = ("batch", scans, "--jobs", "2", "--out")
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


def test_jobs_give_the_same(scans, tmp_path):
    for number in (1, 3):
        run("batch", scans, "--out", tmp_path / str(number), "--jobs", str(number))
    assert state_of(tmp_path / "1") == state_of(tmp_path / "3")


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="needs /proc to find the processes of a batch")
def test_workers_end_with_the_batch(tmp_path):
    (tmp_path / "large.obj").write_text(obj(1, 150))
    process = start("batch", tmp_path / "large.obj", "--out", tmp_path / "out")
    children = _wait_for(lambda: _children(process.pid))
    process.kill()
    process.communicate()
    assert _wait_for(lambda: not any(map(_runs, children)))
    assert not (tmp_path / "out" / "large.obj").exists()


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="needs /proc to find the processes of a batch")
def test_a_worker_that_is_killed_once_loses_nothing(tmp_path):
    (tmp_path / "large.obj").write_text(obj(1, 100))
    process = start("batch", tmp_path / "large.obj", "--out", tmp_path / "out")
    (child,) = _wait_for(lambda: _children(process.pid))
    os.kill(child, signal.SIGKILL)
    process.communicate(timeout=60)
    assert process.returncode == 0
    (row,) = rows_of(tmp_path / "out" / "report.jsonl")
    assert (row["status"], row["attempts"]) == ("done", 2)


def test_interrupted_from_the_keyboard(tmp_path):
    for number in range(8):
        (tmp_path / f"{number}.obj").write_text(obj(number, 60))
    process = start("batch", f"{tmp_path}/*.obj", "--out", tmp_path / "out", stdout=subprocess.PIPE)
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    _out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in err and "Interrupted" in err
    n_rows = len(rows_of(tmp_path / "out" / "report.jsonl"))
    assert 0 < n_rows < 8
    run("batch", f"{tmp_path}/*.obj", "--out", tmp_path / "out")
    assert len(rows_of(tmp_path / "out" / "report.jsonl")) == 8


def test_a_process_that_dies_takes_only_its_file_along(tmp_path):
    log = str(tmp_path / "log")
    jobs = [{"source": name, "log": log} for name in ("a", "killer", "b", "once", "c")]
    with Workers(2, {}, [sys.executable, "-c", WORKER]) as workers:
        rows = {job["source"]: row for job, row in workers.run(jobs)}
    assert {name: row.get("did") for name, row in rows.items()} == {
        "a": "a", "b": "b", "c": "c", "once": "once", "killer": None,
    }  # fmt: skip
    assert rows["killer"]["attempts"] == 2 and "was killed by SIGKILL, 2 times" in rows["killer"]["error"]
    assert rows["once"]["attempts"] == 2 or Path(log).read_text().split().count("once") == 1
    assert Path(log).read_text().split().count("killer") == 2


def test_a_process_that_cannot_start_says_why():
    with Workers(1, {}, [sys.executable, "-c", "raise SystemError('no NumPy')"]) as workers:
        ((_job, row),) = workers.run([{"source": "a.ply"}])
    assert "a.ply ended with exit code 1 (SystemError: no NumPy)" in row["error"]


def _children(pid):
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        found += map(int, task.read_text().split())
    return found


def _runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def _wait_for(condition):
    for _ in range(300):
        found = condition()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError("it did not happen")
