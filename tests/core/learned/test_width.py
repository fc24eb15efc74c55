# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which net is taken: by what is measured over each island, and by the user's word."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import DenoiseSettings, denoise, metrics
from framelet.core.learned import width as width_module
from framelet.core.learned.features import N_GLOBAL
from framelet.core.learned.width import find_wide
from meshes import noisy, quad_torus, triangle_torus, union

AUTO = DenoiseSettings(method="AUTO", threads=1)


def smooth_noise(mesh, rng, n_averages, sigma=0.2):
    """Return a mesh with noise along its normals that neighbors share, in mean edges."""
    heights = rng.normal(size=mesh.n_vertices)
    one, two = mesh.edges.T
    valence = np.bincount(mesh.edges.ravel(), minlength=mesh.n_vertices)
    for _ in range(n_averages):
        total = np.bincount(one, heights[two], mesh.n_vertices) + np.bincount(two, heights[one], mesh.n_vertices)
        heights = (heights + total / valence) / 2
    edge = np.linalg.norm(mesh.vertices[one] - mesh.vertices[two], axis=1).mean()
    heights *= sigma * edge / np.sqrt((heights**2).mean())
    return mesh.with_vertices(mesh.vertices + metrics.vertex_normals(mesh) * heights[:, None])


def test_a_row_is_a_regression(rng):
    with np.load(width_module.ARRAYS) as file:
        arrays = {name: file[name].astype(float) for name in file.files}
    rows = rng.normal(size=(200, N_GLOBAL)) * 3 * arrays["scale"] + arrays["mean"]
    expected = []
    for row in rows:
        hidden = np.tanh(((row - arrays["mean"]) / arrays["scale"]) @ arrays["enter"] + arrays["enter_bias"])
        expected.append(float(hidden @ arrays["leave"]) > float(arrays["least"]))
    found = find_wide(rows.astype(np.float32))
    assert found.dtype == bool and found.tolist() == expected
    assert 0 < found.sum() < len(found)
