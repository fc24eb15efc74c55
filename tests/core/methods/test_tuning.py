# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""λ, μ and iterations from the noise of the mesh."""

import numpy as np
import pytest
from framelet.core import PRESETS, add_noise, compare, denoise
from framelet.core.methods.positions import tuned
from framelet.core.noise import NoiseEstimate
from meshes import triangle_grid, triangle_torus

PAPER = ("TRI_1", "TRI_2", "POSITIONS")


def estimate(sigma: float, rms: float | None = None) -> NoiseEstimate:
    return NoiseEstimate(sigma, sigma, sigma, rms is not None, rms or sigma)


@pytest.mark.parametrize("preset", ["TRI_1", "TRI_2", "QUAD_1", "QUAD_2", "POSITIONS"])
def test_lambda_is_proportional_to_the_noise(preset):
    settings = PRESETS[preset].settings
    frame = "LINEAR_SPLINE" if preset.startswith("QUAD") else "BOX_SPLINE_111"
    small, large = (tuned(settings, frame, estimate(sigma)).lambda_ for sigma in (0.1, 0.2))
    assert large == pytest.approx(2.0 * small) and small > 0.0


def test_impulsive_noise_counts_by_its_root_mean_square():
    settings = PRESETS["TRI_2"].settings
    found = tuned(settings, "BOX_SPLINE_111", estimate(0.1, rms=0.15))
    assert found.lambda_ == pytest.approx(tuned(settings, "BOX_SPLINE_111", estimate(0.15)).lambda_)


@pytest.mark.parametrize("preset", PAPER)
def test_it_removes_noise_and_says_what_it_used(preset):
    clean = triangle_torus(24, 40)
    noisy = clean.with_vertices(add_noise(clean, 0.2))
    given = PRESETS[preset].settings.with_changes(tuning="NOISE", lambda_=77.0, mu=3.0, iterations=2)
    result = denoise(noisy, given)
    used = result.report.settings
    assert result.report.noise is not None and (used.mu, used.iterations) == (1.0, 10)
    assert used.lambda_ != 77.0
    before = compare(noisy, clean).mean_angle
    assert compare(noisy.with_vertices(result.vertices), clean).mean_angle < 0.5 * before
    plain = denoise(noisy, used.with_changes(tuning="GIVEN"))
    np.testing.assert_array_equal(plain.vertices, result.vertices)
    assert plain.report.noise is None


def test_a_flat_mesh_stays():
    mesh = triangle_grid(12, 12)
    result = denoise(mesh, PRESETS["TRI_2"].settings.with_changes(tuning="NOISE"))
    assert result.report.settings.lambda_ == pytest.approx(0.0, abs=1e-3)
    np.testing.assert_allclose(result.vertices, mesh.vertices, atol=1e-6)
