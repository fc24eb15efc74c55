# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keep Blender's own lines about files out of the output of a command."""

from __future__ import annotations

import ctypes
import io
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress


class CapturedOutput:
    """What Blender printed; `text` is complete once the context is left."""

    def __init__(self) -> None:
        self.text = ""

    def problems(self) -> list[str]:
        """Return the lines about parts of a file that an importer left out."""
        lines = (
            re.search(r"(Invalid|OBJ element not recognized).*", line) for line in self.text.splitlines()
        )
        return ["".join(c if c.isprintable() else "?" for c in line[0])[:100] for line in lines if line]


@contextmanager
def captured_output() -> Iterator[CapturedOutput]:
    """Send what Blender prints into a file for a while.

    Importers and exporters print from C++, past `sys.stdout`, so the file descriptors are redirected; the
    reports of operators come through `sys.stdout`, which need not be one of them.
    """
    captured = CapturedOutput()
    printed = io.StringIO()
    _flush()
    try:
        saved = [os.dup(number) for number in (1, 2)]
    except OSError:  # there is no output at all
        yield captured
        return
    with tempfile.TemporaryFile() as file:
        for number in (1, 2):
            os.dup2(file.fileno(), number)
        try:
            with redirect_stdout(printed), redirect_stderr(printed):
                yield captured
        finally:
            _flush()
            for number, copy in zip((1, 2), saved, strict=True):
                os.dup2(copy, number)
                os.close(copy)
            file.seek(0)
            captured.text = file.read().decode("utf-8", "replace") + printed.getvalue()


def _flush() -> None:
    """Flush Python's streams and those of C."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError, OSError, ValueError):
            stream.flush()
    with suppress(AttributeError, OSError):
        ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)
