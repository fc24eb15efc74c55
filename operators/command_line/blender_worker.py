# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The script that `blender_process` runs in a Blender of its own; its argument is a file with the job.

It ends the process itself, because drivers and importers can leave threads that keep it from ending.
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


def end_with_parent() -> None:
    """Let the system end this process with the one that started it, so that none goes on unseen."""
    if sys.platform.startswith("linux"):
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_ENDS_WITH_PARENT, _SIGKILL)


def work() -> int:
    """Load the package from the folder it is in, and carry out the job."""
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)
    from framelet.operators.command_line import blender_jobs

    job = json.loads(Path(sys.argv[-1]).read_text("ascii"))
    return blender_jobs.carry_out(job)


if __name__ == "__main__":
    end_with_parent()
    try:
        code = work()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(code)
