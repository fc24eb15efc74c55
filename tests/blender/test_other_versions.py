# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that other versions of Blender saved have their settings, and their results go on working."""

import subprocess
from pathlib import Path

import bpy
import numpy as np
import pytest
from stored_work import facts, make

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "tests" / "stored_work.py"
FIRST_WITH_NEW_FILES = (5, 0)
READS_NEW_FILES = (4, 5)


def run_in(version, *arguments):
    """Run the program in the environment of a version; skip where there is none."""
    python = ROOT / ".venv" / f"bpy-{version}" / "bin" / "python"
    if not python.exists():
        pytest.skip(f"needs the environment bpy-{version}, which `make test-{version}` makes")
    command = [str(python), str(PROGRAM), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("versions", [("4.2",), ("5.2",), ("4.2", "5.2")], ids="-".join)
def test_what_another_version_saved(versions, tmp_path):
    here = "{}.{}".format(*bpy.app.version)
    newest = max(tuple(map(int, version.split("."))) for version in versions)
    if versions == (here,):
        pytest.skip("is this version")
    if newest >= FIRST_WITH_NEW_FILES and bpy.app.version[:2] < READS_NEW_FILES:
        pytest.skip(f"Blender {here} cannot read files of 5.0 and newer")
    path = tmp_path / "made.blend"
    run_in(versions[0], "make", path)
    for version in versions[1:]:
        run_in(version, "save", path, tmp_path / f"{version}.blend")
        path = tmp_path / f"{version}.blend"
    make()
    expected, positions = facts()
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
    found, shown = facts()
    assert found == expected
    assert np.allclose(shown, positions, atol=1e-6)
    obj = bpy.context.view_layer.objects.active = bpy.data.objects[0]
    obj.select_set(True)
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER") == {"FINISHED"}
    assert len([group for group in bpy.data.node_groups if "framelet_kind" in group]) == 2
    assert bpy.ops.object.framelet_apply_modifier(kind="equalizer") == {"FINISHED"}
    assert bpy.ops.object.framelet_remove_modifier(kind="displacement") == {"FINISHED"}
    assert bpy.ops.object.framelet_clear() == {"FINISHED"}
    assert not [item.name for item in obj.data.attributes if "framelet" in item.name]
