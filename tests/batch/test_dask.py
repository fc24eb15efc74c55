# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch on a scheduler and two workers of Dask, one of which is killed on the way."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from framelet.operators.command_line import main

from .conftest import obj, rows_of, run, start, state_of

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = "import sys; from framelet.operators.command_line import main; sys.exit(main())"


def test_what_is_missing_is_said(scans, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    words = ("batch", str(scans), "--out", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:9")
    assert main(words) == 2
    assert "pip install distributed" in capsys.readouterr().err


@pytest.fixture
def farm(tmp_path):
    """A scheduler and two workers, which import Framelet as an installed package; address and processes."""
    pytest.importorskip("distributed", reason="Dask distributed is not installed")
    package = tmp_path / "path"
    package.mkdir()
    (package / "framelet").symlink_to(ROOT)
    environment = os.environ | {"PYTHONPATH": str(package), "PYTHONDONTWRITEBYTECODE": "1"}
    options = {"env": environment, "stderr": subprocess.PIPE, "text": True, "cwd": tmp_path}
    scheduler = subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0",
         "--no-dashboard"],
        **options,
    )  # fmt: skip
    processes = [scheduler]
    try:
        line = next(line for line in scheduler.stderr if "Scheduler at:" in line)
        address = line.split()[-1]
        for _ in range(2):
            processes.append(
                subprocess.Popen(
                    [sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1",
                     "--no-nanny", "--no-dashboard"],
                    **options | {"stderr": subprocess.DEVNULL},
                )
            )  # fmt: skip
        joined = (line for line in scheduler.stderr if "Register worker" in line)
        for _ in processes[1:]:
            next(joined)  # or the one that is killed might be the only one
        yield address, processes
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_two_workers_one_killed(farm, tmp_path):
    address, (_scheduler, first, _second) = farm
    scans, out = tmp_path / "scans", tmp_path / "out"
    scans.mkdir()
    for number in range(16):
        (scans / f"{number}.obj").write_text(obj(number, 20))
    (scans / "bad.obj").write_text("")
    command = [
        sys.executable, "-c", PROGRAM,
        "batch", str(scans), "--out", str(out), "--scheduler", address,
    ]  # fmt: skip
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "path")}
    process = subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path
    )
    for _ in range(3):
        process.stdout.readline()
    first.kill()
    first.wait()
    _out, err = process.communicate(timeout=600)
    assert process.returncode == 1, err
    rows = rows_of(out / "report.jsonl")
    # Every file once.
    assert sorted(row["output"] for row in rows) == sorted([*(f"{n}.obj" for n in range(16)), "bad.obj"])
    assert [row["output"] for row in rows if row["status"] == "failed"] == ["bad.obj"]
    run("batch", scans, "--out", tmp_path / "here", code=1)
    assert state_of(out) == state_of(tmp_path / "here")


def test_a_scheduler_that_is_lost_ends_the_run_with_a_sentence(farm, tmp_path):
    address, (scheduler, *_workers) = farm
    scans, out = tmp_path / "scans", tmp_path / "out"
    scans.mkdir()
    for number in range(12):
        (scans / f"{number}.obj").write_text(obj(number, 30))
    process = start("batch", scans, "--out", out, "--scheduler", address)
    process.stdout.readline()
    scheduler.kill()
    _out, err = process.communicate(timeout=600)
    assert process.returncode == 1, err
    assert (
        "The scheduler was lost; start it and give the same command again" in err and "Traceback" not in err
    )
    n_rows = len(rows_of(out / "report.jsonl"))
    assert 0 < n_rows < 12
    assert main(["batch", str(scans), "--out", str(out)]) == 0
    assert len(rows_of(out / "report.jsonl")) == 12


def test_a_scheduler_that_does_not_answer(scans, tmp_path, monkeypatch, capsys):
    pytest.importorskip("distributed", reason="Dask distributed is not installed")
    from framelet.operators.farm import dask_farm

    monkeypatch.setattr(dask_farm, "PATIENCE", 1)
    words = ("batch", str(scans), "--out", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:9")
    began = time.monotonic()
    assert main(words) == 1
    assert "does not answer" in capsys.readouterr().err and time.monotonic() - began < 30


def test_workers_with_several_threads_are_refused(farm, scans, tmp_path, capsys, monkeypatch):
    from distributed import Client

    address, (_scheduler, *_workers) = farm
    monkeypatch.setattr(Client, "nthreads", lambda self: {"tcp://10.0.0.1:1": 4})
    assert main(["batch", str(scans), "--out", str(tmp_path / "out"), "--scheduler", address]) == 1
    assert "--nworkers 4 --nthreads 1" in capsys.readouterr().err
