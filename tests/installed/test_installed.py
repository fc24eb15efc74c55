# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Test the zip that users install, not the files of the repository."""

import importlib.util
import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("lifecycle.py")
ZIP = Path(os.environ.get("FRAMELET_ZIP", ""))
IS_REQUIRED = os.environ.get("FRAMELET_REQUIRE_BLENDER") == "1"

if not IS_REQUIRED:
    if importlib.util.find_spec("bpy") is None:
        pytest.skip("needs the module bpy", allow_module_level=True)
    if not ZIP.is_file():
        pytest.skip("FRAMELET_ZIP does not name a zip: run `make extension`", allow_module_level=True)

pytestmark = pytest.mark.installed


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """What lifecycle.py saw, in a Blender whose user folders are empty."""
    home = str(tmp_path_factory.mktemp("home"))
    environment = {**os.environ, "HOME": home, "USERPROFILE": home, "BLENDER_USER_RESOURCES": home}
    result = subprocess.run(
        [sys.executable, str(SCRIPT), str(ZIP)],
        cwd=home,  # so that nothing is imported from the repository
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=300,
    )
    # Code -11 at the very end on 4.2: a module with a PropertyGroup says `import bpy`. That Blender
    # never frees such a class, which through its functions keeps bpy alive until too late; the
    # module must import the names it needs from bpy.types and bpy.props instead.
    assert result.returncode == 0, result.stdout + result.stderr
    return json.loads(result.stdout.splitlines()[-1])


def test_zip_holds_what_runs_and_nothing_else():
    with zipfile.ZipFile(ZIP) as archive:
        names = [name for name in archive.namelist() if not name.endswith("/")]
    assert {"blender_manifest.toml", "__init__.py", "LICENSE"} <= set(names)
    for folder in ("core", "operators", "ui"):
        assert f"{folder}/__init__.py" in names
    root_files = {"blender_manifest.toml", "__init__.py", "LICENSE"}
    extra = [name for name in names if name not in root_files and not is_code(name)]
    # What the engine learned, without which it cannot run, and the job type for Blender's farm manager.
    learned = [f"core/learned/{name}.npz" for name in ("fine", "wide")]
    assert sorted(extra) == [*learned, "operators/farm/framelet_denoise.js"]


def is_code(name):
    return name.startswith(("core/", "operators/", "ui/")) and name.endswith(".py")


def test_blender_starts_without_us(seen):
    assert seen["before"] == []


def test_zip_installs_and_enables(seen):
    assert seen["installed"] == ["FINISHED"]
    assert seen["enabled"]


@pytest.mark.parametrize(
    "trace",
    [
        "Scene.framelet",
        "WindowManager.framelet_report",
        "bpy.ops.object.framelet_denoise",
        "bpy.ops.object.framelet_add_noise",
        "command framelet",
    ],
)
def test_enabled_extension_shows(seen, trace):
    assert trace in seen["traces"]


@pytest.mark.parametrize("use", ["first_use", "second_use"])
def test_installed_operators_work(seen, use):
    assert seen[use]["polls"]
    assert seen[use]["finished"] == [["FINISHED"], ["FINISHED"]]
    assert seen[use]["finite"]
    assert seen[use]["moved_by_noise"] > 1e-4
    assert seen[use]["moved_by_denoise"] > 1e-4


def test_disable_leaves_nothing(seen):
    assert not seen["enabled_after_disable"]
    assert seen["traces_after_disable"] == []


def test_enable_again_restores_all(seen):
    assert seen["enabled_again"]
    assert seen["traces_again"] == seen["traces"]
