# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A batch in processes of this computer that Dask starts, some of which die."""

import os
import signal
import sys
import time
from pathlib import Path

import pytest
from framelet.operators.command_line import main
from framelet.operators.farm.dask_farm import on_this_computer
from framelet.tests.batch import dying

from .conftest import obj, rows_of, run, start, state_of

PROC = Path("/proc")
needs_proc = pytest.mark.skipif(not PROC.is_dir(), reason="needs /proc to find the processes of a batch")


@pytest.fixture(autouse=True)
def dask():
    """Skip what needs Dask where it is missing."""
    pytest.importorskip("distributed", reason="Dask distributed is not installed (framelet[farm])")


def test_without_dask_one_file_at_a_time(scans, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    out = tmp_path / "out"
    assert main(["batch", str(scans), "--out", str(out), "--jobs", "2", "--preset", "tri-2"]) == 0
    said = capsys.readouterr()
    assert "one file is worked on at a time" in said.err and "pip install distributed" in said.err
    assert len(rows_of(out / "report.jsonl")) == 6


def test_jobs_give_the_same(scans, tmp_path):
    (scans / "empty.obj").touch()
    run("batch", scans, "--out", tmp_path / "serial", code=1)
    out, err = run("batch", scans, "--out", tmp_path / "jobs", "--jobs", "2", code=1)
    assert state_of(tmp_path / "serial") == state_of(tmp_path / "jobs")
    # Dask itself says nothing.
    assert len(out.splitlines()) == 6 and len(err.splitlines()) == 2


def test_a_process_that_dies_takes_only_its_file_along(tmp_path):
    log = tmp_path / "log"
    killers, onces = ["killer-1", "killer-2"], ["once-1", "once-2"]
    # Killers beside each other and one after the other, so that a file that is tried again meets others.
    names = ["killer-1", "killer-2", *"abcdef", "broken", "once-1", *"ghi", "once-2"]
    jobs = [{"source": name, "log": str(log)} for name in names]
    with on_this_computer(2, {}) as farm:
        found = [(job["source"], row) for job, row in farm.results(jobs, "tests.batch.dying:carry_out")]
    assert sorted(name for name, _row in found) == sorted(names)
    rows, begun = dict(found), log.read_text().split()
    assert {name: begun.count(name) for name in names} == {
        name: 2 if name in (*killers, *onces) else 1 for name in names
    }
    assert all(f"{name} died, 2 times" in rows[name]["error"] for name in killers)
    assert "broken could not be worked on: RuntimeError: no such thing." in rows["broken"]["error"]
    others = set(names) - {*killers, "broken"}
    assert all(rows[name]["did"] == name for name in others)
    assert os.getpid() not in {rows[name]["pid"] for name in others}


@pytest.mark.parametrize("others", [("once-1", "once-2"), ("killer",)])
def test_a_file_that_waits_for_others_is_not_to_blame_for_deaths(tmp_path, others):
    log = str(tmp_path / "log")
    with on_this_computer(1, {}) as farm:
        # Another batch on this scheduler takes the only process along, two times or four.
        futures = [
            farm.client.submit(dying.carry_out, {"source": name, "log": log, "seconds": 2}, pure=False)
            for name in others
        ]
        ((_job, row),) = farm.results([{"source": "a", "log": log}], "tests.batch.dying:carry_out")
        assert [future.exception() is None for future in futures] == [others != ("killer",)] * len(others)
    begun = Path(log).read_text().split()
    if others == ("killer",):
        assert row == {
            "error": "4 processes that a was handed to died before they began it; see what the workers of "
            "Dask say."
        }
        assert begun == ["killer"] * 4
    else:
        assert row["did"] == "a"
        assert begun.count("a") == 1 and begun.count("once-2") == 2


@needs_proc
def test_workers_end_with_the_batch(tmp_path):
    for number in range(4):
        (tmp_path / f"{number}.obj").write_text(obj(number, 100))
    process = start("batch", f"{tmp_path}/*.obj", "--out", tmp_path / "out", "--jobs", "2")
    process.stdout.readline()
    children = _below(process.pid)
    assert len(children) >= 2
    process.kill()
    process.communicate()
    _wait_for(lambda: not any(map(_runs, children)))


@needs_proc
def test_ctrl_c_ends_all_and_says_one_sentence(tmp_path):
    for number in range(8):
        (tmp_path / f"{number}.obj").write_text(obj(number, 60))
    words = ("batch", f"{tmp_path}/*.obj", "--out", tmp_path / "out", "--jobs", "2")
    process = start(*words, start_new_session=True)
    process.stdout.readline()
    children = _below(process.pid)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _out, err = process.communicate(timeout=600)
    assert process.returncode == 130
    assert err == "framelet: Interrupted; nothing was written.\n" or "had been written" in err
    _wait_for(lambda: not any(map(_runs, children)))
    run("batch", f"{tmp_path}/*.obj", "--out", tmp_path / "out")
    assert {row["output"] for row in rows_of(tmp_path / "out" / "report.jsonl")} == {
        f"{number}.obj" for number in range(8)
    }


def _below(pid):
    """Return all processes that a process started, and those that they started."""
    found = []
    for task in PROC.glob(f"{pid}/task/*/children"):
        for child in map(int, task.read_text().split()):
            found += [child, *_below(child)]
    return found


def _runs(pid):
    try:
        return (PROC / str(pid) / "stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def _wait_for(condition):
    for _ in range(600):
        if condition():
            return
        time.sleep(0.02)
    raise AssertionError("it did not happen")
