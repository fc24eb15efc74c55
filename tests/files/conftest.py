# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Files and the command line without Blender."""

from pathlib import Path

import pytest
from file_fixtures import command, fails, grid, read_obj, read_ply, write_obj, write_ply  # noqa: F401

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases"


@pytest.fixture(scope="session")
def cases():
    """Give the folder with inputs that failed once."""
    if not CASES.is_dir():
        pytest.skip(f"there is no folder {CASES}")
    return CASES
