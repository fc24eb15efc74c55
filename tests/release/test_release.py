# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Rules that hold for every release: versions, licenses, layers, file sizes."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SPDX = [
    "# SPDX-FileCopyrightText: 2026 Framelet contributors",
    "# SPDX-License-Identifier: GPL-3.0-or-later",
]
MAX_LINES = 350
MADE = re.compile(r"\.git|\.?venv|build|dist|__pycache__|\..*_cache|\.hypothesis")
TEXT = {".py", ".md", ".toml", ".txt", ".yml", ".yaml", ".json", ".sh", ".svg", ".cfg", ".csv", ""}
MACHINE_PATH = re.compile(r"(?<![\w.~*)\]}:/])/(?:home|root|Users|work|workspace|mnt|tmp)/\w")

# Loads the package as the test configuration does, in a fresh interpreter where the
# modules in `blocked` cannot be imported, then runs `body`.
PROBE = """
import importlib, importlib.util, pkgutil, sys
from pathlib import Path

class Blocker:
    def find_spec(self, name, path=None, target=None):
        if any(name == b or name.startswith(b + ".") for b in {blocked!r}):
            raise ImportError(f"{{name}} is out of bounds here")

sys.meta_path.insert(0, Blocker())
root = Path({root!r})
spec = importlib.util.spec_from_file_location(
    "framelet", root / "__init__.py", submodule_search_locations=[str(root)]
)
framelet = sys.modules["framelet"] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(framelet)
{body}
"""


def project_files():
    """Yield the files of the project, without those that tools have made."""
    for folder, folders, files in os.walk(ROOT):
        folders[:] = sorted(name for name in folders if not MADE.fullmatch(name))
        yield from (Path(folder, name) for name in sorted(files) if not MADE.fullmatch(name))


def python_files(*folders):
    """Return all Python files of the project, or those below some of its folders."""
    files = [path for path in project_files() if path.suffix == ".py"]
    return [path for path in files if not folders or path.relative_to(ROOT).parts[0] in folders]


def package_files():
    """Return the Python files that users get."""
    return python_files("__init__.py", "core", "operators", "ui")


def names(paths):
    """Return paths as readable strings, for assertions that say which file is wrong."""
    return [str(path.relative_to(ROOT)) for path in paths]


def manifest():
    return tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))


def probe(blocked, body):
    code = PROBE.format(blocked=blocked, root=str(ROOT), body=body)
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)


def test_version_has_a_changelog_entry():
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    entries = re.findall(r"^## \[?(\d+\.\d+\.\d+)", changelog, re.MULTILINE)
    assert manifest()["version"] in entries


def test_oldest_blender_is_tested():
    oldest = manifest()["blender_version_min"].rsplit(".", 1)[0]
    assert (ROOT / ".ci" / "requirements" / f"bpy-{oldest}.txt").is_file()


def test_manifest_texts_fit():
    texts = [manifest()["tagline"], *manifest().get("permissions", {}).values()]
    assert [text for text in texts if len(text) > 64 or text.endswith(".")] == []


def test_files_carry_the_license():
    paths = python_files()
    assert len(paths) > 10
    wrong = [path for path in paths if path.read_text(encoding="utf-8").splitlines()[:2] != SPDX]
    assert names(wrong) == []


def test_package_does_not_name_its_install_location():
    # Users may install the extension in another repository than the default one.
    wrong = [path for path in package_files() if "bl_" + "ext." in path.read_text(encoding="utf-8")]
    assert names(wrong) == []


def test_no_paths_of_one_machine():
    wrong = [
        path
        for path in project_files()
        if path.suffix in TEXT and MACHINE_PATH.search(path.read_text(encoding="utf-8"))
    ]
    assert names(wrong) == []


def test_files_are_short():
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in package_files()}
    wrong = [path for path, length in lengths.items() if length > MAX_LINES]
    assert names(wrong) == []


def test_root_imports_nothing():
    result = probe(["bpy", "numpy"], "assert callable(framelet.register) and callable(framelet.unregister)")
    assert result.returncode == 0, result.stderr


def test_core_stands_alone():
    # In a fresh process: here other tests may have imported what core/ must do without.
    blocked = ["bpy", "bmesh", "mathutils", "bpy_extras", "gpu", "framelet.ui"]
    body = """
core = importlib.import_module("framelet.core")
found = list(pkgutil.walk_packages(core.__path__, "framelet.core.", onerror=lambda name: None))
for module in found:
    importlib.import_module(module.name)
print(len(found))
print(*sorted(name for name in sys.modules if name.startswith("framelet.operators")))
"""
    result = probe(blocked, body)
    assert result.returncode == 0, result.stderr
    number, others = result.stdout.splitlines()
    assert int(number) == len(python_files("core")) - 1
    # The package itself asks how many processors there are.
    assert others.split() == ["framelet.operators", "framelet.operators.machine"]


@pytest.mark.parametrize("blocked", ["bpy", "framelet.operators"])
def test_probe_blocks(blocked):
    result = probe([blocked], f"importlib.import_module({blocked!r})")
    assert "out of bounds" in result.stderr


def test_the_check_closes_no_pipe_early():
    """With pipefail, a program that writes into a closed pipe fails the check, now and then only."""
    text = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "set -euo pipefail" in text
    assert not re.search(r"\|\s*(head|grep -q)\b", text)
