# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Enabling the extension imports what draws and registers, and nothing that computes."""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
ALLOWED = {"core", "core.settings", "core.errors", "core.value_checks", "core.processors"}
"""Rooms of core that are read before anything is computed."""

NO_ROOMS = ("core.learned", "core.methods", "core.transform", "core.mesh")
UNUSED = {
    "operators.bands.bands",
    "operators.denoise_report",
    "operators.preview.preview_session",
    "operators.run.assembly",
    "operators.run.denoise_job",
    "operators.run.denoise_object",
    "operators.run.denoise_run",
    "operators.run.output",
}
"""Modules that only a run, a preview or an analysis needs: they are imported where they are used."""

PROGRAM = """
import importlib.util, json, sys
import bpy
sys.modules["numpy"] = None  # Blender may have it already; from here on, importing it fails
before = set(sys.modules)
spec = importlib.util.spec_from_file_location("framelet", {init!r}, submodule_search_locations=[{root!r}])
package = importlib.util.module_from_spec(spec)
sys.modules["framelet"] = package
spec.loader.exec_module(package)
package.register()
bpy.ops.mesh.primitive_plane_add()
try:
    loaded = sorted(set(sys.modules) - before)
    for name in dir(bpy.ops.object):
        if name.startswith("framelet_"):
            getattr(bpy.ops.object, name).poll()  # as Blender does for each button that it draws
    drawn = sorted(set(sys.modules) - before)
finally:
    package.unregister()
sys.stdout.write("\\n" + json.dumps([loaded, drawn]) + "\\n")
"""


def test_enabling_imports_no_numpy_and_nothing_that_computes():
    program = PROGRAM.format(init=str(ROOT / "__init__.py"), root=str(ROOT))
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
    loaded, drawn = json.loads(done.stdout.strip().splitlines()[-1])
    assert drawn == loaded, "to ask whether a button can be pressed loads nothing"
    ours = {name.partition(".")[2] for name in loaded if name.startswith("framelet.")}
    assert "operators.denoise" in ours
    assert not {name for name in ours if name in UNUSED or name.startswith(NO_ROOMS)}
    assert {".".join(name.split(".")[:2]) for name in ours if name.split(".")[0] == "core"} <= ALLOWED
    assert not [name for name in loaded if name.split(".")[0] == "numpy"]
