# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The version of Framelet, for people and for reports."""

from __future__ import annotations

import tomllib
from pathlib import Path

# The manifest is the only place that states the version; extension and Python package both carry it.
_MANIFEST = Path(__file__).resolve().parents[2] / "blender_manifest.toml"


def framelet_version() -> str:
    """Return the version in the manifest."""
    with _MANIFEST.open("rb") as file:
        return tomllib.load(file)["version"]
