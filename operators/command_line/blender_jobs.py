# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a Blender of its own does for a subcommand: read a file, work on its meshes, write a file."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .blender_process import MARK
from .mesh_work import Outcome, describe_input, work_on_each
from .messages import CommandError, Messages

if TYPE_CHECKING:
    import bpy

    from ...core.report import DenoiseReport


class MarkedMessages(Messages):
    """Messages for the process that started this one."""

    def __init__(self) -> None:
        super().__init__(is_quiet=False)
        self._shown = -1.0

    def tell(self, kind: str, value: Any) -> None:
        """Print a marked line, whatever Blender printed before it."""
        sys.stdout.write(f"\n{MARK}{json.dumps([kind, value])}\n")
        sys.stdout.flush()

    def say(self, line: str) -> None:
        """See `Messages.say`."""
        self.tell("say", line)

    def warn(self, sentence: str) -> None:
        """See `Messages.warn`."""
        self.tell("warn", sentence)

    def show(self, what: str, fraction: float) -> None:
        """See `Messages.show`; a line a percent."""
        if fraction in (0.0, 1.0) or abs(fraction - self._shown) >= 0.01:
            self._shown = fraction
            self.tell("show", [what, fraction])


def carry_out(job: dict[str, Any]) -> int:
    """Carry out a job, and tell what came of it or why it failed; returns the exit code."""
    messages = MarkedMessages()
    try:
        import bpy
    except ImportError as error:
        messages.tell(
            "error",
            f"Blender cannot be used from this Python ({error}); install the module with 'pip install bpy'.",
        )
        return 1
    try:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        found = JOBS[job["command"]](job, messages)
    except (CommandError, ValueError) as error:
        messages.tell("error", str(error))
    except MemoryError:
        messages.tell("error", "There is not enough memory for this mesh; nothing was written.")
    except Exception as error:
        # A file can be damaged in ways that no check of ours knows, and a traceback helps no user.
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        messages.tell("error", f"{job['source']} cannot be worked on ({reason}); the file may be damaged.")
    else:
        messages.tell("found", found)
        return 0
    return 1


def _denoise(job: dict[str, Any], messages: MarkedMessages) -> dict[str, Any]:
    import bpy

    from ...core.settings import DenoiseSettings
    from ..batch.peak_memory import peak_bytes
    from ..properties.region_options import RegionOptions
    from ..run.denoise_object import denoise_object
    from ..run.denoise_run import State, begin_run
    from .denoise import describe_result
    from .report_file import entry, plain

    settings, options = DenoiseSettings(**job["settings"]), RegionOptions(**job["options"])

    def together(objects: list[bpy.types.Object]) -> Outcome:
        run = begin_run(objects, settings, job["output"], options)
        with messages.progress(run.text) as callback:

            def show(fraction: float) -> None:
                callback(fraction, 0.0)

            run.run_here(show)
        if run.state is not State.READY:
            raise CommandError(f"{job['source']}: {run.reason}")
        done = [(item.original.name, item.measured.report) for item in run.finish()]
        for name, report in done:
            for line in describe_result(name, report):
                messages.say(line)
        left = [obj.name for obj in objects if obj.name not in dict(done)]
        for reason in run.failures:
            messages.warn(f"{reason} It was skipped.")
        return Outcome(done, list(zip(left, run.failures, strict=True)))

    def work(obj: bpy.types.Object) -> DenoiseReport:
        with messages.progress(f"Denoising {obj.name}") as callback:
            report = denoise_object(obj, settings, callback, job["output"], options)
        for line in describe_result(obj.name, report):
            messages.say(line)
        return report

    outcome = _on_meshes(job, messages, None if options.together else work, together)
    return {
        "blender": bpy.app.version_string.split()[0],
        "peak_bytes": peak_bytes(),
        "entries": [plain({"name": name, **entry(report)}) for name, report in outcome.done],
        "skipped": [{"name": name, "reason": reason} for name, reason in outcome.refusals],
    }


def _equalize(job: dict[str, Any], messages: MarkedMessages) -> dict[str, Any]:

    from ..equalize import equalize_object
    from .equalize import describe_result

    def work(obj: bpy.types.Object) -> None:
        messages.say(describe_result(obj.name, *equalize_object(obj, job["gains"], **job["frame"])))

    _on_meshes(job, messages, work)
    return {}


def _bands(job: dict[str, Any], messages: MarkedMessages) -> dict[str, Any]:
    from ...core.settings import DenoiseSettings
    from ..mesh_io.mesh_bridge import read_surface, refusal
    from .bands import analyzed, numbered
    from .importing import open_source

    target, folder = Path(job["target"]), Path(job["path"]).parent
    objects = open_source(Path(job["source"]), messages)
    _say_input(Path(job["source"]), objects, messages)
    meshes = _first_objects(objects)
    others: list[tuple[str, str]] = []

    def work(item: tuple[int, bpy.types.Object]) -> None:
        number, obj = item
        reason = refusal(obj)
        if reason is not None:
            raise ValueError(reason)
        content, sentence = analyzed(
            obj.name, read_surface(obj), DenoiseSettings(**job["settings"]), job["max_size"]
        )
        place = numbered(target, number, len(meshes))
        path = folder / place.name
        _write(path, content)
        if place != target:
            others.append((str(path), str(place)))
        messages.say(sentence)

    items = [(obj.name, (number, obj)) for number, obj in enumerate(meshes, 1)]
    work_on_each(Path(job["source"]), items, messages, work)
    return {"others": others, "writes_target": len(meshes) == 1}


JOBS: dict[str, Callable[[dict[str, Any], MarkedMessages], dict[str, Any]]] = {
    "denoise": _denoise,
    "equalize": _equalize,
    "bands": _bands,
}


def _on_meshes(
    job: dict[str, Any],
    messages: MarkedMessages,
    work: Callable[[bpy.types.Object], Any] | None,
    together: Callable[[list[bpy.types.Object]], Outcome] | None = None,
) -> Outcome:
    """Open a file, work on each of its meshes once or on all together, and write what came of it."""
    from .exporting import export
    from .importing import open_source

    source = Path(job["source"])
    objects = open_source(source, messages)
    _say_input(source, objects, messages)
    items = [(obj.name, obj) for obj in _first_objects(objects)]
    if work is not None:
        outcome = work_on_each(source, items, messages, work)
    else:
        assert together is not None
        outcome = together([obj for _, obj in items])
    refused = {obj.data for name, obj in items if name in outcome.refused}
    export(
        [obj for obj in objects if obj.data not in refused],
        source,
        Path(job["target"]),
        Path(job["path"]),
        messages,
    )
    return outcome


def _first_objects(objects: list[bpy.types.Object]) -> list[bpy.types.Object]:
    """Return the first object of each mesh; objects that share one share the result."""
    first: dict[Any, bpy.types.Object] = {}
    for obj in objects:
        first.setdefault(obj.data, obj)
    return list(first.values())


def _say_input(source: Path, objects: list[bpy.types.Object], messages: Messages) -> None:
    """Say how large the input is."""
    meshes = {obj.data for obj in objects}
    messages.say(
        describe_input(
            source,
            sum(len(mesh.vertices) for mesh in meshes),
            sum(len(mesh.polygons) for mesh in meshes),
            len(objects),
            objects[0].dimensions,
        )
    )


def _write(path: Path, content: bytes) -> None:
    """Write a file and see that it reaches the disk."""
    try:
        with path.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        raise CommandError(f"{path.name} could not be written: {error.strerror or error}.") from error
