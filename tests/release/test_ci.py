# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the workflows ask the files of the project: Blender versions, and notes of a release."""

import importlib.util
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = 'id = "framelet"\nversion = "1.2.0"\nblender_version_min = "4.2.0"\n'
CHANGELOG = "# Changelog\n\n## [1.2.0] - 2030-01-02\n\n- New.\n\n## [1.1.0] - 2029-01-02\n\n- Old.\n"


def load(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / ".ci" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_oldest_and_newest_blender(tmp_path):
    (tmp_path / ".ci" / "requirements").mkdir(parents=True)
    (tmp_path / "blender_manifest.toml").write_text(MANIFEST)
    for version in ("4.2", "4.10", "4.5"):
        (tmp_path / ".ci" / "requirements" / f"bpy-{version}.txt").touch()
    assert load("blenders").oldest_and_newest(tmp_path) == ["4.2", "4.10"]


def test_an_oldest_blender_without_packages_is_refused(tmp_path):
    (tmp_path / ".ci" / "requirements").mkdir(parents=True)
    (tmp_path / "blender_manifest.toml").write_text(MANIFEST)
    with pytest.raises(ValueError, match=r"Blender 4\.2 has no packages"):
        load("blenders").oldest_and_newest(tmp_path)


def test_notes_are_those_of_the_version():
    assert load("release_notes").notes("v1.2.0", MANIFEST, CHANGELOG) == "- New.\n"


@pytest.mark.parametrize(
    ("tag", "changelog", "reason"),
    [
        ("v1.3.0", CHANGELOG, r"the manifest has version 1\.2\.0"),
        ("v1.2.0", CHANGELOG.replace("2030-01-02", "in development"), "no section of 1.2.0 with the day"),
        ("v1.2.0", "# Changelog\n", "no section of 1.2.0"),
    ],
)
def test_a_release_that_is_not_ready_is_refused(tag, changelog, reason):
    with pytest.raises(ValueError, match=reason):
        load("release_notes").notes(tag, MANIFEST, changelog)


@pytest.mark.parametrize(("covered", "code"), [(19, 0), (18, 1)])
def test_too_few_branches_fail(tmp_path, capsys, covered, code):
    # All lines, so that lines and branches together are above 95 % in both cases.
    totals = {"num_statements": 80, "covered_lines": 80, "num_branches": 20, "covered_branches": covered}
    report = tmp_path / "core.json"
    report.write_text(json.dumps({"totals": totals}))
    assert load("branches").main([str(report), "--fail-under", "95"]) == code
    assert f"core: {100 * covered / 20} % of 20 branches" in capsys.readouterr().out


def test_a_report_without_branches_fails(tmp_path, capsys):
    report = tmp_path / "core.json"
    report.write_text('{"totals": {"num_statements": 80, "covered_lines": 80}}')
    assert load("branches").main([str(report), "--fail-under", "95"]) == 1
    assert "branch = true" in capsys.readouterr().err


def test_an_environment_is_made_again_when_packages_that_it_takes_in_change(tmp_path):
    environment = load("environment")
    folder = tmp_path / ".ci" / "requirements"
    folder.mkdir(parents=True)
    (folder / "core.txt").write_text("numpy==2.4.6\n")
    (folder / "hunt.txt").write_text("# What measures.\n-r core.txt\ncoverage==7.17.5\n")
    assert environment.with_included(folder / "hunt.txt") == [folder / "hunt.txt", folder / "core.txt"]
    environment.ROOT, environment.VENVS = tmp_path, tmp_path / ".venv"
    made = []
    environment.find_python = lambda versions: "python3"

    def makes(command, environment=None):
        made.append(command[1:3])
        python.parent.mkdir(parents=True, exist_ok=True)
        python.touch()
        return True

    python = environment.interpreter(tmp_path / ".venv" / "hunt")
    environment.succeeds = makes
    environment.make_environment("hunt")
    n_commands = len(made)
    environment.make_environment("hunt")
    assert len(made) == n_commands > 0
    (folder / "core.txt").write_text("numpy==2.4.6\ndask==2026.8.0\n")
    environment.make_environment("hunt")
    assert len(made) == 2 * n_commands
