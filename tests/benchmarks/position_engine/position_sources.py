# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Find the checkout and the cases of the quality benchmark; importing does it."""

import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent

# Behind this folder, whose modules of the same name go first.
if str(FOLDER.parent / "quality") not in sys.path:
    sys.path.append(str(FOLDER.parent / "quality"))

import sources  # noqa: E402

ROOT = sources.ROOT
