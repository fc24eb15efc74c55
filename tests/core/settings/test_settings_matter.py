# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user interface hides does not matter, and what it shows does."""

from dataclasses import fields

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import BANKS, DenoiseSettings, denoise
from framelet.core.errors import SettingError
from framelet.core.settings import used_settings
from framelet.core.settings.choices import METHODS
from meshes import MESHES, noisy

INFO = {item.name: item.metadata["info"] for item in fields(DenoiseSettings)}
CHANGES = {
    "strength": 0.5,
    "noise": "WIDE",
    "passes": 1,
    "frame": "ADAPTIVE",
    "stencil": "MEAN",
    "shrinkage": "BANDS",
    "levels": 2,
    "lambda_": 0.6,
    "mu": 3.0,
    "delta": 0.3,
    "iterations": 4,
    "tolerance": 1.0,
    "boundary": "FIXED",
    "sigma_c": 1.7,
    "sigma_s": 0.2,
}
"""Another value for each setting but the method, but where parameters come from, and but the threads, which
never change a result."""


@pytest.mark.parametrize("method", [choice.identifier for choice in METHODS])
def test_settings_that_have_no_effect_change_nothing_and_others_do(method, rng):
    assert {*CHANGES, "method", "tuning", "threads"} == set(INFO)
    mesh = noisy(MESHES["irregular grid"](), rng)
    settings = DenoiseSettings(**used_settings({"method": method, "iterations": 3}))
    plain = denoise(mesh, settings).vertices
    assert not [name for name, value in CHANGES.items() if getattr(settings, name) == value]
    hidden = {name: value for name, value in CHANGES.items() if not INFO[name].has_effect(method)}
    for name, value in hidden.items():
        with pytest.raises(SettingError, match=f"{name} is .* the method {method} does not use it"):
            settings.with_changes(**{name: value})
    for name in [name for name in CHANGES if name not in hidden]:
        other = denoise(mesh, settings.with_changes(**{name: CHANGES[name]})).vertices
        assert not np.array_equal(other, plain), name
    assert_same_bits(denoise(mesh, settings.with_changes(threads=3)).vertices, plain)
    assert INFO["threads"].has_effect(method) and INFO["method"].has_effect(method)


@pytest.mark.parametrize("method", [choice.identifier for choice in METHODS])
def test_a_value_given_by_name_that_the_method_does_not_use_is_refused_whatever_it_is(method):
    mesh = MESHES["irregular grid"]()
    for name, info in INFO.items():
        if not info.has_effect(method):
            value = getattr(DenoiseSettings(), name)
            with pytest.raises(SettingError, match=f"{name} is .*, but the method {method} does not use it"):
                denoise(mesh, method=method, **{name: value})


@pytest.mark.parametrize(
    ("given", "name", "other"),
    [
        ({"tuning": "noise", "mu": 7}, "mu", "tuning"),
        ({"tuning": "noise", "lambda_": 0.25}, "lambda_", "tuning"),
        ({"tuning": "noise", "iterations": 99}, "iterations", "tuning"),
        ({"stencil": "adaptive", "frame": "linear-spline"}, "frame", "stencil"),
        ({"stencil": "adaptive", "frame": BANKS["B_SPLINE_1"]}, "frame", "stencil"),
        ({"frame": "pairwise", "stencil": "straight"}, "stencil", "frame"),
        ({"frame": "adaptive", "stencil": "mean"}, "stencil", "frame"),
    ],
)
def test_a_value_given_by_name_that_another_one_replaces_is_refused(given, name, other, rng):
    """What a preset or an object brings along is not: it was not asked for."""
    mesh = noisy(MESHES["irregular grid"](), rng)
    with pytest.raises(SettingError, match=f"^{name} is .*, but has no effect with {other}=.*leave one"):
        denoise(mesh, method="positions", **given)
    left = {key: value for key, value in given.items() if key != name}
    settings = DenoiseSettings(method="POSITIONS").with_changes(
        **{
            key: value.upper().replace("-", "_") if isinstance(value, str) else value
            for key, value in given.items()
        }
    )
    assert_same_bits(denoise(mesh, settings).vertices, denoise(mesh, method="positions", **left).vertices)


def test_values_that_agree_with_what_replaces_others_are_used(rng):
    mesh = noisy(MESHES["irregular grid"](), rng)
    pair = {"frame": "pairwise", "stencil": "adaptive"}
    found = [
        denoise(mesh, method="positions", **{key: pair[key] for key in keys}).vertices
        for keys in (["frame"], pair, ["stencil"])
    ]
    assert_same_bits(found[0], found[1])
    assert not np.array_equal(found[1], found[2])
    for frame in ("auto", "adaptive"):
        assert_same_bits(
            denoise(mesh, method="positions", frame=frame, stencil="adaptive").vertices, found[2]
        )


def test_free_borders_are_those_along_for_the_learned_method(rng):
    """As its description says."""
    mesh = noisy(MESHES["irregular grid"](), rng)
    free, along, fixed = (denoise(mesh, boundary=each).vertices for each in ("free", "along", "fixed"))
    assert_same_bits(free, along)
    assert not np.array_equal(fixed, along)


def test_every_method_has_settings_of_its_own():
    named = {method for info in INFO.values() for method in info.methods}
    assert named == {choice.identifier for choice in METHODS}
    own = {name for name, info in INFO.items() if info.methods == ("AUTO",)}
    assert own == {"noise", "passes"}


@pytest.mark.parametrize(
    ("settings", "same"),
    [
        (
            DenoiseSettings(method="POSITIONS", lambda_=0.2, strength=1.5),
            DenoiseSettings(method="POSITIONS", lambda_=0.2 * 1.5),
        ),
        (
            DenoiseSettings(method="BILATERAL", sigma_s=0.4, strength=0.5),
            DenoiseSettings(method="BILATERAL", sigma_s=0.4 * 0.5),
        ),
    ],
)
def test_strength_is_a_factor_of_what_stands_for_the_noise(settings, same, rng):
    mesh = noisy(MESHES["irregular grid"](), rng)
    assert_same_bits(denoise(mesh, settings).vertices, denoise(mesh, same).vertices)


@pytest.mark.parametrize("changes", [{}, {"tuning": "NOISE"}, {"sigma_s": 0.0}, {"sigma_s": 0.3}])
def test_more_strength_takes_more_and_none_nothing(changes, rng):
    """Also of what is measured: λ from the noise, and the heights of the bilateral filter."""
    mesh = noisy(MESHES["irregular grid"](), rng)
    method = "BILATERAL" if "sigma_s" in changes else "POSITIONS"
    settings = DenoiseSettings(method=method, **changes)
    reports = [denoise(mesh, settings.with_changes(strength=each)).report for each in (0.0, 0.5, 1.0, 2.0)]
    moved = [report.displacement_rms for report in reports]
    assert moved[0] == 0.0 and reports[0].n_moved == 0
    assert moved[0] < moved[1] < moved[2] < moved[3]
