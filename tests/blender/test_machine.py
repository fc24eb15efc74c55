# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Free memory and processors, on made-up systems: with and without containers of both versions."""

import os

import pytest
from framelet.core.blocks import Blocks
from framelet.core.processors import default_threads, set_default_threads
from framelet.operators import machine
from framelet.operators.machine import available_bytes, available_processors

GIB = 2**30
HOST = {"proc/meminfo": f"MemTotal: 99 kB\nMemAvailable:   {32 * GIB // 1024} kB\n"}


@pytest.fixture(autouse=True)
def many_cores(monkeypatch):
    monkeypatch.setattr(machine.os, "sched_getaffinity", lambda _: set(range(64)), raising=False)


def put(folder, files):
    """Write the files of a system, and return where it shows processes and control groups."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder / "proc", folder / "sys"


def test_a_machine_without_limits(tmp_path):
    where = put(tmp_path, HOST | {"proc/self/cgroup": "0::/user.slice\n"})
    assert available_bytes(*where) == 32 * GIB
    assert available_processors(*where) == 64


@pytest.mark.parametrize("path", ["/", "/docker/abc", "/../other"])
def test_a_container_of_version_2(tmp_path, path):
    """Its own group is shown as the root, whatever it is called."""
    files = {
        "proc/self/cgroup": f"0::{path}\n",
        "sys/memory.max": f"{4 * GIB}\n",
        "sys/memory.current": f"{3 * GIB}\n",
        "sys/memory.stat": f"anon {GIB}\ninactive_file {2 * GIB}\nactive_file 5\n",
        "sys/cpu.max": "250000 100000\n",
    }
    where = put(tmp_path, HOST | files)
    assert available_bytes(*where) == 3 * GIB  # files that were read give way
    assert available_processors(*where) == 3


def test_the_narrowest_of_nested_groups_counts(tmp_path):
    files = {
        "proc/self/cgroup": "0::/a/b\n",
        "sys/a/b/memory.max": "max\n",
        "sys/a/b/memory.current": "5\n",
        "sys/a/b/cpu.max": "max 100000\n",
        "sys/a/memory.max": f"{GIB}\n",
        "sys/a/memory.current": f"{2 * GIB}\n",
        "sys/a/cpu.max": "50000 100000\n",
    }
    where = put(tmp_path, HOST | files)
    assert available_bytes(*where) == 0
    assert available_processors(*where) == 1


def test_a_container_of_version_1(tmp_path):
    files = {
        "proc/self/cgroup": "7:cpu,cpuacct:/docker/x\n4:memory:/docker/x\n0::/\n",
        "sys/memory/memory.limit_in_bytes": f"{2 * GIB}\n",
        "sys/memory/memory.usage_in_bytes": f"{GIB}\n",
        "sys/memory/memory.stat": f"total_inactive_file {GIB // 2}\n",
        "sys/cpu,cpuacct/cpu.cfs_quota_us": "400000\n",
        "sys/cpu,cpuacct/cpu.cfs_period_us": "100000\n",
    }
    where = put(tmp_path, HOST | files)
    assert available_bytes(*where) == GIB + GIB // 2
    assert available_processors(*where) == 4
    (where[1] / "cpu,cpuacct/cpu.cfs_quota_us").write_text("-1\n")  # no limit
    assert available_processors(*where) == 64


@pytest.mark.parametrize("text", ["", "MemAvailable: much\n", "MemAvailable:\n", None])
def test_systems_that_tell_otherwise(text, tmp_path, monkeypatch):
    """Without a readable meminfo the system is asked; without an answer the result is None."""
    where = put(tmp_path, {} if text is None else {"proc/meminfo": text})
    monkeypatch.setattr(
        machine.os, "sysconf", lambda name: {"SC_PAGE_SIZE": 4096}.get(name, 1000), raising=False
    )
    assert available_bytes(*where) == 4096 * 1000

    def silent(name):
        raise ValueError("unrecognized configuration name")

    monkeypatch.setattr(machine.os, "sysconf", silent, raising=False)
    assert available_bytes(*where) is None
    if os.name != "nt":
        assert machine._free_on_windows() is None  # no such library here


def test_this_machine():
    found = available_bytes()
    assert found is None or 10**6 < found < 2**50


def test_the_core_takes_the_number_that_it_is_told():
    before = default_threads()
    try:
        set_default_threads(3)
        assert Blocks().n_threads == 3 and Blocks(2).n_threads == 2
    finally:
        set_default_threads(before)
