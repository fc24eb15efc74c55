# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make `training` and the `core` that it imports importable from the checkout, and make a few meshes."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))


@pytest.fixture(scope="session")
def shapes(tmp_path_factory):
    """Return a folder with small meshes: triangles, quads, polygons, and one of a spoiled volume."""
    from training.shapes.__main__ import make_shapes

    folder = tmp_path_factory.mktemp("shapes")
    for first in (600, 604, 605, 610, 612, 620, 621, 648):
        make_shapes(folder, 1, seed=1, first=first)
    return folder
