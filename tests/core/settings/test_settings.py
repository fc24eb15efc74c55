# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings: what is allowed, and one sentence with the value for what is not."""

from dataclasses import FrozenInstanceError, fields
from fractions import Fraction

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import BANKS, DEFAULT_PRESET, PRESETS, DenoiseSettings, denoise
from framelet.core.errors import SettingError
from framelet.core.methods.proximal import SHRINKAGES
from framelet.core.settings import METHODS, check_setting, used_settings
from meshes import noisy, triangle_torus

INFO = {item.name: item.metadata["info"] for item in fields(DenoiseSettings)}
KIND = {item.name: item.type for item in fields(DenoiseSettings)}
NUMBERS = [name for name, info in INFO.items() if not info.choices]
CHOICES = [name for name, info in INFO.items() if info.choices]


def made(name, value):
    """Return settings with one value, of a method that uses it."""
    return DenoiseSettings(**{"method": (*INFO[name].methods, "AUTO")[0], name: value})


@pytest.mark.parametrize("name", NUMBERS)
def test_ends_of_ranges_are_allowed_and_beyond_is_not(name):
    info = INFO[name]
    whole = KIND[name] == "int"
    for value in (info.minimum, info.maximum):
        assert getattr(made(name, value), name) == value
    step = 1 if whole else 1e-9 * max(1.0, abs(info.maximum))
    for value in (info.minimum - step, info.maximum + step, -(10**9), 10**9):
        with pytest.raises(ValueError, match=r"; it must be between \S+ and \S+\.$") as error:
            made(name, value)
        assert str(error.value).startswith(info.label)
        assert f"{value:g}" in str(error.value)


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_numbers_that_are_not_finite_are_refused(name, value):
    with pytest.raises(ValueError, match=r"; it must be"):
        made(name, value)


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [True, False, np.True_, "1", None, [1], 1j, b"1", np.ones(1)])
def test_wrong_types_are_refused(name, value):
    kind = "whole number" if KIND[name] == "int" else "number"
    with pytest.raises(ValueError, match=rf"it must be a {kind}\.$"):
        made(name, value)


@pytest.mark.parametrize("name", [name for name in NUMBERS if KIND[name] == "int"])
@pytest.mark.parametrize("value", [1.0, 1.5, np.float32(1.0), Fraction(1)])
def test_whole_numbers_must_be_whole(name, value):
    with pytest.raises(ValueError, match=r"it must be a whole number\.$"):
        made(name, value)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", NUMBERS)
def test_numpy_numbers_are_allowed(name):
    value = INFO[name].maximum
    for kind in (np.int64, np.int32) if KIND[name] == "int" else (np.float32, np.float64, np.int64):
        if kind(value) == value:
            assert getattr(made(name, kind(value)), name) == value


def test_numbers_that_no_float_can_hold_are_refused():
    with pytest.raises(ValueError, match="Iterations is"):
        DenoiseSettings(iterations=10**400)


@pytest.mark.parametrize("name", CHOICES)
@pytest.mark.parametrize("value", ["", "mean", "NONE", None, 0, True, ["MEAN"], float("nan")])
def test_wrong_choices_are_refused(name, value):
    names = ", ".join(choice.identifier for choice in INFO[name].choices)
    with pytest.raises(ValueError, match=rf"^{INFO[name].label} is .*; choose one of {names}\.$"):
        made(name, value)


@pytest.mark.parametrize("name", CHOICES)
def test_every_choice_is_allowed_and_explained(name):
    identifiers = [choice.identifier for choice in INFO[name].choices]
    assert len(set(identifiers)) == len(identifiers) > 1
    for choice in INFO[name].choices:
        assert getattr(made(name, choice.identifier), name) == choice.identifier
        assert choice.label
        assert choice.description


def test_choices_are_what_the_core_knows():
    assert {"BOX_SPLINE_111", "BOX_SPLINE_111_CANONICAL"} <= {
        c.identifier for c in INFO["frame"].choices
    } & set(BANKS)
    assert [choice.identifier for choice in INFO["shrinkage"].choices] == list(SHRINKAGES)


def test_defaults_lie_in_their_ranges():
    for name in NUMBERS:
        info = INFO[name]
        soft = info.maximum if info.soft_maximum is None else info.soft_maximum
        assert info.minimum <= getattr(DenoiseSettings(), name) <= soft <= info.maximum
        assert info.label
        assert info.description


def test_changes_are_checked_and_leave_the_original_alone():
    settings = DenoiseSettings(method="POSITIONS")
    changed = DenoiseSettings(method="POSITIONS", lambda_=0.7, stencil="MEAN")
    assert settings.with_changes(lambda_=0.7, stencil="MEAN") == changed
    assert settings == DenoiseSettings(method="POSITIONS")
    with pytest.raises(ValueError, match=r"Smoothing \(λ\) is -1; it must be between 0 and 100"):
        settings.with_changes(lambda_=-1)
    with pytest.raises(TypeError, match="unknown"):
        settings.with_changes(unknown=1)
    with pytest.raises(FrozenInstanceError):
        settings.mu = 2.0


def test_presets():
    assert PRESETS["POSITIONS"].settings == DenoiseSettings(method="POSITIONS")
    assert PRESETS[DEFAULT_PRESET].settings == DenoiseSettings() == DenoiseSettings(method="AUTO")
    assert len({preset.label for preset in PRESETS.values()}) == len(PRESETS)
    one, two = PRESETS["TRI_1"].settings, PRESETS["TRI_2"].settings
    assert (one.stencil, one.shrinkage) == ("MEAN", "BANDS")
    assert (two.stencil, two.shrinkage) == ("STRAIGHT", "VECTOR")
    assert (PRESETS["BILATERAL"].settings.method, PRESETS["BILATERAL"].settings.iterations) == (
        "BILATERAL",
        5,
    )


@pytest.mark.parametrize("method", [choice.identifier for choice in METHODS])
def test_a_setting_that_the_method_does_not_use_is_an_error(method):
    for name, info in INFO.items():
        default = getattr(DenoiseSettings(), name)
        others = [c.identifier for c in info.choices] or [info.minimum, info.maximum]
        value = next(value for value in others if value != default)
        if name == "method":
            continue
        if info.has_effect(method):
            assert getattr(DenoiseSettings(method=method, **{name: value}), name) == value
            continue
        with pytest.raises(SettingError, match=rf"^{name} is .*, but the method {method} does not use it"):
            DenoiseSettings(method=method, **{name: value})
        with pytest.raises(SettingError, match=name):
            DenoiseSettings(method=method).with_changes(**{name: value})
        # What is the default all the same says nothing.
        assert DenoiseSettings(method=method, **{name: default}) == DenoiseSettings(method=method)
        assert used_settings({"method": method, name: value}) == {"method": method}
        check_setting(name, value)
    with pytest.raises(SettingError, match="Smoothing"):
        check_setting("lambda_", -1.0)


def test_no_settings_and_default_settings_are_the_same_run(rng):
    mesh = noisy(triangle_torus(), rng)
    assert_same_bits(denoise(mesh).vertices, denoise(mesh, DenoiseSettings()).vertices)
