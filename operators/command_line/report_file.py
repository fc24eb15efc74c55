# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a run as a JSON file; of a run that failed, too."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...core.learned.noise_field import NoiseBelief
from ...core.report import DenoiseReport
from ...core.settings import DenoiseSettings
from ..files.mesh_file import FileError
from ..files.safe_write import Outputs, check_target
from ..properties.region_options import RegionOptions
from . import explained
from .file_types import is_same_file
from .mesh_work import Outcome
from .messages import USAGE_ERROR, CommandError
from .version import framelet_version


class Report:
    """What was done, or why it could not be done.

    Parameters
    ----------
    path : Path or None
        The JSON file; None writes none.
    source, target : Path
        What is read and written, as it was typed.
    preset : str
        Key of the preset that the settings started from.
    settings : DenoiseSettings
        The settings asked for; their names in the file are those of the fields, so that
        ``DenoiseSettings(**report["settings"])`` gives them back.
    options : RegionOptions
        Where vertices could move and how far; under "region" in the file.
    """

    def __init__(
        self,
        path: Path | None,
        source: Path,
        target: Path,
        preset: str,
        settings: DenoiseSettings,
        options: RegionOptions,
    ) -> None:
        self._path, self._source, self._target = path, source, target
        self._can_be_written = False
        self._content: dict[str, Any] = {
            "framelet": framelet_version(),
            "blender": None,
            "input": str(source),
            "output": str(target),
            "preset": preset,
            "settings": asdict(settings),
            "region": asdict(options),
            "error": None,
            "objects": [],
            "skipped": [],
        }

    def check(self) -> None:
        """Raise CommandError or FileError if the file cannot be written."""
        path = self._path
        if path is None:
            return
        for other in (self._source, self._target):
            if str(path) == str(other) or is_same_file(path, other):
                raise CommandError(f"The report cannot be {path}, which is a mesh file here.", USAGE_ERROR)
        if path.suffix.lower() != ".json":
            raise CommandError(f"The report cannot be {path}; its name must end in .json.", USAGE_ERROR)
        check_target(path)
        self._can_be_written = True

    def add(self, outcome: Outcome) -> None:
        """Add what came of the surfaces of a file."""
        self._content["objects"] = [{"name": name, **entry(report)} for name, report in outcome.done]
        self._content["skipped"] = [{"name": name, "reason": reason} for name, reason in outcome.refusals]

    def add_entries(
        self, entries: Sequence[dict[str, Any]], skipped: Sequence[dict[str, str]], blender: str
    ) -> None:
        """Add what a process of Blender says came of its objects, and its version."""
        self._content |= {"objects": list(entries), "skipped": list(skipped), "blender": blender}

    def write(self, outputs: Outputs) -> None:
        """Write the file, if one was asked for, with the other outputs."""
        if self._path is not None:
            outputs.write(self._path, self.as_json())

    def as_json(self) -> bytes:
        """Return the text of the file."""
        text = json.dumps(plain(self._content), indent=2, ensure_ascii=False, allow_nan=False)
        # A file name that is not UTF-8 becomes an escape that JSON knows.
        return (text + "\n").encode("utf-8", "backslashreplace")

    @contextmanager
    def of_failure(self) -> Iterator[None]:
        """Write the file, with the sentence that is told, if what happens within raises an error."""
        try:
            yield
        except BaseException as error:
            if self._path is not None and self._can_be_written:
                # What went wrong is more important than that it cannot be written down.
                with suppress(FileError, OSError, KeyboardInterrupt):
                    self._content["error"] = explained(error)[0]
                    with Outputs() as outputs:
                        outputs.write(self._path, self.as_json())
                        outputs.publish()
            raise


def entry(report: DenoiseReport) -> dict[str, Any]:
    """Return a report, with its noise in edge lengths, too, and whether the mesh was clean."""
    result, noise = asdict(report), report.noise
    if isinstance(noise, NoiseBelief):
        for name in ("sigma_low", "sigma_high"):
            result["noise"][f"{name}_edges"] = getattr(noise, name) / report.mean_edge_length
        result["noise"]["is_clean"] = noise.is_clean
    return result


def plain(value: Any) -> Any:
    """Return a value with NumPy's scalars as Python's, and numbers that JSON has no word for as None."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
