# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Manifests: tables with one row a mesh, as CSV or as JSON Lines."""

from __future__ import annotations

import csv
import io
import json
import os
import re
from pathlib import Path
from typing import NamedTuple

from ...core.value_checks import shown
from .inputs import PlanError

_OPTION = re.compile(r"[a-z][a-z0-9-]*")


class Row(NamedTuple):
    """A row: the file to read, relative to the manifest, and what it says besides."""

    source: Path
    output: str
    format: str
    options: list[str]
    """Words of a command line, each ``--name=value``."""
    error: str
    """Why the row cannot be understood, in one sentence; empty if it can."""


def read_manifest(path: Path) -> list[Row]:
    """Read a manifest.

    Parameters
    ----------
    path : Path
        A ``.csv`` file with a line of names, or a ``.jsonl`` file with an object a line. The column `input`
        is needed; `output` and `format` are understood; all others are options of ``framelet denoise``,
        without the dashes. An empty cell is no option; ``true`` and ``false`` are those of switches.

    Returns
    -------
    list of Row

    Raises
    ------
    PlanError
        If the file cannot be read, or no row can be told from another.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "scans.csv"
    >>> _ = path.write_text("input,strength,weld\\na.ply,0.5,true\\nb.ply,,\\n")
    >>> [(row.source.name, row.options) for row in read_manifest(path)]
    [('a.ply', ['--strength=0.5', '--weld']), ('b.ply', [])]
    """
    kind = path.suffix.lower()
    if kind not in (".csv", ".jsonl"):
        raise PlanError(f"The manifest cannot be {path}; its name must end in .csv or .jsonl.")
    try:
        text = path.read_text("utf-8-sig")
    except OSError as error:
        raise PlanError(f"{path} cannot be read: {error.strerror or error}.") from error
    except UnicodeDecodeError as error:
        raise PlanError(f"{path} is no text in UTF-8; save it as such.") from error
    rows = _csv_rows(text, path) if kind == ".csv" else _json_rows(text, path)
    return [_row(values, path, where) for where, values in rows]


def _csv_rows(text: str, path: Path) -> list[tuple[str, dict[str, object]]]:
    reader = csv.DictReader(io.StringIO(text, newline=""), strict=True)
    try:
        names = reader.fieldnames or ()
        if "input" not in names:
            raise PlanError(f"{path} has no column ‘input’; its first line must name the columns.")
        if twice := next((name for name in names if names.count(name) > 1), None):
            raise PlanError(f"{path} has two columns ‘{twice}’; leave one of them out.")
        return [(f"line {reader.line_num}", dict(row)) for row in reader]
    except csv.Error as error:
        raise PlanError(f"{path}, line {reader.line_num}: {error}.") from error


def _json_rows(text: str, path: Path) -> list[tuple[str, dict[str, object]]]:
    rows = []
    # Not at other line ends, as U+2028, which JSON texts may hold.
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip():
            continue
        try:
            values = json.loads(line)
        except (ValueError, RecursionError) as error:  # the second where it is nested too deep
            raise PlanError(f"{path}, line {number}, is no JSON: {error}.") from error
        if not isinstance(values, dict):
            raise PlanError(f"{path}, line {number}, is no JSON object; write one a line.")
        rows.append((f"line {number}", values))
    return rows


def _row(values: dict[str, object], path: Path, where: str) -> Row:
    """Return what a row says, its options as words of a command line."""
    named = {key: _text(value) for key, value in values.items() if key is not None}
    source = named.pop("input", "")
    output, kind = named.pop("output", ""), named.pop("format", "")
    error = "" if source else f"{path}, {where}, names no input."
    for key in ("input", "output", "format"):
        if not isinstance(values.get(key), str | None):
            error = f"{path}, {where}: ‘{key}’ is {shown(values[key])}; it must be a text."
        elif not _can_be_a_name(values.get(key)):
            error = f"{path}, {where}: no file can be named as ‘{key}’ is: {shown(values[key])}."
    if None in values:
        error = f"{path}, {where}, has more cells than there are columns."
    options = []
    for key, value in named.items():
        name = key.strip().replace("_", "-").rstrip("-")
        if not _OPTION.fullmatch(name):
            error = f"{path}, {where}: ‘{key}’ is no option."
        elif value in ("true", "false"):
            options.append(f"--{name}" if value == "true" else f"--no-{name}")
        elif value:
            options.append(f"--{name}={value}")
    # Inputs are where the manifest is, wherever the command is run.
    return Row(path.parent / source, output, kind, options, error)


def _can_be_a_name(text: object) -> bool:
    """Return whether the system takes a text as the name of a file."""
    try:
        return "\0" not in os.fsdecode(os.fsencode(str(text)))
    except UnicodeEncodeError:
        return False


def _text(value: object) -> str:
    """Return a cell as it is typed."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value).strip()
