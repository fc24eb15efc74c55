# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Run in the Blender with the window: does what the test asks for, between Blender's own work.

    blender --python inside.py -- FOLDER

A request is a file `FOLDER/<number>.py`. What its code leaves in `result` is written to `<number>.json`, or
the traceback of an error. A generator in `result` is run to its end, step by step; what it returns is the
answer.
"""

import json
import os
import sys
import time
import traceback
import types

import bpy

FOLDER = sys.argv[sys.argv.index("--") + 1]
PARENT = os.getppid()
PAUSE = 0.01
"""Seconds between two looks at the folder."""

ticks: list[float] = []
"""When this timer ran: gaps are times in which Blender did not respond."""

draws: list[float] = []
"""When a 3D viewport was drawn."""

scope: dict[str, object] = {"bpy": bpy, "ticks": ticks, "draws": draws}
next_number = 0
steps = None
"""What is left of a request that takes several steps, between which Blender does its own work."""


def window() -> bpy.types.Window:
    """Return the window."""
    return bpy.context.window_manager.windows[0]


def view3d() -> bpy.types.Area:
    """Return the largest 3D Viewport."""
    areas = [area for area in window().screen.areas if area.type == "VIEW_3D"]
    return max(areas, key=lambda area: area.width * area.height)


def region(kind: str) -> bpy.types.Region:
    """Return a region of the viewport: WINDOW, UI (the sidebar), HEADER..."""
    return next(region for region in view3d().regions if region.type == kind)


def override(kind: str = "WINDOW"):
    """Return a context as it is with the mouse over a region of the viewport."""
    return bpy.context.temp_override(
        window=window(), screen=window().screen, area=view3d(), region=region(kind)
    )


def tick() -> float:
    """Begin a request, if there is one, or take its next step."""
    global steps
    if os.getppid() != PARENT:
        # Those who asked were killed, and nobody else will end this Blender.
        os._exit(1)
    ticks.append(time.monotonic())
    path = os.path.join(FOLDER, f"{next_number}.py")
    try:
        if steps is None:
            if not os.path.exists(path):
                return PAUSE
            scope.pop("result", None)
            with open(path, encoding="utf-8") as file:
                exec(compile(file.read(), path, "exec"), scope)
            steps = scope.get("result")
        if isinstance(steps, types.GeneratorType):
            next(steps)
            return PAUSE
        answer(json.dumps({"result": steps}))
    except StopIteration as end:
        answer(json.dumps({"result": end.value}))
    except BaseException:
        answer(json.dumps({"error": traceback.format_exc()}))
    return PAUSE


def answer(text: str) -> None:
    """Write the answer to a request, at once for those who look."""
    global next_number, steps
    part = os.path.join(FOLDER, f"{next_number}.part")
    with open(part, "w", encoding="utf-8") as file:
        file.write(text)
    os.rename(part, os.path.join(FOLDER, f"{next_number}.json"))
    next_number += 1
    steps = None


def simulate(kind: str, value: str, place: tuple[int, int], **more: object) -> None:
    """Send an event to the window; places count from its left and bottom."""
    window().event_simulate(type=kind, value=value, x=place[0], y=place[1], **more)


def play(events: list) -> types.GeneratorType:
    """Send events, each a list of kind, value, place and a dictionary of more, one in each step."""
    for kind, value, place, more in events:
        simulate(kind, value, place, **more)
        yield
    # Until Blender has handled the last one.
    yield


scope.update(simulate=simulate, play=play, window=window, view3d=view3d, region=region, override=override)
bpy.types.SpaceView3D.draw_handler_add(lambda: draws.append(time.monotonic()), (), "WINDOW", "POST_PIXEL")
bpy.app.timers.register(tick, first_interval=0.5, persistent=True)
