# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The job type for Flamenco, compiled by Node.js with Flamenco's interface in few lines, and carried out."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest
from framelet.operators.command_line import main

from .conftest import rows_of

SCRIPT = Path(__file__).resolve().parents[2] / "operators" / "farm" / "framelet_denoise.js"
START = ["--background", "--python-exit-code", "1", "-c", "framelet"]

# What Flamenco gives to a script, by its documentation: author, path and the job.
INTERFACE = """
const fs = require("fs"), vm = require("vm"), nodePath = require("path");
class Command { constructor(name, parameters) { this.name = name; this.parameters = parameters; } }
class Task {
  constructor(name, type) { Object.assign(this, { name, type, commands: [], dependencies: [] }); }
  addCommand(command) { this.commands.push(command); }
  addDependency(task) { this.dependencies.push(task.name); }
}
const author = { Task: (...a) => new Task(...a), Command: (...a) => new Command(...a) };
const tasks = [];
const given = JSON.parse(process.argv[1]);
const context = vm.createContext({ author, path: nodePath.posix });
vm.runInContext(fs.readFileSync(given.script, "utf8") + "; globalThis.JOB_TYPE = JOB_TYPE;", context);
const settings = {};
for (const item of context.JOB_TYPE.settings) {
  if (item.default !== undefined) settings[item.key] = item.default;
}
Object.assign(settings, given.settings);
context.compileJob({ settings, addTask: (task) => tasks.push(task) });
console.log(JSON.stringify({ type: context.JOB_TYPE, tasks }));
"""


@pytest.fixture
def compiled():
    """A function that compiles a job with some settings."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node.js is not installed")

    def compile_job(**settings):
        given = json.dumps({"script": str(SCRIPT), "settings": settings})
        done = subprocess.run([node, "-e", INTERFACE, given], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return compile_job


def test_tasks(compiled):
    job = compiled(manifest="/farm/my scans.csv", out="/farm/out", slices=3, options=" --preset  tri-2 ")
    assert {item["type"] for item in job["type"]["settings"]} == {"string", "int32"}
    *slices, report = job["tasks"]
    assert [task["name"] for task in slices] == [f"denoise-{number}-of-3" for number in (1, 2, 3)]
    for number, task in enumerate(slices, 1):
        assert task["type"] == "blender" and task["dependencies"] == []
        (command,) = task["commands"]
        assert command["name"] == "exec" and command["parameters"]["exe"] == "{blender}"
        assert command["parameters"]["args"] == [
            *START, "batch", "--manifest", "/farm/my scans.csv", "--out", "/farm/out",
            "--slice", f"{number}/3", "--preset", "tri-2",
        ]  # fmt: skip
    with_jobs = compiled(manifest="a.csv", out="/out", slices=1, jobs=4)["tasks"][0]
    assert with_jobs["commands"][0]["parameters"]["args"][-4:] == ["--slice", "1/1", "--jobs", "4"]
    assert report["dependencies"] == [task["name"] for task in slices]
    assert report["commands"][0]["parameters"]["args"] == [
        *START, "report", "/farm/out", "--html", "/farm/out/report.html",
    ]  # fmt: skip


def test_the_commands_are_understood(compiled, scans, tmp_path):
    manifest, out = tmp_path / "scans.csv", tmp_path / "out"
    lines = [f"{path},{path.parent.name}_{path.name}" for path in sorted(scans.rglob("*.obj"))]
    manifest.write_text("input,output\n" + "\n".join(lines) + "\n")
    job = compiled(manifest=str(manifest), out=str(out), slices=2, options="--preset tri-2")
    for task in (*job["tasks"], job["tasks"][0]):  # a farm may do a task twice
        words = task["commands"][0]["parameters"]["args"]
        assert words[: len(START)] == START
        assert main(words[len(START) :]) == 0
    assert len(rows_of(out / "report-1-of-2.jsonl")) == len(rows_of(out / "report-2-of-2.jsonl")) == 3
    assert len(list(out.glob("*.obj"))) == 6
    assert (out / "report.html").read_text().count("<article") == 6
