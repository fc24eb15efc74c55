# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Load the checkout as the package `framelet`, and find the helpers of the tests; importing does both."""

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def load_framelet() -> None:
    """Make `import framelet` mean this checkout, and not a version that may be installed."""
    if "framelet" in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)


sys.path.append(str(ROOT / "tests" / "benchmarks"))
if str(ROOT / "tests") not in sys.path:
    sys.path.insert(0, str(ROOT / "tests"))
load_framelet()
