# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One file of a batch: denoise it, write it, and account for it in a row. Runs in any process."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.processors import set_default_threads
from ...core.settings import DenoiseSettings
from ..batch.peak_memory import forget_peak, peak_bytes
from ..batch.rows import DONE, FAILED
from ..batch.task import Task, hash_of
from ..files.defects import defects_of
from ..files.safe_write import Outputs
from ..files.sidecars import sidecars_of
from ..machine import available_processors
from ..properties.region_options import RegionOptions
from . import explained
from .denoise import denoise_opened
from .file_types import check_source, needs_blender
from .file_work import open_source, refuse_blender_options, write_target
from .messages import CommandError, Messages
from .report_file import entry, plain
from .version import framelet_version

if TYPE_CHECKING:
    from .file_work import OpenedFile


class KeptMessages(Messages):
    """Messages that keep the warnings and print nothing."""

    def __init__(self) -> None:
        super().__init__(is_quiet=True)
        self.warnings: list[str] = []

    def warn(self, sentence: str) -> None:
        """Keep a warning."""
        self.warnings.append(sentence)


class _Stages:
    """Seconds by stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        began = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = round(time.perf_counter() - began, 4)


def carry_out(job: dict[str, Any]) -> dict[str, Any]:
    """Denoise one file.

    Parameters
    ----------
    job : dict
        ``task``, the fields of a `Task`; ``max_bytes``, the most memory that the work may take, or None;
        ``n_threads``, how many threads it may use, or 0 for as many as there are cores; ``own``, absolute
        paths and hashes of what an earlier run wrote beside the target.

    Returns
    -------
    dict
        The row of the report; ``status`` is "done", or "failed" with the sentence in ``error``. No error is
        raised that a file can cause.
    """
    task = Task(**job["task"])
    set_default_threads(job["n_threads"] or available_processors())
    messages, stages, row = KeptMessages(), _Stages(), row_of(task)
    forget_peak()
    try:
        if task.error:
            raise CommandError(task.error)
        row |= _work(task, job["max_bytes"], job["own"], messages, stages)
        row["status"] = DONE
    except Exception as error:
        row["error"] = _sentence(error, task)
    row |= {"warnings": messages.warnings, "seconds": stages.seconds, "ended": time.time()}
    row["peak_bytes"] = row["peak_bytes"] or peak_bytes()
    return plain(row)


def row_of(task: Task) -> dict[str, Any]:
    """Return the row of a task of which nothing is known yet: it failed."""
    return {
        "status": FAILED,
        "input": task.source,
        "output": task.name,
        "target": task.target,
        "error": None,
        "preset": task.preset,
        "settings": task.settings,
        "region": task.region,
        "placement": task.placement,
        "key": task.key,
        "input_sha256": None,
        "output_sha256": None,
        "beside_input": {},
        "beside_output": {},
        "framelet": framelet_version(),
        "blender": None,
        "peak_bytes": None,
        "seconds": {},
        "warnings": [],
        "ended": time.time(),
    }


def _sentence(error: Exception, task: Task) -> str:
    """Return why a file could not be worked on, whatever it was: a batch goes on."""
    if isinstance(error, ValueError):
        return str(error)
    try:
        return explained(error)[0]
    except Exception:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        return f"{task.source} cannot be worked on ({reason}); the file may be damaged."


def _work(
    task: Task, max_bytes: int | None, own: dict[str, str], messages: KeptMessages, stages: _Stages
) -> dict[str, Any]:
    """Read, denoise and write a file; return what is to be said about it."""
    source, target = Path(task.source), Path(task.target)
    for_blender = needs_blender(source, target)
    refuse_blender_options(task.placement, target)
    if target.suffix.lower() == ".gltf" and source.suffix.lower() not in (".gltf", ".blend", ".fbx"):
        raise CommandError(
            f"{target} cannot be made of another format; write .glb, .ply, .obj or .stl instead."
        )
    check_source(source)
    _check_size(source, max_bytes)
    with stages("hash"):
        found: dict[str, Any] = {"input_sha256": hash_of(source)}
    target.parent.mkdir(parents=True, exist_ok=True)
    with Outputs() as outputs:
        if for_blender:
            found |= _work_in_blender(task, outputs, messages, stages)
        else:
            found |= _work_here(task, max_bytes, own, outputs, messages, stages)
        with stages("publish"):
            written = outputs.publish()
    with stages("hash result"):
        found["output_sha256"] = hash_of(target)
        others = {str(path.absolute()) for path in written} - {str(target)}
        # What was there already and is still the same was not written again.
        others |= {path for path, known in own.items() if hash_of(path) == known}
        found["beside_output"] = {
            os.path.relpath(path, target.parent): hash_of(path) for path in sorted(others)
        }
    return found


def _work_here(
    task: Task,
    max_bytes: int | None,
    own: dict[str, str],
    outputs: Outputs,
    messages: KeptMessages,
    stages: _Stages,
) -> dict[str, Any]:
    source, options = Path(task.source), RegionOptions(**task.region)
    with stages("read"):
        opened = open_source(source, messages)
        beside = {name: hash_of(source.parent / name) for name in sidecars_of(opened.file, source)}
    settings = DenoiseSettings(**task.settings)
    _check_memory(opened, settings, max_bytes)
    with stages("denoise"):
        outcome = denoise_opened(opened, settings, options, messages)
    with stages("write"):
        write_target(opened, Path(task.target), outputs, messages, own)
    with stages("defects"):
        defects = defects_of(opened.file)
    entries = [{"name": name, **entry(report)} for name, report in outcome.done]
    found = account(entries, [{"name": name, "reason": reason} for name, reason in outcome.refusals])
    # Vertices where fans of faces meet show in the rings of the engine only.
    defects += [defect for defect in found["defects"] if defect["kind"] == "non-manifold vertices"]
    return found | {"beside_input": beside, "defects": defects}


def _work_in_blender(task: Task, outputs: Outputs, messages: KeptMessages, stages: _Stages) -> dict[str, Any]:
    from .blender_process import run_in_blender

    with stages("blender"):
        found = run_in_blender(
            "denoise",
            Path(task.source),
            Path(task.target),
            outputs,
            messages,
            settings=asdict(DenoiseSettings(**task.settings)),
            options=task.region,
            output=task.placement,
        )
    return account(found["entries"], found["skipped"]) | {
        "blender": found["blender"],
        "peak_bytes": found["peak_bytes"],
    }


_COUNTED = {
    "degenerate faces": ("face", "degenerate_faces_before"),
    "non-manifold vertices": ("vertex", "non_manifold_vertices"),
    "open borders": ("vertex", "boundary_vertices"),
    "loose vertices": ("vertex", "loose_vertices"),
}
"""Defects that are known of surfaces of Blender, with names of their counts; of files see `defects_of`."""


def account(entries: Sequence[dict[str, Any]], skipped: Sequence[dict[str, str]]) -> dict[str, Any]:
    """Return what a row says about the surfaces of a file: their sums, and each by itself.

    Examples
    --------
    >>> names = ("n_vertices", "n_faces", "n_moved", "flipped_faces", "folded_faces_before", "folded_faces")
    >>> names += ("degenerate_faces_before", "non_manifold_vertices", "boundary_vertices", "loose_vertices")
    >>> names += ("welded_vertices", "displacement_rms", "displacement_max", "mean_edge_length")
    >>> one = dict.fromkeys(names, 2) | {"volume_change": None, "noise": None}
    >>> row = account([one, one | {"displacement_max": 6}], [])
    >>> row["n_vertices"], row["displacement_max"], row["displacement_max_edges"], row["folded_faces"]
    (4, 6, 3.0, 4)
    """

    def total(name: str) -> int:
        return sum(each[name] for each in entries)

    n = total("n_vertices")
    squares = sum(each["displacement_rms"] ** 2 * each["n_vertices"] for each in entries)
    changes = [each["volume_change"] for each in entries if each["volume_change"] is not None]
    edges = [each["displacement_max"] / (each["mean_edge_length"] or 1.0) for each in entries]
    return {
        "n_objects": len(entries),
        "n_vertices": n,
        "n_faces": total("n_faces"),
        "n_moved": total("n_moved"),
        "defects": [
            {"kind": kind, "count": total(name), "of": of, "first": []}
            for kind, (of, name) in _COUNTED.items()
            if total(name)
        ],
        "folded_faces_before": total("folded_faces_before"),
        "folded_faces": total("folded_faces"),
        "turned_faces": total("flipped_faces"),
        "displacement_rms": (squares / n) ** 0.5 if n else 0.0,
        "displacement_max": max((each["displacement_max"] for each in entries), default=0.0),
        "displacement_max_edges": max(edges, default=0.0),
        "volume_change": max(changes, key=abs, default=None),
        "noise": [each["noise"] for each in entries],
        "objects": list(entries),
        "skipped": list(skipped),
    }


def _check_size(source: Path, max_bytes: int | None) -> None:
    """Raise CommandError if a file alone is too large to be held twice, as it was and as it will be."""
    size = source.stat().st_size
    if max_bytes is not None and 2 * size > max_bytes:
        raise CommandError(
            f"{source} has {_text(size)} and is held twice, which is more than --max-memory "
            f"{_text(max_bytes)}; allow more, or split it."
        )


def _check_memory(opened: OpenedFile, settings: DenoiseSettings, max_bytes: int | None) -> None:
    """Raise CommandError if the work is estimated to take more memory than it may."""
    if max_bytes is None:
        return
    import numpy as np

    from ...core.memory import USUAL_VALENCE, estimated_bytes

    file = opened.file
    valences = np.bincount(file.corner_vertex, minlength=1)
    n_vertices, n_corners = len(file.positions), len(file.corner_vertex)
    needed = 2 * opened.source.stat().st_size + 2 * file.positions.nbytes + file.corner_vertex.nbytes
    needed += estimated_bytes(n_vertices, n_corners, settings, valences[valences > USUAL_VALENCE])
    if needed > max_bytes:
        raise CommandError(
            f"{opened.source} with {n_vertices:,} vertices needs about {_text(needed)} of memory, more than "
            f"--max-memory {_text(max_bytes)}; allow more, or split it."
        )


def _text(n_bytes: int) -> str:
    return f"{n_bytes / 1e9:.1f} GB" if n_bytes >= 1e8 else f"{n_bytes / 1e6:.2g} MB"
