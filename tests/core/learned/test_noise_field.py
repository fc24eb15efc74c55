# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise as a field: how strong and how wide it is at each vertex."""

import doctest

import numpy as np
import pytest
from framelet.core import PRESETS, NoiseBelief, add_noise, connect, denoise, noise_field
from framelet.core.averages.ring_means import RingMeans
from framelet.core.learned import noise_field as field_module
from framelet.core.mesh.geometry import vertex_normals
from kinds import ALONE, KIND, KINDS
from learned_twins import SPREAD, averaging, ring_matrix
from meshes import noisy, quad_torus, triangle_torus

SHAPES = {"triangles": lambda: triangle_torus(40, 80), "quads": lambda: quad_torus(40, 80)}
SHAPE = pytest.mark.parametrize("shape", SHAPES)


def lifted(mesh, heights):
    """Return the mesh with its vertices moved along their normals."""
    return mesh.with_vertices(mesh.vertices + vertex_normals(mesh) * heights[:, None])


def averaged(mesh, heights, n_averages):
    """Return heights averaged with the ring, as strong as before."""
    rings = RingMeans(mesh, connect(mesh), ALONE)
    smooth = rings.inward(heights[:, None])
    for _ in range(n_averages):
        smooth = 0.5 * (smooth + rings.mean(smooth))
    smooth = rings.outward(smooth)[:, 0]
    return smooth * np.sqrt((heights**2).mean() / (smooth**2).mean())


@SHAPE
@pytest.mark.parametrize("strength", [0.001, 0.03, 0.1])
def test_white_noise_along_the_normals_has_its_strength_and_no_width(shape, strength, rng):
    clean = SHAPES[shape]()
    field = noise_field(lifted(clean, strength * rng.normal(size=clean.n_vertices)), clean.vertices)
    assert field.strength.shape == field.width.shape == (clean.n_vertices,)
    assert np.sqrt((field.strength**2).mean()) == pytest.approx(strength, rel=0.05)
    assert np.abs(field.strength / strength - 1).max() < 0.4
    assert np.median(field.width) < 0.25


@SHAPE
def test_uneven_noise_gives_its_field(shape, rng):
    clean = SHAPES[shape]()
    wanted = 0.02 * np.exp(1.2 * clean.vertices[:, 0] / 4)
    field = noise_field(lifted(clean, wanted * rng.normal(size=clean.n_vertices)), clean.vertices)
    assert np.corrcoef(np.log(field.strength), np.log(wanted))[0, 1] > 0.95
    assert np.abs(np.log(field.strength / wanted)).mean() < 0.12


@SHAPE
def test_the_width_rises_with_averaging(shape, rng):
    clean = SHAPES[shape]()
    heights = 0.05 * rng.normal(size=clean.n_vertices)
    widths = [
        np.median(noise_field(lifted(clean, averaged(clean, heights, k)), clean.vertices).width)
        for k in (0, 1, 2, 4, 8, 16)
    ]
    assert widths == sorted(set(widths))
    assert widths[-1] > 1.5 > 0.6 > widths[1]


def test_the_field_does_not_depend_on_scale_and_place(rng):
    clean = SHAPES["triangles"]()
    noise = lifted(clean, 0.05 * rng.normal(size=clean.n_vertices))
    expected = noise_field(noise, clean.vertices)
    found = noise_field(noise.with_vertices(1000 * noise.vertices + 5), 1000 * clean.vertices + 5)
    assert np.allclose(found.strength, 1000 * expected.strength, rtol=1e-3)
    assert np.allclose(found.width, expected.width, atol=0.02)


@KIND
def test_the_field_against_dense_matrices(kind, rng):
    """Squares and products with the ring's mean, both averaged; the width from their ratio."""
    mesh = KINDS[kind]()
    after = noisy(mesh, rng, 0.1)
    field = noise_field(noisy(mesh, rng, 0.2), after.vertices)
    assert np.isfinite(field.strength).all() and np.isfinite(field.width).all()
    assert (field.strength >= 0).all() and (field.width >= 0).all()
    assert not field.strength[connect(mesh).is_loose].any()


def test_strength_and_width_are_those_of_a_loop(rng):
    clean = triangle_torus(12, 16)
    heights = 0.1 * rng.normal(size=clean.n_vertices)
    field = noise_field(lifted(clean, heights), clean.vertices)
    offset = (vertex_normals(clean) * (lifted(clean, heights).vertices - clean.vertices)).sum(axis=1)
    wide = averaging(ring_matrix(clean), SPREAD)
    square, product = wide @ offset**2, wide @ (offset * (ring_matrix(clean) @ offset))
    ratio = np.clip(product / square, 0, 0.999)
    width = [0.5 / np.sqrt(-np.log(r)) if r > 0.02 else 0.0 for r in ratio]
    # Series are cut off after a hundredth.
    assert np.abs(field.strength / np.sqrt(square) - 1).max() < 0.02
    assert np.abs(field.width - width)[np.abs(ratio - 0.02) > 0.01].max() < 0.06


def test_nothing_taken_away_is_no_noise():
    clean = triangle_torus()
    field = noise_field(clean, clean.vertices)
    assert not field.strength.any() and not field.width.any()


def test_other_positions_are_refused_in_one_sentence():
    clean = triangle_torus()
    with pytest.raises(ValueError, match=r"^The positions have shape .*\.$"):
        noise_field(clean, clean.vertices[:-1])


def test_the_example():
    assert doctest.testmod(field_module).failed == 0


@SHAPE
def test_a_run_tells_what_it_took_for_noise(shape):
    """The same as the field, in the mean."""
    clean = SHAPES[shape]()
    noise = clean.with_vertices(add_noise(clean, 0.2, seed=1))
    result = denoise(noise, PRESETS["AUTO"].settings)
    belief, edge = result.report.noise, result.report.mean_edge_length
    assert isinstance(belief, NoiseBelief) and not belief.is_clean
    assert 0.12 < belief.sigma / edge < 0.25
    assert belief.sigma_low <= belief.sigma <= belief.sigma_high
    assert belief.clean == 0 and belief.spikes < 0.01 and belief.width < 0.4
    field = noise_field(noise, result.vertices)
    assert np.sqrt((field.strength.astype(float) ** 2).mean()) == pytest.approx(belief.sigma, rel=0.02)


def test_what_a_run_took_for_noise_follows_the_noise(rng):
    """Uneven noise has a wide range, wide noise a width, spikes a share, and clean parts another."""
    clean = triangle_torus(60, 120)
    auto = PRESETS["AUTO"].settings

    def belief_of(heights, settings=auto):
        return denoise(lifted(clean, heights), settings).report.noise

    white = rng.normal(size=clean.n_vertices)
    even = belief_of(0.02 * white)
    uneven = belief_of(0.03 * np.exp(0.5 * clean.vertices[:, 0]) / 3 * white)
    assert uneven.sigma_high / uneven.sigma_low > 2 * even.sigma_high / even.sigma_low
    wide = belief_of(averaged(clean, 0.03 * white, 4), auto.with_changes(noise="WIDE"))
    assert wide.width > even.width + 0.3
    spikes = belief_of(np.where(np.arange(clean.n_vertices) % 100 == 50, 0.4, 0.0))
    assert spikes.spikes == pytest.approx(0.01, abs=0.004) and spikes.clean > 0.9
    half = belief_of(np.where(clean.vertices[:, 0] > 0, 0.04 * white, 0))
    assert 0.3 < half.clean < 0.6
    assert belief_of(0 * white).is_clean
