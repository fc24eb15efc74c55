# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a process that Dask started on this computer does first: load this very Framelet, without Blender.

The package is not always installed where Python looks for packages: Blender keeps its extensions elsewhere.
"""

import importlib.util
import signal
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def load_package() -> None:
    """Load the package from the folder it is in, whatever other one is installed."""
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)


if __name__ == "__main__":
    # Ctrl-C reaches all processes of a terminal; it is for the one that waits, which ends this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    load_package()
