# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Load the checkout as the package `framelet`; importing does it."""

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "tests" / "benchmarks"))

if "framelet" not in sys.modules:
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)
