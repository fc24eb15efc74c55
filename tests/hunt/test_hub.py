# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A vertex with 100,000 triangles: what costs its square is refused before the work, all else is done."""

from time import perf_counter

import numpy as np
import pytest
from framelet.core import PRESETS, TooLargeError, denoise
from meshes import noisy, pyramid

from .profile import HUNT

MOST = 8 * 10**9
"""Bytes that a usual computer has."""


def hub(n=100_000):
    return noisy(pyramid(n, closed=True), np.random.default_rng(0))


@pytest.mark.parametrize("preset", ["AUTO", "TRI_1", "TRI_2", "POSITIONS"])
def test_what_grows_with_the_valence_is_done(preset):
    result = denoise(hub(100_000 if HUNT else 10_000), PRESETS[preset].settings, max_bytes=MOST)
    assert np.isfinite(result.vertices).all()


@pytest.mark.parametrize(
    ("preset", "changes"),
    [
        ("BILATERAL", {}),
        ("TRI_2", {"levels": 2}),
        ("TRI_2", {"frame": "PAIRWISE"}),
        ("TRI_2", {"frame": "B_SPLINE_3"}),
        ("TRI_2", {"frame": "B_SPLINE_5"}),
        ("TRI_2", {"frame": "ADAPTIVE", "levels": 3}),
    ],
)
def test_what_grows_with_its_square_is_refused_at_once(preset, changes):
    mesh, began = hub(), perf_counter()
    with pytest.raises(TooLargeError, match="100,001 vertices need about"):
        denoise(mesh, PRESETS[preset].settings.with_changes(**changes), max_bytes=MOST)
    assert perf_counter() - began < 5.0
