# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Operator in a script, command in Blender, console command: the same vertices to the last bit."""

import os
import re
import subprocess

import numpy as np
import pytest

TIMEOUT = 120

# The bpy module stands in for `blender -b --python`.
SCRIPT = """
import bpy, numpy as np
source, target, settings = sys.argv[1:]
package.register()
try:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.ply_import(filepath=source)
    obj = bpy.context.scene.objects[0]
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    settings = eval(settings)
    assert bpy.ops.object.framelet_denoise(**settings) == {"FINISHED"}
    vertices = np.empty((len(obj.data.vertices), 3), np.float32)
    obj.data.attributes["position"].data.foreach_get("vector", vertices.ravel())
    np.save(target, vertices)
finally:
    package.unregister()
"""

CONSOLE = """
from framelet.operators.command_line import main
sys.exit(main())
"""

WITHOUT_BLENDER = """
sys.modules["bpy"] = None
"""


@pytest.fixture
def run_python(python, launcher):
    """Run code in a fresh Python that knows the package."""

    def run(code, *arguments):
        words = [python, "-c", launcher + code, *map(str, arguments)]
        # The bpy module sets OCIO for its own process; one that inherits it prints a line about that.
        environment = {name: value for name, value in os.environ.items() if name != "OCIO"}
        return subprocess.run(
            words, capture_output=True, timeout=TIMEOUT, encoding="utf-8", env=environment, check=False
        )

    return run


@pytest.mark.parametrize(
    "settings",
    [{"preset": "POSITIONS", "lambda_": 0.6, "iterations": 7}, {"strength": 0.8}],
    ids=["positions", "default"],
)
def test_three_ways_give_the_same_bits(run_python, grid, write_ply, read_ply, tmp_path, settings):
    from framelet.operators.command_line import blender_command

    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    options = [word for name, value in settings.items() for word in (f"--{name.rstrip('_')}", str(value))]
    script = run_python(SCRIPT, source, tmp_path / "script.npy", settings)
    assert script.returncode == 0, script.stderr
    console = run_python(CONSOLE, "denoise", source, tmp_path / "console.ply", *options)
    assert console.returncode == 0, console.stderr
    arguments = ["denoise", str(source), str(tmp_path / "blender.ply"), *options]
    assert blender_command.run(arguments) == 0

    from_script = np.load(tmp_path / "script.npy")
    assert not np.array_equal(from_script, grid.vertices)
    np.testing.assert_array_equal(read_ply(tmp_path / "console.ply").vertices, from_script)
    np.testing.assert_array_equal(read_ply(tmp_path / "blender.ply").vertices, from_script)


def test_console_command_prints_only_its_own_lines(run_python, grid, write_ply, tmp_path):
    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    result = run_python(CONSOLE, "denoise", source, tmp_path / "out.ply")
    assert (result.returncode, result.stderr) == (0, "")
    first, done, counts, noise, last = result.stdout.splitlines()
    assert first.startswith(f"Read {source}: {len(grid.vertices)} vertices, {len(grid.faces)} faces, size ")
    assert done.startswith("Denoised in in ")
    assert "1 loose" in counts
    assert re.fullmatch(r"  noise of \S+ to \S+ \(\S+ to \S+ mean edge lengths\).*\.", noise)
    assert last == f"Wrote {tmp_path / 'out.ply'}."


def test_exit_codes_reach_the_shell(run_python, tmp_path):
    missing = run_python(CONSOLE, "denoise", tmp_path / "none.ply", tmp_path / "out.ply")
    assert (missing.returncode, missing.stdout) == (1, "")
    assert missing.stderr == f"framelet: {tmp_path / 'none.ply'} does not exist.\n"
    usage = run_python(CONSOLE, "denoise", "a.ply")
    assert (usage.returncode, usage.stdout) == (2, "")
    assert "Traceback" not in usage.stderr


def test_failure_after_import_reaches_the_shell(run_python, grid, write_ply, tmp_path):
    source = write_ply(tmp_path / "cloud.ply", grid.vertices, [])
    result = run_python(CONSOLE, "denoise", source, tmp_path / "out.ply")
    assert result.returncode == 1
    assert result.stderr.count("\n") == 1 and "has no faces" in result.stderr


@pytest.mark.parametrize("settings", [["--preset", "positions"], []], ids=["positions", "default"])
def test_with_and_without_blender_the_bytes_are_the_same(
    run_python, command, grid, write_ply, tmp_path, settings
):
    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    assert command("denoise", source, tmp_path / "with.ply", *settings).code == 0
    words = ["denoise", source, tmp_path / "without.ply", *settings]
    result = run_python(WITHOUT_BLENDER + CONSOLE, *words)
    assert (result.returncode, result.stderr) == (0, "")
    assert (tmp_path / "with.ply").read_bytes() == (tmp_path / "without.ply").read_bytes()


def test_without_blender_there_is_help(run_python):
    result = run_python(WITHOUT_BLENDER + CONSOLE, "denoise", "--help")
    assert (result.returncode, result.stderr) == (0, "")
    assert "--lambda" in result.stdout


def test_the_command_is_registered_and_taken_away(monkeypatch):
    import bpy
    from framelet.operators.command_line import blender_command

    commands = {}

    def add(name, callback):
        commands[name] = callback
        return name

    monkeypatch.setattr(blender_command, "_handle", None)
    monkeypatch.setattr(bpy.utils, "register_cli_command", add)
    monkeypatch.setattr(bpy.utils, "unregister_cli_command", commands.pop)
    blender_command.register()
    assert commands == {"framelet": blender_command.run}
    blender_command.unregister()
    assert commands == {}


def test_the_command_in_blender_says_how_it_was_called(capfd):
    from framelet.operators.command_line import blender_command

    assert blender_command.run(["denoise", "--help"]) == 0
    assert "usage: blender -c framelet denoise IN OUT" in capfd.readouterr().out
    assert blender_command.run(["denoise"]) == 2
    assert "'blender -c framelet denoise --help'" in capfd.readouterr().err
