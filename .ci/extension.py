# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Validate the extension and build its zip with Blender's own tool.

Run with the Python of a bpy environment, 4.5 or newer; no Blender application is needed.
"""

import importlib.util
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def main() -> int:
    """Build ``build/framelet-<version>.zip`` and return the exit code."""
    tool = find_tool()
    if tool is None:
        print("extension: no blender_ext.py in the bpy module; is this a bpy environment?", file=sys.stderr)
        return 1
    output = ROOT / "build"
    output.mkdir(exist_ok=True)
    # A zip of an earlier version must not be mistaken for this one.
    for old in output.glob("framelet-*.zip"):
        old.unlink()
    for arguments in (
        ["validate", str(ROOT)],
        ["build", "--source-dir", str(ROOT), "--output-dir", str(output)],
    ):
        code = subprocess.call([sys.executable, str(tool), *arguments])
        if code:
            return code
    return 0


def find_tool() -> Path | None:
    """Return the path of blender_ext.py inside the bpy module, which is not imported."""
    spec = importlib.util.find_spec("bpy")
    if spec is None or spec.origin is None:
        return None
    pattern = "*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
    return next(Path(spec.origin).parent.glob(pattern), None)


if __name__ == "__main__":
    sys.exit(main())
