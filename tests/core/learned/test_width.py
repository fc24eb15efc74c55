# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which net is taken: by what is measured over each island, and by the user's word."""

from itertools import pairwise

import numpy as np
import pytest
from framelet.core import DenoiseSettings, connect, denoise, vertex_normals
from framelet.core.blocks import Blocks
from framelet.core.learned.engine import FaceEngine
from framelet.core.learned.net import N_LAYERS
from framelet.core.learned.residual import Residual
from framelet.core.learned.width import shared_share, strong_share
from framelet.core.methods import learned_shrinkage
from learned_twins import polygons_of
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


def test_shares_are_of_correlation_and_strength(rng):
    mesh = noisy(union(triangle_torus(20, 20), triangle_torus(16, 24)), rng, 0.2)
    engine = FaceEngine(mesh, connect(mesh), Blocks(1))
    unit, size = rng.uniform(0.5, 2, (2, mesh.n_vertices)).astype(np.float32)
    faces = polygons_of(mesh)
    some = np.flatnonzero(rng.random(len(faces)) < 0.5)
    counted = [some, slice(None)]
    found = []
    for middle, level in ((-0.5, 0.01), (0.012, 0.033), (0.015, 0.035), (0.018, 0.037), (0.5, 0.2)):
        correlation = (middle + 0.02 * rng.normal(size=mesh.n_vertices)).astype(np.float32)
        residual = Residual(np.float32(level) * size, correlation)
        relative = residual.strength / unit
        both = [own(residual, unit, engine.graph, counted) for own in (shared_share, strong_share)]
        for shared, strong, own in zip(*both, (some, range(len(faces))), strict=True):
            corners = [v for f in own for v in faces[f]]
            mean = np.average(correlation[corners], weights=relative[corners])
            assert shared == pytest.approx(np.clip(0.5 + (mean - 0.015) / 0.02, 0, 1), abs=1e-4)
            root = np.sqrt(np.mean(relative[corners].astype(float) ** 2))
            assert strong == pytest.approx(np.clip(0.5 + (root - 0.045) / 0.01, 0, 1), abs=1e-3)
        found.append([share[1] for share in both])
    for shares in zip(*found, strict=True):
        assert list(shares) == sorted(shares)
        assert shares[0] == 0 and 0 < shares[2] < 1 and shares[-1] == 1
    nothing = Residual(np.zeros_like(size), np.zeros_like(size))
    assert not shared_share(nothing, unit, engine.graph, counted).any()
    assert not strong_share(nothing, unit, engine.graph, counted).any()


def solved(mesh, noise="AUTO", **changes):
    return denoise(mesh, AUTO.with_changes(noise=noise, passes=1, **changes)).vertices


def test_white_noise_is_fine_and_smooth_noise_is_wide(rng):
    torus = triangle_torus(40, 60)
    few = triangle_torus(12, 20)
    for mesh, width, other in (
        (noisy(torus, rng, 0.5), "FINE", "WIDE"),
        (smooth_noise(torus, rng, 2), "WIDE", "FINE"),
        (noisy(few, rng, 0.2), "FINE", "WIDE"),
        (smooth_noise(few, rng, 2), "WIDE", "FINE"),
    ):
        for strength in (1, 0.3, 2.5):
            found = solved(mesh, strength=strength)
            assert np.array_equal(found, solved(mesh, width, strength=strength))
            assert not np.array_equal(found, solved(mesh, other, strength=strength))


def share_both(monkeypatch, share):
    """Give the net for wide noise this share, whatever is measured."""
    found = np.array([share], np.float32)
    monkeypatch.setattr(learned_shrinkage, "shared_share", lambda *_: found.copy())
    monkeypatch.setattr(learned_shrinkage, "strong_share", lambda *_: np.ones_like(found))


def test_relief_is_no_wide_noise(rng):
    """What is faint and shared by neighbors stays with the net for fine noise."""
    torus = triangle_torus(40, 60)
    faint = noisy(smooth_noise(torus, rng, 6, 0.04), rng, 0.01)
    assert np.array_equal(solved(faint), solved(faint, "FINE"))
    assert not np.array_equal(solved(faint), solved(faint, "WIDE"))


def test_where_nothing_is_sure_both_nets_have_a_share(rng, monkeypatch):
    mesh = noisy(triangle_torus(20, 20), rng, 0.1)
    results = []
    for gain in (-0.03, -0.005, 0.0, 0.005, 0.03):
        found = np.clip(np.float32(0.5 + gain / 0.04), 0, 1)
        share_both(monkeypatch, found)
        results.append(solved(mesh))
    fine, wide = solved(mesh, "FINE"), solved(mesh, "WIDE")
    assert np.array_equal(results[0], fine) and np.array_equal(results[-1], wide)
    steps = [np.abs(after - before).max() for before, after in pairwise(results)]
    assert min(steps) > 0 and max(steps) < np.abs(wide - fine).max()


def test_progress_and_cancel_see_both_nets(rng, monkeypatch):
    """As often as one net would, each at half of the step, and up to 1."""
    share_both(monkeypatch, 0.5)
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
