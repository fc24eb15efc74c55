# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver against (4.10) written out, and what must hold for any mesh."""

import numpy as np
import pytest
from checks import AS_SOLVED, TRIANGLE_BANKS, edge_length, lengths, read_only
from framelet.core import DenoiseSettings, denoise, make_stencil
from framelet.core.mesh.connectivity import connect
from meshes import MESHES, flipped, mixed_sheet, noisy, triangle_torus
from twins import split_bregman

SAME = 1e-10
"""Mean edge lengths by which the fast and the literal iteration may differ after a few steps in float64."""

SETTINGS = [
    {"stencil": "MEAN", "shrinkage": "BANDS", "lambda_": 0.5},
    {"stencil": "STRAIGHT", "shrinkage": "VECTOR", "lambda_": 0.3},
    {"stencil": "MEAN", "shrinkage": "SCALAR", "lambda_": 0.2, "mu": 2.5},
    {"stencil": "STRAIGHT", "shrinkage": "BANDS", "lambda_": 0.1, "delta": 0.1, "mu": 0.4},
    {"stencil": "STRAIGHT", "shrinkage": "VECTOR", "lambda_": 0.4, "delta": 1.0, "mu": 20.0},
]


def literal(mesh, settings, hold=()):
    """Return what (4.10) gives, in the units and around the center in which the solver works."""
    edge = edge_length(mesh)
    stencil = make_stencil(mesh, connect(mesh), settings.stencil, settings.boundary)
    solved = split_bregman(
        mesh.vertices / edge, stencil.data_matrix, TRIANGLE_BANKS[settings.frame], settings, hold
    )
    return solved * edge


@pytest.mark.parametrize("frame", TRIANGLE_BANKS)
@pytest.mark.parametrize("changes", SETTINGS)
@pytest.mark.parametrize("name", ["triangle torus", "irregular torus", "prism", "octahedron", "soup"])
def test_matches_the_literal_iteration(name, changes, frame, rng):
    mesh = read_only(noisy(MESHES[name](), rng))
    settings = DenoiseSettings(method="POSITIONS", frame=frame, boundary="FREE", iterations=4, **changes)
    result = denoise(mesh, settings, dtype=np.float64, region=AS_SOLVED)
    expected = literal(mesh, settings, hold=np.flatnonzero(connect(mesh).is_loose))
    assert lengths(result.vertices - expected).max() < SAME * result.report.mean_edge_length
    assert lengths(expected - mesh.vertices).max() > 1e-3 * result.report.mean_edge_length


@pytest.mark.parametrize("changes", SETTINGS)
def test_matches_the_literal_iteration_with_a_fixed_border(changes, rng):
    mesh = noisy(mixed_sheet(), rng)
    settings = DenoiseSettings(
        method="POSITIONS", frame="BOX_SPLINE_111", boundary="FIXED", iterations=5, **changes
    )
    connectivity = connect(mesh)
    hold = np.flatnonzero(connectivity.is_boundary | connectivity.is_loose)
    result = denoise(mesh, settings, dtype=np.float64, region=AS_SOLVED)
    assert lengths(result.vertices - literal(mesh, settings, hold)).max() < SAME


@pytest.mark.parametrize("shrinkage", ["BANDS", "VECTOR", "SCALAR"])
@pytest.mark.parametrize(
    ("rule", "frame"), [("MEAN", "BOX_SPLINE_111_CANONICAL"), ("STRAIGHT", "BOX_SPLINE_111")]
)
def test_displacement_bound_at_convergence(shrinkage, rule, frame, rng):
    """S = S~ - mu (b1 + b2 + b3) at a fixed point, and b is cut off at lambda / mu.

    VECTOR cuts each |b_j|: |S - S~| <= 3 lambda. BANDS cuts the norm over the bands of a coordinate: each
    coordinate moves by sqrt(3) lambda at most. SCALAR cuts each number: 3 lambda for each coordinate.
    """
    mesh = noisy(flipped(triangle_torus()), rng, 0.5)
    lambda_ = 0.1
    settings = DenoiseSettings(
        method="POSITIONS", stencil=rule, shrinkage=shrinkage, frame=frame, lambda_=lambda_, iterations=800
    )
    changes = []
    result = denoise(
        mesh, settings, dtype=np.float64, callback=lambda _, change: changes.append(change), region=AS_SOLVED
    )
    assert changes[-1] < 1e-5, "not at a fixed point: the bound would not apply"
    moved = (result.vertices - mesh.vertices) / result.report.mean_edge_length
    slack = 1e-3 * lambda_
    if shrinkage == "VECTOR":
        assert lengths(moved).max() <= 3 * lambda_ + slack
    else:
        assert np.abs(moved).max() <= (3 if shrinkage == "SCALAR" else np.sqrt(3)) * lambda_ + slack
    assert lengths(moved).max() > lambda_  # the bound is of the right size


@pytest.mark.parametrize("changes", SETTINGS)
def test_one_iteration_changes_nothing(changes, rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    result = denoise(
        mesh, DenoiseSettings(method="POSITIONS", frame="BOX_SPLINE_111", iterations=1, **changes)
    )
    assert np.array_equal(result.vertices, mesh.vertices)
    assert result.report.n_moved == 0
    assert result.report.iterations == 1


@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float64, 1e-13), (np.float32, 1e-5)])
def test_lambda_zero_changes_nothing(dtype, tolerance, rng):
    mesh = noisy(mixed_sheet(), rng)
    for changes in SETTINGS:
        settings = DenoiseSettings(
            method="POSITIONS", frame="BOX_SPLINE_111", **{**changes, "lambda_": 0.0, "iterations": 30}
        )
        moved = denoise(mesh, settings, dtype=dtype).vertices - mesh.vertices
        assert lengths(moved).max() < tolerance * 30


def test_larger_lambda_removes_more(rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    rms = [
        denoise(mesh, DenoiseSettings(method="POSITIONS", lambda_=value)).report.displacement_rms
        for value in (0.0, 0.05, 0.1, 0.2, 0.4)
    ]
    assert rms == sorted(rms)
    assert rms[-1] > 2 * rms[1]


def test_feedback_brings_the_input_back(rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    rms = [
        denoise(mesh, DenoiseSettings(method="POSITIONS", delta=value, iterations=20)).report.displacement_rms
        for value in (0, 0.05, 0.2)
    ]
    assert rms == sorted(rms, reverse=True)
    assert rms[-1] < 0.8 * rms[0]
