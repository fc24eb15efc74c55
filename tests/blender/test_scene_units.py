# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far vertices moved in the scene: as a loop over them says, with any scale."""

import bpy
import numpy as np
import pytest
from blender_objects import noisy_monkey
from framelet.core.settings import PRESETS
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.properties.scene_units import displacement_by
from framelet.operators.run.denoise_job import compute
from framelet.operators.run.denoise_object import read_job
from mathutils import Matrix

LINEAR = np.array([[2.0, 0.5, 0.0], [0.0, -1.0, 0.25], [0.1, 0.0, 3.0]])


def slow_displacement(linear, before, after):
    pairs = zip(before.astype(float), after.astype(float), strict=True)
    lengths = [np.linalg.norm(linear @ (b - a)) for a, b in pairs]
    return np.sqrt(np.mean(np.square(lengths))), max(lengths)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("n", [1, 7, 40_000])
def test_displacement_is_that_of_a_loop(n, dtype, rng):
    before, after = rng.normal(5.0, 1.0, (2, n, 3)).astype(dtype)
    kept = before.copy(), after.copy()
    found = [displacement_by(LINEAR, before, after, threads) for threads in (0, 1, 2, 4)]
    assert found[0] == pytest.approx(slow_displacement(LINEAR, before, after), rel=1e-12)
    assert len(set(found)) == 1, "threads change nothing"
    assert np.array_equal(before, kept[0]) and np.array_equal(after, kept[1])


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 2, 2), (1, 2, -3)])
def test_runs_measure_in_the_scene(scale, empty_scene):
    obj = noisy_monkey()
    obj.matrix_world = Matrix.Translation((1, 2, 3)) @ Matrix.Diagonal((*scale, 1))
    bpy.context.view_layer.update()
    surface = mesh_bridge.read_surface(obj)
    outcome = compute(read_job(obj, PRESETS["TRI_2"].settings))
    expected = slow_displacement(np.diag(scale), surface.vertices, outcome.vertices)
    measured = outcome.measured
    assert (measured.scene_rms, measured.scene_max) == pytest.approx(expected, rel=1e-12)
    assert expected[0] > 0
