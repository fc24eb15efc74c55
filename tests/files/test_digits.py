# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Numbers as text, by the million and as Python writes them."""

import numpy as np
import pytest
from framelet.operators.files.digits import NumberStyle, as_text


def words(values, style):
    """Return what is written, word by word."""
    letters, lengths = as_text(np.asarray(values, float), style)
    assert lengths.sum() == len(letters)
    return [each.tobytes().decode() for each in np.split(letters, np.cumsum(lengths)[:-1])]


ODD = [0.0, -0.0, 1.0, -1.0, 10.0, 999999999.0, 1e9, 1e-4, -0.00012345678949, 99999.99999999, 0.5, -123456.5]
ODD += [9.9999999995, 1e-20, -1e30, 1e-5, 9.9999999996e-5, 99999999.97, 3.0e-308]


@pytest.mark.parametrize("digits", [7, 9, 12, 17])
def test_digits_are_those_of_python(rng, digits):
    spread = 10.0 ** rng.uniform(-8.0, 12.0, 20_000) * rng.choice([-1.0, 1.0], 20_000)
    values = np.concatenate((ODD, spread.astype(np.float32), rng.normal(0.0, 1.0, 20_000).astype(np.float32)))
    expected = [f"{value:.{digits}g}" for value in values.tolist()]
    found = words(values, NumberStyle(False, digits))
    if digits > 9:  # the last digit may be that of the other neighbor where both are as near
        pairs = [(a, b) for a, b in zip(found, expected, strict=True) if a != b]
        assert len(pairs) < 20
        np.testing.assert_allclose(*np.array(pairs or [(1, 1)], float).T, rtol=1.1 * 10.0 ** (1 - digits))
    else:
        assert found == expected


def test_single_precision_comes_back(rng):
    values = (rng.normal(0.0, 100.0, 50_000) ** 3).astype(np.float32)
    assert np.array_equal(np.array(words(values, NumberStyle(False, 9)), float).astype(np.float32), values)


def test_decimals_are_those_of_python(rng):
    values = np.concatenate((ODD[:14], np.round(rng.normal(0.0, 10.0, 5_000), 4)))
    assert words(values, NumberStyle(True, 4)) == [f"{value:.4f}" for value in values.tolist()]
