# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the speed benchmark measures: a list of runs, each in a process of its own."""

from dataclasses import dataclass, field

SIZES = (10_000, 100_000, 1_000_000, 4_000_000)
QUICK_SIZES = (2_000, 4_000)
LIVE = 50_000
"""Vertices of the mesh on which a value is dragged."""

MONKEY_LEVELS = 5
SLOWEST_SIZE = 1_000_000
"""Largest mesh for everything but Tri-2."""


@dataclass(frozen=True)
class Run:
    """A measurement: `what` names it in tables, `kind` is the program that makes it."""

    kind: str
    what: str
    size: int
    is_shuffled: bool = False
    name: str = ""
    options: dict = field(default_factory=dict)
    source: str = ""


def make_plan(sizes, *, with_blender=True, with_others=True):
    """Return the runs for some sizes."""
    runs = []
    for size in sizes:
        runs.append(_core("Tri-2", size, "TRI_2", rerun=True))
        if size > SLOWEST_SIZE:
            continue
        runs.append(_core("Tri-2, shuffled", size, "TRI_2", rerun=True, is_shuffled=True))
        runs.append(_core("Tri-2, one thread", size, "TRI_2", threads=1))
        adaptive = {"frame": "ADAPTIVE", "stencil": "ADAPTIVE", "levels": 3}
        runs.append(_core("Adaptive, 3 levels", size, "TRI_2", **adaptive))
        for preset, label in (("AUTO", "Automatic"), ("FREE_FORM", "Free-Form"), ("PRISMATIC", "Prismatic")):
            runs.append(_core(label, size, preset, rerun=preset != "AUTO"))
        if with_blender:
            for preset, label in (("TRI_2", "Tri-2"), ("AUTO", "Automatic")):
                runs.append(Run("blender", f"{label} in Blender", size, options={"preset": preset}))
            shuffled = {"preset": "TRI_2"}
            runs.append(
                Run("blender", "Tri-2 in Blender, shuffled", size, is_shuffled=True, options=shuffled)
            )
        if with_others:
            for name, label in OTHERS.items():
                runs.append(Run("baseline", label, size, name=name))
    if with_blender and max(sizes) >= LIVE:
        runs.append(Run("blender", "Tri-2 in Blender", LIVE, options={"preset": "TRI_2"}))
        monkey = f"monkey:{MONKEY_LEVELS}"
        for preset, label in (("TRI_2", "Tri-2"), ("AUTO", "Automatic")):
            runs.append(
                Run("blender", f"{label} on the monkey", 0, options={"preset": preset}, source=monkey)
            )
    return runs


OTHERS = {
    "plain": "Tri-2 in plain numpy",
    "pymeshlab_taubin": "MeshLab, Taubin",
    "pymeshlab_two_step": "MeshLab, two-step",
    "meshlib_denoise": "MeshLib, via normals",
}


def _core(what, size, preset, *, rerun=False, is_shuffled=False, **changes):
    options = {"preset": preset, "changes": changes, "rerun": rerun}
    return Run("core", what, size, is_shuffled=is_shuffled, options=options)
