# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Take the screenshots of the documents in a real window of Blender.

    make screenshots

It needs what the tests in `tests/gui` need; see `.ci/gui.py`. Names of pictures as arguments take only those.
"""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

import numpy as np  # noqa: E402
from blender_window.code import MONKEY  # noqa: E402
from blender_window.pixels import write_png  # noqa: E402
from blender_window.programs import NoWindow, find_programs  # noqa: E402
from blender_window.session import Session  # noqa: E402
from blender_window.sidebar import press, start_fresh  # noqa: E402

IMAGES = ROOT / "docs" / "images"
SIZE = (1180, 920)

PATIENCE = 300.0
TEXT = 130
"""What is brighter than this in a panel is text; the viewport behind the sidebar is darker."""

FRACTION = """
import sys
current_run = next(module for name, module in sys.modules.items() if name.endswith(".run.current_run"))

def fraction():
    run = current_run.current_run()
    return run.fraction if run else 0.0
"""
"""How far a run is."""

MOVED = "positions('Monkey').tobytes() != before"


class Shot(NamedTuple):
    """A picture: its name, the subpanels that are open, what is done, and what is cut out.

    `part` is a region of the viewport, AREA for the viewport with its sidebar, or WINDOW for all.
    """

    name: str
    unfolded: tuple[str, ...]
    act: Callable[[Session], None]
    part: str = "AREA"
    subdivisions: int = 2


def rest(session: Session) -> None:
    """Do nothing."""


def denoise(session: Session, preset: str = "AUTO") -> None:
    """Denoise by the button, and wait until it is done."""
    session.run("bpy.context.scene.framelet.preset = preset", preset=preset)
    session.settle(0.5)
    session.run("before = positions('Monkey').tobytes()")
    press(session, "object.framelet_denoise")
    session.wait_for(MOVED, PATIENCE)
    session.settle(1.0)


def denoise_and_scroll(session: Session) -> None:
    """Denoise, and scroll the sidebar to its end."""
    denoise(session)
    scroll(session)


def scroll(session: Session) -> None:
    """Scroll the sidebar to its end."""
    session.events(*[("WHEELDOWNMOUSE", "PRESS", session.middle("UI"), {})] * 40)


def show_heat(session: Session) -> None:
    """Denoise, and color by displacement."""
    denoise(session)
    press(session, "object.framelet_heat_map", seconds=1.0, across=0.25)


def make_live(session: Session) -> None:
    """Make the levels sliders of a modifier."""
    press(session, "object.framelet_live_equalizer", seconds=4.0, across=0.75)


def show_band(session: Session) -> None:
    """Analyze, and color by a band."""
    press(session, "object.framelet_analyze", seconds=2.0)
    press(session, "object.framelet_show_band", seconds=1.0)


def run_long(session: Session) -> None:
    """Start a run that takes its time, and stay in it until its bar is seen."""
    press(session, "object.framelet_denoise")
    session.run(FRACTION)
    session.wait_for("fraction() > 0.2", PATIENCE)


def choose_tri_2(session: Session) -> None:
    """Choose an engine with λ and μ."""
    session.run("bpy.context.scene.framelet.preset = 'TRI_2'")


def show_group(session: Session) -> None:
    """Set some options of a region, and scroll the sidebar to its end."""
    session.run(
        "bpy.data.objects['Monkey'].vertex_groups.new(name='Face')\n"
        "s = bpy.context.scene.framelet; s.vertex_group = 'Face'; s.limit = 'EDGES'; s.keep_sharp = True"
    )
    scroll(session)


SHOTS = (
    Shot("window_start", (), rest),
    Shot("window_denoised", ("see", "last_run"), denoise),
    Shot("window_heat_map", ("see",), show_heat),
    Shot("window_bands", ("bands",), show_band),
    Shot("window_cancel", (), run_long, "WINDOW", 4),
    Shot("panel", (), denoise, "UI"),
    Shot("panel_tri_2", ("advanced",), choose_tri_2, "UI"),
    Shot("panel_region", ("mask", "region"), show_group, "UI"),
    Shot("panel_output", ("output",), denoise, "UI"),
    Shot("panel_equalizer", ("equalizer",), rest, "UI"),
    Shot("panel_live_equalizer", ("equalizer",), make_live, "UI"),
    Shot("panel_see", ("see",), show_heat, "UI"),
    Shot("panel_last_run", ("see", "last_run", "noise"), denoise_and_scroll, "UI"),
    Shot("panel_try_it", ("try_it",), rest, "UI"),
)


def main() -> int:
    """Take the pictures and return the exit code."""
    try:
        programs = find_programs()
    except NoWindow as reason:
        print(f"No screenshots: this {reason}.")
        return 1
    extension = Path(os.environ.get("FRAMELET_ZIP") or next((ROOT / "build").glob("framelet-*.zip")))
    wanted = sys.argv[1:] or [shot.name for shot in SHOTS]
    session = Session(programs, extension, SIZE, 1, overlap=True)
    try:
        for shot in SHOTS:
            if shot.name in wanted:
                take(session, shot)
    finally:
        session.close()
    return 0


def take(session: Session, shot: Shot) -> None:
    """Take one picture."""
    start_fresh(session, shot.unfolded)
    session.run(MONKEY, subdivisions=shot.subdivisions)
    session.settle(1.0)
    shot.act(session)
    session.move((5, 5))
    session.settle(2.0)
    picture = session.picture() if shot.part == "WINDOW" else cut(session, shot.part)
    write_png(IMAGES / f"{shot.name}.png", picture)
    print(f"Wrote {shot.name}.png to {IMAGES}.", flush=True)
    if session.run("result = hasattr(bpy.types, 'OBJECT_OT_framelet_cancel')"):
        session.run("if bpy.ops.object.framelet_cancel.poll(): bpy.ops.object.framelet_cancel()")
        session.settle(0.5)


def cut(session: Session, part: str) -> np.ndarray:
    """Return the viewport with its sidebar, or the used part of the sidebar."""
    code = "r = view3d() if part == 'AREA' else region(part)\nresult = [r.x, r.y, r.width, r.height]"
    x, y, width, height = session.run(code, part=part)
    picture = session.picture()
    top = session.size[1] - y - height
    picture = picture[top : top + height, x : x + width]
    return trimmed(picture) if part == "UI" else picture


def trimmed(picture: np.ndarray) -> np.ndarray:
    """Return the sidebar without its tabs, down to its last line of text."""
    left, right = 8, picture.shape[1] - 30
    is_text = (picture[:, left + 20 : right].min(axis=2) > TEXT).any(axis=1)
    bottom = int(np.flatnonzero(is_text)[-1]) + 14
    return picture[:bottom, left:right]


if __name__ == "__main__":
    sys.exit(main())
