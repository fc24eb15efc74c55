# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Run each recipe of the cookbook as it stands in the document, and look at what it did."""

import re
from pathlib import Path

import numpy as np
import pytest

COOKBOOK = Path(__file__).resolve().parents[2] / "docs" / "scripts" / "cookbook.md"
HEADING = re.compile(r"^## (\d+)\. .*$", re.MULTILINE)
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def read_recipes():
    """Return the code of each recipe by its number."""
    parts = HEADING.split(COOKBOOK.read_text(encoding="utf-8"))
    recipes = {}
    for number, text in zip(parts[1::2], parts[2::2], strict=True):
        recipes[int(number)] = BLOCK.findall(text)
    return recipes


RECIPES = read_recipes()


@pytest.fixture
def ball(empty_scene, tmp_path, monkeypatch):
    """A noisy ball that is selected and active, and a folder with two scans in the working directory."""
    import bpy

    monkeypatch.chdir(tmp_path)
    (tmp_path / "scans").mkdir()
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    bpy.ops.object.framelet_add_noise(sigma=0.2, seed=3)
    for name in ("one", "two"):
        bpy.ops.wm.ply_export(filepath=str(tmp_path / "scans" / f"{name}.ply"))
    obj = bpy.context.object
    obj.name = "Ball"
    return obj


def positions(obj):
    array = np.empty((len(obj.data.vertices), 3), np.float32)
    obj.data.attributes["position"].data.foreach_get("vector", array.reshape(-1))
    return array


def roughness(vertices):
    """Return how much the radii of a ball differ."""
    return float(np.linalg.norm(vertices, axis=1).std())


def run(number):
    scope = {"__name__": "recipe"}
    exec(compile("".join(RECIPES[number]), f"recipe {number}", "exec"), scope)
    return scope


def test_there_are_ten_recipes_with_a_block_each():
    assert list(RECIPES) == list(range(1, 11))
    assert [number for number, blocks in RECIPES.items() if len(blocks) != 1] == []


@pytest.mark.parametrize("number", [1, 3, 6])
def test_recipes_that_clean_the_active_mesh(ball, number):
    before = roughness(positions(ball))
    run(number)
    assert roughness(positions(ball)) < 0.5 * before


def test_preset_as_a_shape_key(ball):
    before = positions(ball)
    key = run(2)["key"]
    assert np.array_equal(positions(ball), before)
    points = np.empty(3 * len(before), np.float32)
    key.points.foreach_get("co", points)
    assert roughness(points.reshape(-1, 3)) < 0.5 * roughness(before)
    assert ball.data.shape_keys.animation_data.action is not None


def test_part_of_the_mesh(ball):
    before = positions(ball)
    run(4)
    after = positions(ball)
    is_upper = before[:, 2] > 0.0
    assert np.array_equal(after[~is_upper], before[~is_upper])
    assert (after[is_upper] != before[is_upper]).any(axis=1).mean() > 0.9


def test_colors_of_a_run(ball):
    run(6)
    assert len(ball.data.color_attributes.active_color.data) == len(ball.data.vertices)


def test_folder_of_scans(ball, tmp_path):
    import bpy

    run(5)
    for name in ("one", "two"):
        bpy.ops.wm.ply_import(filepath=str(tmp_path / "scans" / f"{name}_clean.ply"))
        assert roughness(positions(bpy.context.object)) < 0.5 * roughness(positions(ball))


def test_equalizer(ball):
    before = positions(ball)
    run(7)
    assert 0.0 < np.abs(positions(ball) - before).max() < 0.5


def test_arrays():
    result = run(8)["result"]
    assert result.vertices.shape == (3600, 3)
    assert result.report.displacement_rms > 0.0


def test_progress_and_stop():
    result = run(9)["result"]
    assert 1 <= result.report.iterations < 10000


def test_comparison(ball):
    found = run(10)["found"]
    assert found.other_name == ball.name
    assert 0.0 < found.rms_distance_edges < 0.5
    assert found.mean_angle > 0.0
