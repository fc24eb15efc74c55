# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much memory this process has, as the system counts it."""

from pathlib import Path

import pytest

STATUS = Path("/proc/self/status")


def resident_megabytes():
    """Return the resident memory; skip the test where the system does not say it."""
    if not STATUS.is_file():
        pytest.skip("needs /proc/self/status")
    line = next(line for line in STATUS.read_text().splitlines() if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1000.0
