# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the rows of a report say together, and which of them need a look."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from .progress import duration
from .rows import DONE

FAR = 3.0
"""Mean edge lengths from which on a vertex went far."""

SHRUNK = 0.02
"""Share of the volume from which on its change can be seen."""


class Look(NamedTuple):
    """How much a result needs a look, and why."""

    weight: float
    """0 for nothing unusual; a file that failed comes before all others."""
    reasons: list[str]


def look_of(row: dict[str, Any]) -> Look:
    """Return why the result of a row needs a look.

    Parameters
    ----------
    row : dict
        A row of a report.

    Returns
    -------
    Look

    Examples
    --------
    >>> row = {"status": "done", "folded_faces": 3, "folded_faces_before": 1, "displacement_max_edges": 0.5}
    >>> look_of(row).reasons
    ['2 more folded faces']
    >>> look_of({"status": "failed", "error": "It is empty."}).reasons
    ['It is empty.']
    """
    if row["status"] != DONE:
        return Look(1e9, [str(row.get("error") or "It failed.")])
    weight, reasons = 0.0, []

    def add(how_much: float, reason: str) -> None:
        nonlocal weight
        weight += how_much
        reasons.append(reason)

    skipped = row.get("skipped") or ()
    if skipped:
        add(1e6 * len(skipped), f"{len(skipped)} surfaces were skipped")
    folds = row.get("folded_faces", 0) - row.get("folded_faces_before", 0)
    if folds > 0:
        add(1e3 * folds, f"{folds} more folded faces")
    change = row.get("volume_change")
    if change is not None and abs(change) > SHRUNK:
        add(1e2 * abs(change) / SHRUNK, f"volume {change:+.1%}")
    far = row.get("displacement_max_edges", 0.0)
    if far > FAR:
        add(1e2 * far / FAR, f"a vertex moved by {far:.1f} edges")
    warnings = row.get("warnings") or ()
    if warnings:
        add(10.0 * len(warnings), str(warnings[0]))
    if not row.get("n_moved", 1) and not any((noise or {}).get("is_clean") for noise in row.get("noise", ())):
        add(10.0, "nothing moved")
    return Look(weight, reasons)


def by_need(rows: Iterable[dict[str, Any]]) -> list[tuple[dict[str, Any], Look]]:
    """Return the rows with why they need a look: those that need it most, then those that moved most."""
    looked_at = [(row, look_of(row)) for row in rows]
    return sorted(
        looked_at,
        key=lambda item: (-item[1].weight, -item[0].get("displacement_max_edges", 0.0), item[0]["output"]),
    )


def summary_lines(rows: Sequence[dict[str, Any]], n_worst: int = 10) -> list[str]:
    """Return a summary for people, and the results that need a look most.

    Parameters
    ----------
    rows : sequence of dict
        The rows of a report, one a result.
    n_worst : int
        How many results are named at most.
    """
    done = [row for row in rows if row["status"] == DONE]
    seconds = sum(sum(row.get("seconds", {}).values()) for row in rows)
    lines = [
        f"{len(rows):,} files: {len(done):,} done, {len(rows) - len(done):,} failed.",
        f"{sum(row.get('n_vertices', 0) for row in done):,} vertices; {duration(seconds)} of work; "
        f"at most {max((row.get('peak_bytes') or 0 for row in rows), default=0) / 1e6:,.0f} MB at a time.",
    ]
    worst = [(row, look) for row, look in by_need(rows) if look.reasons][:n_worst]
    if not worst:
        return [*lines, "Nothing needs a look."] if rows else lines
    width = min(40, max(len(row["output"]) for row, _look in worst))
    lines += ["", f"{'Look at':{width}}  moved  folds     volume   why"]
    for row, look in worst:
        lines.append(f"{row['output']:{width}}  {_figures(row)}  {'; '.join(look.reasons)}")
    return lines


def _figures(row: dict[str, Any]) -> str:
    """Return the figures of a row in columns."""
    if row["status"] != DONE:
        return f"{'-':>5}  {'-':<8}  {'-':<7}"
    volume = row.get("volume_change")
    folds = f"{row.get('folded_faces_before', 0)}>{row.get('folded_faces', 0)}"
    return (
        f"{row.get('displacement_max_edges', 0.0):5.2f}  {folds:<8}  "
        f"{'-' if volume is None else f'{volume:+.2%}':<7}"
    )


def noise_of(row: dict[str, Any]) -> float | None:
    """Return the strongest noise of the surfaces of a row, in mean edge lengths; None if unknown."""
    return max((each["sigma_edges"] for each in row.get("noise", ()) if each), default=None)


def defects_of(row: dict[str, Any]) -> str:
    """Return the defects of the input of a row for people.

    Examples
    --------
    >>> defects_of({"defects": [{"kind": "double faces", "count": 1200, "of": "face", "first": [5, 9]}]})
    '1,200 double faces (faces 5, 9, ...)'
    """
    parts = []
    for defect in row.get("defects") or ():
        first = ", ".join(map(str, defect["first"]))
        more = ", ..." if defect["count"] > len(defect["first"]) else ""
        where = {"face": "faces", "vertex": "vertices"}.get(defect.get("of", ""), "")
        parts.append(f"{defect['count']:,} {defect['kind']}" + (f" ({where} {first}{more})" if first else ""))
    return "; ".join(parts)


COLUMNS: tuple[tuple[str, Callable[[dict[str, Any]], Any]], ...] = (
    *((name, lambda row, name=name: row.get(name)) for name in ("status", "input", "output", "error")),
    ("look", lambda row: "; ".join(look_of(row).reasons)),
    *(
        (name, lambda row, name=name: row.get(name))
        for name in (
            "preset", "n_objects", "n_vertices", "n_faces", "n_moved", "displacement_rms", "displacement_max",
            "displacement_max_edges", "folded_faces_before", "folded_faces", "turned_faces", "volume_change",
            "peak_bytes", "framelet", "blender", "input_sha256", "output_sha256",
        )
    ),
    ("defects", lambda row: defects_of(row)),
    ("noise_edges", lambda row: noise_of(row)),
    ("seconds", lambda row: sum(row.get("seconds", {}).values())),
)  # fmt: skip
"""The columns of a table: names, and how they are taken from a row."""


def as_csv(rows: Iterable[dict[str, Any]]) -> str:
    """Return a table of the rows; what a spreadsheet would take for a formula begins with an apostrophe.

    Examples
    --------
    >>> row = {"status": "failed", "input": "/a.ply", "output": "=1+1", "error": "It is empty."}
    >>> as_csv([row]).splitlines()[1][:40]
    "failed,/a.ply,'=1+1,It is empty.,It is e"
    """
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([name for name, _value in COLUMNS])
    for row in rows:
        writer.writerow([_cell(value(row)) for _name, value in COLUMNS])
    return text.getvalue()


def _cell(value: Any) -> Any:
    return "'" + value if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t")) else value
