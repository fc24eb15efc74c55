# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the machine has free for this process: memory and processors, in a container its share of them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from math import ceil
from pathlib import Path
from typing import NamedTuple

PROC, CGROUPS = Path("/proc"), Path("/sys/fs/cgroup")


def available_bytes(proc: Path = PROC, cgroups: Path = CGROUPS) -> int | None:
    """Return how much memory is free for new work, in bytes; None if the system does not say."""
    found = (_free_of_machine(proc), _free_of_container(proc, cgroups))
    return min((value for value in found if value is not None), default=None)


def available_processors(proc: Path = PROC, cgroups: Path = CGROUPS) -> int:
    """Return how many processors this process may use, at least 1."""
    number = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    for group in _groups(proc, cgroups, "cpu"):
        if group.version == 2:
            first, _, second = _text(group.folder / "cpu.max").partition(" ")
        else:
            first, second = (_text(group.folder / f"cpu.cfs_{name}_us") for name in ("quota", "period"))
        quota, period = _number(first), _number(second)
        if quota is not None and period and quota > 0:
            number = min(number, ceil(quota / period))
    return max(number, 1)


class _Group(NamedTuple):
    """A control group: its folder, and the version of the interface."""

    folder: Path
    version: int


def _groups(proc: Path, cgroups: Path, controller: str) -> Iterator[_Group]:
    """Yield the control groups that limit this process, from its own to the outermost one.

    In a container the own group is often shown as the root, whatever its path on the host is.
    """
    for line in _text(proc / "self" / "cgroup").splitlines():
        _, _, rest = line.partition(":")
        names, _, path = rest.partition(":")
        if not names:
            root, version = cgroups, 2
        elif controller in names.split(","):
            root, version = cgroups / controller, 1
            root = root if root.is_dir() else cgroups / names
        else:
            continue
        parts = [part for part in path.split("/") if part not in ("", "..")]
        for length in range(len(parts), -1, -1):
            yield _Group(root.joinpath(*parts[:length]), version)


def _free_of_container(proc: Path, cgroups: Path) -> int | None:
    """Return what is left of the limits on memory; None without a limit."""
    found = []
    for group in _groups(proc, cgroups, "memory"):
        limit_name, used_name, cache_name = (
            ("memory.max", "memory.current", "inactive_file")
            if group.version == 2
            else ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
        )
        limit, used = (_number(_text(group.folder / name)) for name in (limit_name, used_name))
        if limit is None or used is None:
            continue
        # Pages of files that were read count as used, and go as soon as memory is asked for.
        words = _text(group.folder / "memory.stat").split()
        cache = _number(words[words.index(cache_name) + 1]) if cache_name in words[:-1] else 0
        found.append(max(limit - used + min(cache or 0, used), 0))
    return min(found, default=None)


def _free_of_machine(proc: Path) -> int | None:
    """Return what the machine has free."""
    for line in _text(proc / "meminfo").splitlines():
        if line.startswith("MemAvailable:"):
            number = _number(line.partition(":")[2].split()[0] if line.split()[1:] else "")
            if number is not None:
                return number * 1024
    if os.name == "nt":
        return _free_on_windows()
    for name in ("SC_AVPHYS_PAGES", "SC_PHYS_PAGES"):  # where free pages are not told, all that there are
        try:
            pages, size = os.sysconf(name), os.sysconf("SC_PAGE_SIZE")
        except (AttributeError, ValueError, OSError):
            continue
        if pages > 0 and size > 0:
            return pages * size
    return None


def _free_on_windows() -> int | None:
    """Ask Windows for the free physical memory."""
    import ctypes

    class Status(ctypes.Structure):
        _fields_ = (
            ("length", ctypes.c_uint32),
            ("load", ctypes.c_uint32),
            *(
                (name, ctypes.c_uint64)
                for name in ("total", "free", "total_page", "free_page", "total_virtual", "free_virtual", "x")
            ),
        )

    status = Status()
    status.length = ctypes.sizeof(Status)
    kernel = getattr(ctypes, "windll", None)
    if kernel is None or not kernel.kernel32.GlobalMemoryStatusEx(ctypes.byref(status)):
        return None
    return int(status.free)


def _text(path: Path) -> str:
    """Return what a file of the system says; nothing if it is not there."""
    try:
        return path.read_text(encoding="ascii", errors="replace")
    except OSError:
        return ""


def _number(word: str) -> int | None:
    """Return a whole number; None if it is none, as "max" is."""
    try:
        return int(word)
    except ValueError:
        return None
