# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which net is taken: by what is measured over each island, and by the user's word."""

from itertools import pairwise

import numpy as np
from framelet.core import DenoiseSettings, denoise, vertex_normals
from framelet.core.learned import width as width_module
from framelet.core.learned.features import N_GLOBAL
from framelet.core.learned.net import N_LAYERS
from framelet.core.learned.width import wide_share
from framelet.core.methods import learned_shrinkage
from meshes import noisy, triangle_torus, union

AUTO = DenoiseSettings(method="AUTO", threads=1)


def smooth_noise(mesh, rng, n_averages, sigma=0.2):
    """Return a mesh with noise along its normals that neighbors share, in mean edges."""
    heights = rng.normal(size=mesh.n_vertices)
    ends = np.concatenate((mesh.edges, mesh.edges[:, ::-1]))
    valence = np.bincount(ends[:, 0], minlength=mesh.n_vertices)
    for _ in range(n_averages):
        around = np.bincount(ends[:, 0], heights[ends[:, 1]], mesh.n_vertices) / valence
        heights = (heights + around) / 2
    steps = mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]]
    heights *= sigma * np.linalg.norm(steps, axis=1).mean() / np.sqrt((heights**2).mean())
    return mesh.with_vertices(mesh.vertices + vertex_normals(mesh) * heights[:, None])


def test_the_choice_is_a_regression(rng):
    with np.load(width_module.ARRAYS) as file:
        arrays = {name: file[name].astype(float) for name in file.files}
    rows = rng.normal(size=(200, N_GLOBAL)) * 3 * arrays["scale"] + arrays["mean"]
    expected = []
    for row in rows:
        z = np.clip((row - arrays["mean"]) / arrays["scale"], -3, 3)
        products = [z[i] * z[j] for i in range(len(z)) for j in range(i, len(z))]
        gain = float(np.dot([1, *z, *products], arrays["weights"]))
        expected.append(min(max(0.5 + gain / 0.04, 0), 1))
    found = wide_share(rows.astype(np.float32), np.full(200, 2000))
    assert found.dtype == np.float32 and np.abs(found - expected).max() < 0.01
    assert 0 < found.mean() < 1
    assert not wide_share(rows.astype(np.float32), np.full(200, 1999)).any()


def solved(mesh, noise="AUTO"):
    return denoise(mesh, AUTO.with_changes(noise=noise, passes=1)).vertices


def test_white_noise_is_fine_and_smooth_noise_is_wide(rng):
    torus = triangle_torus(40, 60)
    for mesh, width, other in (
        (noisy(torus, rng, 0.5), "FINE", "WIDE"),
        (smooth_noise(torus, rng, 2), "WIDE", "FINE"),
    ):
        found = solved(mesh)
        assert np.array_equal(found, solved(mesh, width))
        assert not np.array_equal(found, solved(mesh, other))


def test_where_nothing_is_sure_both_nets_have_a_share(rng, monkeypatch):
    mesh = noisy(triangle_torus(20, 20), rng, 0.1)
    results = []
    for gain in (-0.03, -0.005, 0.0, 0.005, 0.03):
        found = np.clip(np.float32(0.5 + gain / 0.04), 0, 1)
        monkeypatch.setattr(learned_shrinkage, "wide_share", lambda *_, own=found: np.array([own]))
        results.append(solved(mesh))
    fine, wide = solved(mesh, "FINE"), solved(mesh, "WIDE")
    assert np.array_equal(results[0], fine) and np.array_equal(results[-1], wide)
    steps = [np.abs(after - before).max() for before, after in pairwise(results)]
    assert min(steps) > 0 and max(steps) < np.abs(wide - fine).max()


def test_progress_and_cancel_see_both_nets(rng, monkeypatch):
    """As often as one net would, each at half of the step, and up to 1."""
    monkeypatch.setattr(learned_shrinkage, "wide_share", lambda *_: np.array([0.5], np.float32))
    mesh, told = noisy(triangle_torus(20, 20), rng, 0.1), []
    denoise(mesh, AUTO, callback=lambda done, _change: told.append(done) and False)
    assert told == sorted(told) and told[-1] == 1 and max(np.diff(told)) <= 1 / learned_shrinkage.TICKS
    assert len(told) >= 2 * (2 * N_LAYERS + 2)
    stopped = denoise(mesh, AUTO, callback=lambda done, _change: done > told[2]).report
    assert stopped.is_stopped


def test_each_island_has_the_net_that_it_needs(rng):
    torus = triangle_torus(40, 60)
    one, other = noisy(torus, rng, 0.5), smooth_noise(torus, rng, 2)
    found = solved(union(one, other)).reshape(2, -1, 3)
    for own, mesh, width in zip(found, (one, other), ("FINE", "WIDE"), strict=True):
        alone = solved(mesh, width)
        alone += (own - alone).mean(axis=0)  # `union` puts them apart
        assert np.abs(own - alone).max() < 0.01
