# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The core stands alone: no Blender, and nothing is imported before it is used."""

import subprocess
import sys
from pathlib import Path

import framelet.core as core
import pytest

ROOT = Path(core.__file__).resolve().parent.parent
PROGRAM = """
import importlib.util, sys
for name in ("bpy", "bmesh", "mathutils"):
    sys.modules[name] = None  # importing it fails
spec = importlib.util.spec_from_file_location("framelet", {init!r}, submodule_search_locations=[{root!r}])
package = importlib.util.module_from_spec(spec)
sys.modules["framelet"] = package
import framelet.core
loaded = [name for name in sys.modules if name.startswith("framelet.core.")]
assert not loaded, loaded
assert "numpy" not in sys.modules
for name in framelet.core.__all__:
    getattr(framelet.core, name)
mesh = framelet.core.SurfaceMesh.from_faces([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
result = framelet.core.denoise(mesh)
sys.stdout.write(str(result.report.n_vertices))
"""


def test_the_core_runs_without_blender_and_imports_late():
    program = PROGRAM.format(init=str(ROOT / "__init__.py"), root=str(ROOT))
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "3"  # and the core prints nothing


def test_public_names():
    assert set(core.__all__) == set(core._HOMES)
    for name in core.__all__:
        assert getattr(core, name) is not None
    with pytest.raises(AttributeError, match="has no attribute 'missing'"):
        core.missing  # noqa: B018
