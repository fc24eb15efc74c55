# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as CSV files, and back."""

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, TypeVar

Record = TypeVar("Record", bound=NamedTuple)


def write_records(records: Sequence[Record], path: Path) -> None:
    """Write records, at least one, of one kind; numbers that there are not stay empty."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(name.rstrip("_") for name in records[0]._fields)
        writer.writerows([_written(value) for value in record] for record in records)


def read_records(kind: type[Record], path: Path) -> list[Record]:
    """Read what `write_records` wrote."""
    readers = {"int": int, "float": _read_float, "bool": lambda word: word == "True", "str": str}
    types = [getattr(kind.__annotations__[name], "__name__", "str") for name in kind._fields]
    with path.open(encoding="utf-8", newline="") as file:
        lines = list(csv.reader(file))[1:]
    return [kind(*(readers[name](word) for name, word in zip(types, line, strict=True))) for line in lines]


def _written(value: object) -> object:
    """Return a value with as many digits as tell anything."""
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.6g}"
    return value


def _read_float(word: str) -> float:
    """Return a number, NaN for an empty word."""
    return float(word) if word else math.nan
