# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft shrinkage against loops, and as the proximal map that it should be."""

import numpy as np
import pytest
from framelet.core.methods.proximal import SHRINKAGES, FirmThreshold, HardThreshold, SoftThreshold
from twins import shrunk


def shrink(coefficients, threshold, kind):
    """Return T(y), what is left of coefficients."""
    return SoftThreshold(threshold, kind)(coefficients)


def clipped(coefficients, threshold, kind):
    """Return y - T(y), what is taken away."""
    return SoftThreshold(threshold, kind).removed(coefficients, 1.0)


KIND = pytest.mark.parametrize("kind", SHRINKAGES)


@pytest.fixture
def coefficients(rng):
    """Coefficients (3, H, n), some of them zero."""
    values = rng.normal(size=(3, 6, 40))
    values[:, :, :4] = 0.0
    values[:, 2] = 0.0
    values[1] *= 1e-3
    values.flags.writeable = False
    return values


def norm(coefficients, kind):
    """Return the norm that the shrinkage belongs to."""
    if kind == "SCALAR":
        return np.abs(coefficients).sum()
    return np.sqrt((coefficients**2).sum(axis=0 if kind == "VECTOR" else 1)).sum()


@KIND
@pytest.mark.parametrize("nu", [0.0, 0.1, 1.0, 50.0])
def test_matches_the_loop_twin(kind, nu, coefficients):
    bands = np.zeros((7, 40, 3))
    bands[1:] = coefficients.transpose(1, 2, 0)
    expected = shrunk(bands, nu, kind)[1:].transpose(2, 0, 1)
    assert np.abs(shrink(coefficients, nu, kind) - expected).max() < 1e-14
    assert np.abs(clipped(coefficients, nu, kind) - (coefficients - expected)).max() < 1e-14


@KIND
def test_zero_is_the_identity_and_infinity_gives_zero(kind, coefficients):
    assert np.array_equal(shrink(coefficients, 0.0, kind), coefficients)
    assert np.abs(shrink(coefficients, 1e6, kind)).max() < 1e-14


@KIND
def test_proximal_map(kind, coefficients, rng):
    """T(y) minimizes nu |x| + |x - y|^2 / 2: no other point is lower by more than rounding."""
    nu = 0.4

    def value(x):
        return nu * norm(x, kind) + 0.5 * ((x - coefficients) ** 2).sum()

    best = shrink(coefficients, nu, kind)
    for size in (1e-3, 0.1, 1.0):
        for _ in range(20):
            assert value(best + size * rng.normal(size=best.shape)) > value(best)


@KIND
def test_moreau(kind, coefficients):
    """y = T(y) + clipped(y), and the latter lies in the ball of the dual norm: the projection onto it."""
    nu = 0.4
    cut = clipped(coefficients, nu, kind)
    assert np.abs(shrink(coefficients, nu, kind) + cut - coefficients).max() < 1e-15
    axis = {"VECTOR": 0, "BANDS": 1}.get(kind)
    size = np.abs(cut) if axis is None else np.sqrt((cut**2).sum(axis=axis))
    assert size.max() < nu * (1 + 1e-14)
    assert size.max() > nu * (1 - 1e-14)
    assert np.abs(clipped(cut, nu, kind) - cut).max() < 1e-15


@KIND
def test_dtype_and_inputs_stay(kind, coefficients):
    single = coefficients.astype(np.float32)
    single.flags.writeable = False
    for function in (shrink, clipped):
        result = function(single, 0.3, kind)
        assert result.dtype == np.float32
        assert np.abs(result - function(coefficients, 0.3, kind)).max() < 1e-6


@KIND
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_numbers_near_the_smallest_stay_finite(kind, dtype):
    tiny = np.full((3, 6, 2), np.finfo(dtype).tiny, dtype)
    for nu in (0.0, float(np.finfo(dtype).tiny), 1e-3):
        assert np.isfinite(shrink(tiny, nu, kind)).all()


def test_wrong_arguments_are_refused(coefficients):
    with pytest.raises(ValueError, match=r"The shrinkage is 'HARD'; choose one of BANDS, VECTOR, SCALAR"):
        shrink(coefficients, 0.1, "HARD")
    for threshold in (-0.5, np.nan):
        with pytest.raises(ValueError, match=rf"The weight is {threshold}; it must be a finite number"):
            clipped(coefficients, threshold, "VECTOR")


@pytest.mark.parametrize("kind", ["BANDS", "VECTOR", "SCALAR"])
def test_vertices_without_bands_stay_without(kind):
    assert shrink(np.zeros((3, 0, 5)), 1.0, kind).shape == (3, 0, 5)


def test_thresholds_grow_with_the_step():
    bands = np.array([2.0, 3.0, -9.0]).reshape(3, 1, 1)
    assert HardThreshold(1.0, "SCALAR")(bands, step=4.0).ravel().tolist() == [0.0, 3.0, -9.0]
    assert SoftThreshold(0.5, "SCALAR")(bands, step=4.0).ravel().tolist() == [0.0, 1.0, -7.0]
    assert FirmThreshold(0.5, 6.0, "SCALAR")(bands, step=4.0).ravel().tolist() == [0.0, 1.5, -9.0]
