# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The script of a process of a batch: jobs as lines on its input, rows as lines on its output.

It needs no Blender; what Blender alone can read is worked on in a process of its own, as everywhere.
"""

import ctypes
import importlib.util
import json
import os
import sys
from contextlib import suppress
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
_ENDS_WITH_PARENT = 1  # PR_SET_PDEATHSIG
_SIGKILL = 9


def load_package() -> None:
    """Load the package from the folder it is in."""
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)


def end_with_parent() -> None:
    """Let the system end this process with the one that started it, so that none goes on unseen."""
    if sys.platform.startswith("linux"):
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_ENDS_WITH_PARENT, _SIGKILL)
    # It may have ended before this was said.
    if hasattr(os, "getppid") and os.getppid() != int(sys.argv[1]):
        sys.exit(1)


def serve() -> None:
    """Carry out jobs until there are no more."""
    from framelet.core.processors import set_default_threads
    from framelet.operators.batch.workers import MARK
    from framelet.operators.command_line.batch_task import carry_out

    if threads := os.environ.get("FRAMELET_THREADS"):
        set_default_threads(int(threads))
    for line in sys.stdin.buffer:
        row = carry_out(json.loads(line))
        sys.stdout.write(f"\n{MARK}{json.dumps(row)}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    end_with_parent()
    load_package()
    serve()
