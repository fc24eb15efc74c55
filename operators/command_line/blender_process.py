# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on files that only Blender can read, in a process of its own.

Importers print past Python, may end the process, and leave behind what keeps it from ending; a process of its
own takes all of that with it. It says what happens in marked lines, and writes into the outputs of the
process that started it, which checks and publishes them.
"""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..files.safe_write import Outputs
from .file_types import BLEND
from .messages import FAILURE, CommandError, Messages

MARK = "\x1eframelet "
"""Begins each line that is meant for the process that started Blender; all others are Blender's own."""

PATIENCE = 10.0
"""Seconds that Blender has to end by itself once all was done."""

BLENDER = "FRAMELET_BLENDER"
"""The environment variable that names the Blender to start; without it, one is looked for."""

WORKER = Path(__file__).with_name("blender_worker.py")


def run_in_blender(
    command: str, source: Path, target: Path, outputs: Outputs, messages: Messages, **job: Any
) -> dict[str, Any]:
    """Carry out a subcommand in a Blender of its own.

    Parameters
    ----------
    command : str
        A key of `blender_jobs.JOBS`.
    source, target : Path
        What is read and written.
    outputs : Outputs
        Takes the files.
    messages : Messages
        Says what the process says.
    **job : object
        What else the job is given, as JSON can hold it.

    Returns
    -------
    dict
        What the job returned.

    Raises
    ------
    CommandError
        If there is no Blender, it failed, or it ended on its way.
    """
    words = _command_line()
    path = (outputs.sibling_for if target.suffix.lower() == BLEND else outputs.path_for)(target)
    job |= {"command": command, "source": str(source), "target": str(target), "path": str(path)}
    number, name = tempfile.mkstemp(".json", "framelet-")
    try:
        with os.fdopen(number, "w", encoding="ascii") as file:
            json.dump(job, file)
        found = _converse([*words, name], source, messages)
    finally:
        with suppress(OSError):
            os.unlink(name)
    if not found.get("writes_target", True):
        outputs.forget(path)
    for other, place in found.get("others", []):
        outputs.take(Path(other), Path(place))
    if target.suffix.lower() != BLEND:
        outputs.take_siblings(path)
    outputs.check_written()
    return found


def _command_line() -> list[str]:
    """Return how Blender is started: as it is named, the application we are in, or the module."""
    named = os.environ.get(BLENDER)
    if named:
        return [named, "--background", "--factory-startup", "--python", str(WORKER), "--"]
    bpy = sys.modules.get("bpy")
    binary = getattr(getattr(bpy, "app", None), "binary_path", "")
    if bpy is not None and binary and not getattr(bpy.app, "module", False):
        return [binary, "--background", "--factory-startup", "--python", str(WORKER), "--"]
    try:
        is_there = importlib.util.find_spec("bpy") is not None
    except ValueError:
        is_there = False
    if not is_there:
        raise CommandError(
            "This needs Blender, which alone reads and writes .blend, .fbx, .usd and .abc files; install the "
            "module with 'pip install bpy', use 'blender -c framelet', or name a Blender in FRAMELET_BLENDER."
        )
    return [sys.executable, str(WORKER)]


def _converse(words: list[str], source: Path, messages: Messages) -> dict[str, Any]:
    """Start Blender, pass on what it says, and return what it found."""
    # The module sets this for its own process; one that inherits it prints a line about that.
    environment = {name: value for name, value in os.environ.items() if name != "OCIO"}
    found: dict[str, Any] | None = None
    with subprocess.Popen(
        words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment
    ) as process:
        try:
            assert process.stdout is not None
            for line in process.stdout:
                text = line.decode("utf-8", "replace")
                if not text.startswith(MARK):
                    continue
                kind, value = json.loads(text[len(MARK) :])
                if kind == "error":
                    raise CommandError(value, FAILURE)
                if kind == "found":
                    found = value
                    break
                _pass_on(kind, value, messages)
            with suppress(subprocess.TimeoutExpired):
                process.wait(PATIENCE)
        finally:
            process.kill()
    if found is None:
        code = process.returncode
        how = f"by signal {-code}" if code < 0 else f"with exit code {code}"
        raise CommandError(f"Blender ended {how} while it worked on {source}; the file may be damaged.")
    return found


def _pass_on(kind: str, value: Any, messages: Messages) -> None:
    """Say what Blender's process says."""
    if kind == "say":
        messages.say(value)
    elif kind == "warn":
        messages.warn(value)
    elif kind == "show":
        messages.show(*value)
