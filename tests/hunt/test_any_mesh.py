# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Any mesh, any setting, any limits: what `denoise` promises holds, or one sentence says why it cannot."""

import dataclasses
import warnings

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import DenoiseSettings, FrameletError, blocks, denoise
from framelet.core.equalizer import Equalizer
from hypothesis import given
from hypothesis import strategies as st

from .generated import denoise_settings, limits, meshes, one_sentence
from .profile import examples


@pytest.fixture(scope="module", autouse=True)
def _small_blocks():
    """Small meshes fall into many blocks, so that threads have something to share."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(blocks.Blocks.__init__, "__defaults__", (0, 16))
        yield


def outcome(*args, **options):
    """Return the result of a call, or its documented error; warnings are failures."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return denoise(*args, **options)
        except FrameletError as error:
            one_sentence(error)
            return error


@examples()
@given(st.data(), meshes(), denoise_settings())
def test_a_result_or_one_sentence(data, mesh, settings):
    region, movable = data.draw(limits(mesh))
    before = [getattr(mesh, item.name).tobytes() for item in dataclasses.fields(mesh)]
    result = outcome(mesh, settings.with_changes(threads=1), region=region, movable=movable)
    assert before == [getattr(mesh, item.name).tobytes() for item in dataclasses.fields(mesh)]
    again = outcome(mesh, settings.with_changes(threads=3), region=region, movable=movable)
    if isinstance(result, FrameletError):
        assert str(result) == str(again)
        return
    vertices, report = result.vertices, result.report
    assert_same_bits(vertices, again.vertices)
    assert vertices.dtype == mesh.vertices.dtype and vertices.shape == mesh.vertices.shape
    assert np.isfinite(vertices).all()
    numbers = [value for value in vars(report).values() if isinstance(value, float)]
    assert numbers and np.isfinite(numbers).all(), report
    moved = np.linalg.norm(vertices.astype(np.float64) - mesh.vertices, axis=1)
    rounding = np.spacing(np.abs(mesh.vertices).max(axis=1)).astype(np.float64)
    named = np.unique(mesh.corner_vertex)
    span = np.linalg.norm(np.ptp(mesh.vertices[named].astype(np.float64), axis=0))
    assert (moved <= 2.0 * span + 2.0 * rounding).all(), "a vertex flies away"
    still = np.zeros(mesh.n_vertices, bool) if movable is None else ~movable
    if region is not None and region.weights is not None:
        still |= region.weights == 0
    assert_same_bits(vertices[still], mesh.vertices[still])
    if region is not None and region.max_displacement is not None:
        assert (moved <= (1.0 + 1e-6) * region.max_displacement + 2.0 * rounding).all()


@examples()
@given(st.data(), meshes())
def test_strength_zero_changes_no_bit(data, mesh):
    region, movable = data.draw(
        limits(mesh, straighten_borders=False)
    )  # which would move them, as it is asked
    result = outcome(mesh, DenoiseSettings(strength=0.0, threads=1), region=region, movable=movable)
    if not isinstance(result, FrameletError):
        assert_same_bits(result.vertices, mesh.vertices)


@examples()
@given(st.data(), meshes(), st.integers(1, 3), st.sampled_from(["AUTO", "ADAPTIVE", "BOX_SPLINE_111"]))
def test_gains_of_one_change_no_bit(data, mesh, levels, frame):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            equalizer = Equalizer(mesh, levels, frame=frame, threads=1)
        except FrameletError as error:
            one_sentence(error)
            return
        assert_same_bits(equalizer.equalized([1.0] * levels), mesh.vertices)
        gains = data.draw(st.lists(st.floats(0.0, 100.0), min_size=levels, max_size=levels))
        assert np.isfinite(equalizer.equalized(gains)).all()
