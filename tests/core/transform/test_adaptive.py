# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks that fit the valence (section 6): tight, with measures pulled back; no ring has a start."""

import numpy as np
import pytest
from checks import lengths
from framelet.core import BANKS, DenoiseSettings, connect, denoise, make_transform
from framelet.core.frames.valence_masks import (
    LARGEST_MATRIX,
    HarmonicBank,
    PairwiseBank,
    harmonic_groups,
    harmonic_masks,
    low_pass_weights,
)
from meshes import MESHES, bow_tie, flipped, noisy, pyramid, three_pages, triangle_torus, union
from stars import relabeled, star
from stencil_twins import MeshTwin, dilated, neighbors_by

EXACT = 1e-13


def matrix_of(bank):
    """Return the mask-matrix of a bank, column by column."""
    columns = np.eye(bank.valence + 1)[None].repeat(3, axis=0)
    return bank.apply(columns)[1]


def ring_points(valence, rng):
    """Return a center and a regular flat ring around it, somewhere in space."""
    angle = 2 * np.pi * np.arange(valence) / valence
    u, w, center = rng.normal(size=(3, 3))
    w -= u * (u @ w) / (u @ u)
    w *= np.linalg.norm(u) / np.linalg.norm(w)
    return np.concatenate(([center], center + np.outer(np.cos(angle), u) + np.outer(np.sin(angle), w)))


@pytest.mark.parametrize("is_ordered", [True, False])
def test_masks_are_tight_at_every_valence(is_ordered, rng):
    """M'M = diag(w), row 0 is w, the others sum to zero; also by reflection, above 32 or unordered."""
    for valence in range(41):
        bank = HarmonicBank(valence, is_ordered)
        masks, weights = matrix_of(bank), low_pass_weights(valence)
        assert weights.shape == (valence + 1,)
        assert weights.min() > 0
        assert weights.sum() == pytest.approx(1, abs=EXACT)
        assert np.abs(masks.T @ masks - np.diag(weights)).max() < EXACT
        assert np.abs(masks[0] - weights).max() < EXACT
        assert np.abs(masks[1:].sum(axis=1)).max(initial=0) < EXACT
        data = rng.normal(size=(3, valence + 1, 5))
        assert np.abs(bank.apply(data) - np.einsum("bt,ctn->cbn", masks, data)).max() < EXACT
        assert np.abs(bank.apply_transposed(data) - np.einsum("bt,cbn->ctn", masks, data)).max() < EXACT
        apart = np.abs(masks - matrix_of(HarmonicBank(valence, False))).max()
        assert (apart > 0.01) == (is_ordered and 2 <= valence <= LARGEST_MATRIX)


@pytest.mark.parametrize("valence", [3, 4, 5, 6, 7, 12, 31, 32])
def test_rows_are_ring_harmonics(valence, rng):
    """On a regular flat ring only frequency 1 is left; row 1 is ring against center; bumps are seen."""
    masks, points = harmonic_masks(valence), ring_points(valence, rng)
    seen = lengths(masks @ points)
    assert seen[1] < EXACT
    assert seen[2:4].min() > 0.1 * lengths(points[1] - points[0]) / np.sqrt(valence)
    assert seen[4:].max(initial=0) < EXACT * 10
    angle = 2 * np.pi * np.arange(valence) / valence
    groups = np.split(np.arange(1, valence + 1), harmonic_groups(valence)[1:])
    assert groups[0].tolist() == [1]
    for frequency, rows in enumerate(groups[1:], 1):
        for wave in (np.cos(frequency * angle), np.sin(frequency * angle)):
            response = masks @ np.concatenate(([0.0], wave))
            outside = np.delete(np.arange(valence + 1), rows)
            assert np.abs(response[outside]).max() < EXACT
            assert np.linalg.norm(response) > 0.1 or np.linalg.norm(wave) < 1e-9


def test_norms_of_groups_do_not_know_where_a_ring_starts(rng):
    for valence in range(1, LARGEST_MATRIX + 1):
        masks, groups = harmonic_masks(valence), harmonic_groups(valence)
        center, *ring = rng.normal(size=valence + 1)

        def norms(ring, masks=masks, groups=groups, center=center):
            return np.add.reduceat((masks[1:] @ [center, *ring]) ** 2, groups)

        for turned in (np.roll(ring, 1), np.roll(ring, -3), ring[::-1]):
            assert np.abs(norms(turned) - norms(ring)).max() < EXACT * 10
        swapped = [*ring[1::-1], *ring[2:]]
        assert np.abs(norms(swapped) - norms(ring)).max() > 1e-6 or valence < 4


def test_six_neighbors_have_the_low_pass_of_the_box_spline(rng):
    assert np.array_equal(low_pass_weights(6), BANKS["BOX_SPLINE_111"].low_pass)
    mesh = noisy(triangle_torus(), rng)
    adaptive, box = (make_transform(mesh, name) for name in ("ADAPTIVE", "BOX_SPLINE_111"))
    assert np.allclose(
        adaptive.analyze(mesh.vertices).low, box.analyze(mesh.vertices).low, rtol=0, atol=1e-14
    )


@pytest.mark.parametrize("valence", [0, 1, 2, 3, 5, 11])
def test_pairwise_differences_are_tight_for_any_weights(valence, rng):
    """|L p|^2 + sum w_i w_j |p_i - p_j|^2 = sum w_i |p_i|^2, for random weights and by default."""
    random = rng.exponential(size=valence + 1)
    for given in (None, random / random.sum()):
        bank = PairwiseBank(valence, given)
        weights = low_pass_weights(valence) if given is None else given
        data = rng.normal(size=(3, valence + 1, 4))
        found = bank.apply(data)
        low = sum(weights[i] * data[:, i] for i in range(valence + 1))
        apart = [
            np.sqrt(weights[i] * weights[j]) * (data[:, i] - data[:, j])
            for i in range(valence + 1)
            for j in range(i + 1, valence + 1)
        ]
        assert found.shape == (3, 1 + len(apart), 4)
        assert np.abs(found - np.stack([low, *apart], axis=1)).max() < EXACT
        assert (found**2).sum() == pytest.approx((weights[:, None] * data**2).sum(), rel=1e-13)
        assert np.abs(bank.apply_transposed(found) - weights[:, None] * data).max() < EXACT


@pytest.mark.parametrize("frame", ["ADAPTIVE", "PAIRWISE"])
@pytest.mark.parametrize("n_levels", [1, 2, 3])
def test_measures_are_pulled_back(frame, n_levels, rng):
    """m_L = 1 and m_j(p) = sum of w_t m_{j+1}(k) over the stencils k that name p, over dilated rings."""
    mesh = noisy(union(flipped(triangle_torus(6, 7)), MESHES["mixed sheet"](), three_pages()), rng)
    transform = make_transform(mesh, frame, levels=n_levels)
    twin = MeshTwin(mesh)
    near = neighbors_by(twin, 3)
    neighbors, low = [], mesh.vertices
    for level in range(n_levels):
        twin.points = low
        taps = [dilated(twin, v, twin.ring[v], near, level, 1) for v in range(mesh.n_vertices)]
        neighbors.append([[w for w in own if w >= 0] for own in taps])
        low = np.array(
            [
                low[v] if not own else 0.25 * low[v] + 0.75 * low[own].mean(axis=0)
                for v, own in enumerate(neighbors[-1])
            ]
        )
    assert np.allclose(transform.analyze(mesh.vertices).low, low, rtol=0, atol=1e-12)
    expected = [np.ones(mesh.n_vertices)]
    for stencils in reversed(neighbors):
        measure = np.zeros(mesh.n_vertices)
        for v, own in enumerate(stencils):
            for w, weight in zip([v, *own], low_pass_weights(len(own)), strict=True):
                measure[w] += weight * expected[0][v]
        expected.insert(0, measure)
    for found, own in zip(transform.measures(), expected, strict=True):
        assert np.allclose(found, own, rtol=1e-12)
        assert found.min() > 0
        assert found.sum() == pytest.approx(mesh.n_vertices)  # nothing is lost on the way


@pytest.mark.parametrize("n_levels", [1, 2])
@pytest.mark.parametrize("frame", ["ADAPTIVE", "PAIRWISE"])
@pytest.mark.parametrize("kind", ["irregular", "mixed", "high valence", "non-manifold"])
def test_renumbering_changes_nothing(kind, frame, n_levels, rng):
    """Rings then start elsewhere: cosine and sine turn into each other, and are shrunk as one."""
    build = {
        "irregular": lambda: flipped(triangle_torus(7, 9)),
        "mixed": lambda: union(MESHES["mixed sheet"](), star(5, 2, 4)[0]),
        "high valence": lambda: union(pyramid(LARGEST_MATRIX + 9, closed=True), star(9, 3, 3)[0]),
        "non-manifold": lambda: union(three_pages(), bow_tie(3, 4)),
    }[kind]
    mesh = noisy(build(), rng)
    other, old = relabeled(mesh, rng)
    settings = DenoiseSettings(method="POSITIONS", frame=frame, levels=n_levels, boundary="FREE", lambda_=0.3)
    one, two = (denoise(m, settings, dtype=np.float64).vertices for m in (mesh, other))
    assert lengths(two - one[old]).max() < 1e-11
    assert lengths(one - mesh.vertices).max() > 0.01


def test_frequency_one_and_borders_are_left_alone(rng):
    """First differences measure how vertices lie in the surface; shrinking them would pull it together."""
    assert HarmonicBank(7).unpenalized == slice(1, 3)
    assert HarmonicBank(2).unpenalized == HarmonicBank(7, False).unpenalized == slice(0, 0)
    mesh = noisy(flipped(MESHES["triangle grid"](), seed=1), rng)
    is_rim = connect(mesh).is_boundary
    for boundary in ("ALONG", "FREE"):
        level = make_transform(mesh, "ADAPTIVE", boundary=boundary).levels[0]
        for index, sites in enumerate(level.sites):
            is_kept = level.unpenalized(index) == slice(None)
            assert (is_rim[sites] & (boundary == "ALONG") == is_kept).all()
