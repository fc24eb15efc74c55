# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command in a Blender application: `blender -c framelet denoise IN OUT`."""

from __future__ import annotations

from typing import Any

import bpy

from . import main

_handle: Any = None


def run(argv: list[str]) -> int:
    """Run the command line; Blender calls this with what follows `framelet`, and exits with the result."""
    return main(argv, "blender -c framelet")


def register() -> None:
    """Add the command to Blender."""
    global _handle
    _handle = bpy.utils.register_cli_command("framelet", run)


def unregister() -> None:
    """Take the command away."""
    global _handle
    bpy.utils.unregister_cli_command(_handle)
    _handle = None
