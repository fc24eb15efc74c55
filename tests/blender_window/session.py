# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A Blender with a window on a virtual screen, used with mouse and keys and asked in Python."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from .pixels import read_screen
from .programs import Programs

HERE = Path(__file__).resolve().parent
START_SECONDS = 120.0
PATIENCE = 60.0
"""Seconds to wait for an answer, at most."""

BOX = """
r = region(kind)
result = [r.x, r.y, r.width, r.height]
if kind == "WINDOW":
    tools, sidebar = region("TOOLS"), region("UI")
    left = max(r.x, tools.x + tools.width) if tools.width > 1 else r.x
    right = min(r.x + r.width, sidebar.x) if sidebar.width > 1 else r.x + r.width
    top = min(other.y for other in (region("HEADER"), region("TOOL_HEADER")))
    result = [left, r.y, right - left, top - r.y]
"""


class BlenderFailed(Exception):
    """Blender ended, did not answer, or raised an error."""


class Session:
    """Starts a virtual screen and Blender with the extension, in user folders of its own.

    Parameters
    ----------
    programs : Programs
        Where Blender and Xvfb are.
    extension : Path
        The extension's zip.
    size : (int, int)
        Width and height of screen and window in pixels.
    scale : float
        Blender's resolution scale.
    overlap : bool
        Whether the sidebar lies over the viewport, as users know it; it is slow with software OpenGL.
    """

    def __init__(
        self,
        programs: Programs,
        extension: Path,
        size: tuple[int, int],
        scale: float = 1.0,
        *,
        overlap: bool = False,
    ) -> None:
        self.size = size
        self.scale = scale
        self._programs = programs
        self._number = 0
        self._place = (0, 0)
        self._processes: list[subprocess.Popen] = []
        self.folder = programs.make_job_folder()
        try:
            self._start(extension, overlap)
        except BaseException:
            self.close()
            raise

    def _start(self, extension: Path, overlap: bool) -> None:
        """Start screen and Blender, and wait until it answers."""
        for name in ("home", "run"):
            (self.folder / name).mkdir(mode=0o700)
        for path in (extension, HERE / "first_start.py", HERE / "inside.py"):
            shutil.copy(path, self.folder)
        inside = self._programs.path_inside(self.folder)
        environment = {
            "HOME": f"{inside}/home",
            "XDG_RUNTIME_DIR": f"{inside}/run",
            "BLENDER_USER_RESOURCES": f"{inside}/home/blender",
            "LIBGL_ALWAYS_SOFTWARE": "1",
        }
        blender, log = self._programs.blender, self.folder / "blender.log"
        arguments = ["-b", "--python-exit-code", "1", "--python", f"{inside}/first_start.py"]
        arguments += ["--", f"{inside}/{extension.name}", str(self.scale), str(int(overlap))]
        first = self._programs.start([blender, *arguments], environment, log)
        self._processes.append(first)
        if first.wait(START_SECONDS) != 0:
            raise BlenderFailed(f"Blender could not install the extension:\n{self._log()}")
        environment["DISPLAY"] = f":{self._start_screen(inside, environment)}"
        width, height = self.size
        arguments = [
            "--enable-event-simulate",
            "--gpu-backend",
            "opengl",
            "-p",
            "0",
            "0",
            str(width),
            str(height),
        ]
        arguments += ["--python", f"{inside}/inside.py", "--", inside]
        self._processes.append(self._programs.start([blender, *arguments], environment, log))
        self.run("result = 1", patience=START_SECONDS)
        self.settle(1.0)

    def _start_screen(self, inside: str, environment: dict[str, str]) -> int:
        """Start Xvfb and return the number of its display."""
        read, write = os.pipe()
        width, height = self.size
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24"]
        command += ["-fbdir", inside, "-nolisten", "tcp", "-nocursor", "+extension", "GLX"]
        process = self._programs.start(command, environment, self.folder / "screen.log", pass_fds=(write,))
        self._processes.append(process)
        os.close(write)
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        if not number:
            raise BlenderFailed(f"Xvfb did not start:\n{(self.folder / 'screen.log').read_text()}")
        return int(number)

    def close(self) -> None:
        """End all programs and remove their files."""
        for process in reversed(self._processes):
            if process.poll() is None:
                process.kill()
            process.wait()
        self._processes.clear()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _log(self) -> str:
        return (self.folder / "blender.log").read_text(errors="replace")[-4000:]

    # Asking Blender

    def run(self, code: str, *, patience: float = PATIENCE, **values: Any) -> Any:
        """Run Python code in Blender, with these values as names, and return what it leaves in `result`.

        Raises
        ------
        BlenderFailed
            If the code raises, or Blender does not answer within `patience` seconds.
        """
        head = "".join(f"{name} = {value!r}\n" for name, value in values.items())
        part, request = (self.folder / f"{self._number}.{kind}" for kind in ("new", "py"))
        answer = self.folder / f"{self._number}.json"
        self._number += 1
        part.write_text(head + code, encoding="utf-8")
        part.rename(request)
        end = time.monotonic() + patience
        while not answer.exists():
            if self._processes[-1].poll() is not None:
                raise BlenderFailed(
                    f"Blender has ended with {self._processes[-1].returncode}:\n{self._log()}"
                )
            if time.monotonic() > end:
                raise BlenderFailed(f"Blender did not answer within {patience:g} s:\n{self._log()}")
            time.sleep(0.005)
        found = json.loads(answer.read_text(encoding="utf-8"))
        if "error" in found:
            raise BlenderFailed(found["error"])
        return found["result"]

    def wait_for(self, expression: str, patience: float = PATIENCE) -> Any:
        """Wait until an expression is true in Blender, and return its value."""
        end = time.monotonic() + patience
        while not (value := self.run(f"result = {expression}")):
            if time.monotonic() > end:
                raise BlenderFailed(f"Not true within {patience:g} s: {expression}")
            time.sleep(0.05)
        return value

    def until(self, check: Callable[[], bool], patience: float = 20.0) -> bool:
        """Look until a check is true, and return whether it became so: the screen may lag behind Blender."""
        end = time.monotonic() + patience
        while not (is_true := bool(check())) and time.monotonic() < end:
            self.settle(0.2)
        return is_true

    def settle(self, seconds: float = 0.3) -> None:
        """Let Blender handle events and draw."""
        time.sleep(seconds)
        self.run("result = None")

    # Mouse and keys. Places are pixels from the left and from the bottom of the window, as Blender counts.

    def events(self, *events: tuple[str, str, tuple[int, int], dict[str, Any]]) -> None:
        """Send events, each a kind, a value, a place and more, and let Blender handle each."""
        for event in events:
            self._place = event[2]
        self.run("result = play(events)", events=[list(event) for event in events])

    def move(self, place: tuple[int, int]) -> None:
        """Move the mouse."""
        self.events(("MOUSEMOVE", "NOTHING", place, {}))

    def click(self, place: tuple[int, int], button: str = "LEFTMOUSE", seconds: float = 0.3) -> None:
        """Move the mouse to a place, and press and release a button."""
        self.events(
            ("MOUSEMOVE", "NOTHING", (place[0] + 1, place[1]), {}),
            ("MOUSEMOVE", "NOTHING", place, {}),
            (button, "PRESS", place, {}),
            (button, "RELEASE", place, {}),
        )
        self.settle(seconds)

    def key(self, kind: str, seconds: float = 0.3, unicode: str = "", **more: Any) -> None:
        """Press and release a key where the mouse is."""
        extra = {"unicode": unicode} if unicode else {}
        self.events((kind, "PRESS", self._place, {**extra, **more}), (kind, "RELEASE", self._place, more))
        self.settle(seconds)

    def type_text(self, text: str) -> None:
        """Type letters, spaces and digits."""
        digits = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
        names = {" ": "SPACE", ".": "PERIOD", **{str(number): name for number, name in enumerate(digits)}}
        for letter in text:
            self.key(names.get(letter, letter.upper()), 0.0, unicode=letter)
        self.settle()

    def drag(
        self,
        places: list[tuple[int, int]],
        button: str = "LEFTMOUSE",
        meanwhile: Callable[[], None] = lambda: None,
    ) -> None:
        """Drag the mouse along places; `meanwhile` is called at each."""
        self.events(("MOUSEMOVE", "NOTHING", places[0], {}), (button, "PRESS", places[0], {}))
        for place in places[1:]:
            self.move(place)
            meanwhile()
        self.events((button, "RELEASE", places[-1], {}))
        self.settle()

    # Looking

    def picture(self) -> np.ndarray:
        """Return what is on the screen, shape (height, width, 3), rows from the top."""
        return read_screen(self.folder / "Xvfb_screen0")

    def still_picture(self) -> np.ndarray:
        """Return what is on the screen once nothing changes any more."""
        pictures = [self.picture()]

        def is_still() -> bool:
            pictures.append(self.picture())
            return np.array_equal(pictures[-1], pictures[-2])

        self.settle(0.3)
        self.until(is_still)
        return pictures[-1]

    def box(self, kind: str = "WINDOW") -> tuple[int, int, int, int]:
        """Return left, bottom, width and height of a region of the viewport, in pixels.

        WINDOW is what the other regions do not cover.
        """
        return tuple(self.run(BOX, kind=kind))

    def part(self, kind: str = "WINDOW") -> np.ndarray:
        """Return what is on the screen in a region of the viewport."""
        x, y, width, height = self.box(kind)
        top = self.size[1] - y - height
        return self.picture()[top : top + height, x : x + width]

    def middle(self, kind: str = "WINDOW") -> tuple[int, int]:
        """Return the place in the middle of a region of the viewport."""
        x, y, width, height = self.box(kind)
        return x + width // 2, y + height // 2
