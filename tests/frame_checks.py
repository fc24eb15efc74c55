# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every frame promises on every mesh, in one routine that all banks and stencils pass."""

import numpy as np
import pytest
from checks import random_rotation
from framelet.core import FrameTransform

EXACT = 1e-11
"""Error relative to the largest number."""


def bands_of(transform, vertices):
    """Return low-pass and high bands as plain arrays."""
    return list(transform.analyze(vertices))


def energy(transform, arrays, is_weighted):
    """Return the sum of squares of coefficients, coarse to fine, in the measures of their levels."""
    measures = transform.measures() if is_weighted else None
    total = (arrays[0] ** 2 if measures is None else measures[-1][:, None] * arrays[0] ** 2).sum()
    for level, bands in enumerate(reversed(arrays[1:])):
        total += (bands**2 if measures is None else measures[level + 1][:, None] * bands**2).sum()
    return total


def check_frame(mesh, frame, levels=1, stencil="STRAIGHT", rng=None):
    """Check perfect reconstruction, adjoints, energy, frame bounds, the matrix, equivariance and repr.

    Parameters
    ----------
    mesh : SurfaceMesh
        A small mesh; its size in memory is a matrix.
    frame : str or FilterBank
        The frame.
    levels : int
        Number of levels.
    stencil : str
        Rule at irregular vertices.
    rng : numpy.random.Generator
        For arbitrary positions and coefficients.
    """
    transform = FrameTransform(mesh, frame, levels, stencil=stencil)
    positions = mesh.vertices.astype(np.float64)
    scale = np.abs(positions).max()
    arrays = bands_of(transform, positions)
    assert [a.shape for a in arrays] == [
        positions.shape,
        *((level.n_high, level.n_sites, 3) for level in reversed(transform.levels)),
    ]

    # Perfect reconstruction, from the object and from plain arrays.
    for given in (arrays, transform.analyze(positions)):
        assert np.abs(transform.synthesize(given) - positions).max() <= EXACT * scale

    # Linear, constants are in the low-pass alone.
    other = rng.normal(size=positions.shape)
    for whole, one, two in zip(
        bands_of(transform, 2.0 * positions - other), arrays, bands_of(transform, other), strict=True
    ):
        assert np.abs(whole - (2.0 * one - two)).max(initial=0.0) <= 10 * EXACT * (scale + 10)
    low, *details = bands_of(transform, np.ones_like(positions))
    assert np.abs(low - 1.0).max() <= EXACT
    assert all(np.abs(bands).max(initial=0.0) <= EXACT for bands in details)

    # The adjoint, and that in the measures.
    image = bands_of(transform, other)
    c = [rng.normal(size=array.shape) for array in arrays]
    left = sum((one * two).sum() for one, two in zip(image, c, strict=True))
    assert left == pytest.approx((other * transform.adjoint(c)).sum(), rel=1e-9, abs=1e-8)

    # The matrix, and the bounds of its spectrum.
    matrix = transform.to_dense()
    assert np.abs(matrix @ other - np.concatenate([a.reshape(-1, 3) for a in image])).max() <= 100 * EXACT
    spectrum = np.linalg.eigvalsh(matrix.T @ matrix)
    lower, upper = transform.frame_bounds(steps=mesh.n_vertices)
    assert upper == pytest.approx(spectrum[-1], rel=1e-7)
    assert lower == pytest.approx(spectrum[0], rel=1e-5, abs=1e-9)
    assert spectrum[0] > 1e-6  # it is a frame

    # Tight frames keep energy in their measures, and their adjoint there is the inverse.
    if transform.is_tight:
        measures = transform.measures()
        before = (measures[0][:, None] * other**2).sum()
        assert energy(transform, image, is_weighted=True) == pytest.approx(before, rel=1e-10)
        assert np.abs(transform.weighted_adjoint(image) - other).max() <= 1e-10
        if all((measure == 1.0).all() for measure in measures):
            assert (lower, upper) == pytest.approx((1.0, 1.0), rel=1e-9)

    # Turned and moved positions have turned coefficients: the same stencils, and chosen anew.
    turn, shift = random_rotation(rng), rng.normal(size=3)
    moved = positions @ turn.T + shift
    low, *details = bands_of(FrameTransform(mesh.with_vertices(moved), frame, levels, stencil=stencil), moved)
    assert np.abs(low - (arrays[0] @ turn.T + shift)).max() <= 1e-9 * (scale + 10)
    for bands, old in zip(details, arrays[1:], strict=True):
        assert np.abs(bands - old @ turn.T).max(initial=0.0) <= 1e-9 * (scale + 10)
    assert repr(transform).startswith(f"FrameTransform({transform.frame}, {levels} level")
