# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings exist once: dataclass fields, scene properties and operator properties are the same."""

from dataclasses import fields

import bpy
import pytest
from framelet.core.settings import DEFAULT_PRESET, PRESETS, DenoiseSettings, replaced_by, used_settings
from framelet.operators.properties import setting_values as module
from framelet.operators.properties.settings import FrameletSettings

FIELDS = {item.name: item for item in fields(DenoiseSettings)}
DEFAULTS = PRESETS[DEFAULT_PRESET].settings
OWNERS = [
    pytest.param(lambda: FrameletSettings.bl_rna, id="scene"),
    pytest.param(lambda: bpy.ops.object.framelet_denoise.get_rna_type(), id="operator"),
]


@pytest.fixture
def scene_settings(empty_scene):
    return bpy.context.scene.framelet


def bl_properties(owner):
    """Return the properties that come from Framelet, by name."""
    return {name: item for name, item in owner().properties.items() if name in module.PROPERTY_NAMES}


@pytest.mark.parametrize("owner", OWNERS)
def test_fields_are_properties(owner):
    properties = bl_properties(owner)
    assert set(properties) == {"preset", *FIELDS}
    for name, item in FIELDS.items():
        info = item.metadata["info"]
        prop = properties[name]
        assert prop.name.startswith(info.label) and prop.name.endswith(info.symbol)
        assert prop.description == info.description
        if info.choices:
            assert [value.identifier for value in prop.enum_items] == [
                value.identifier for value in info.choices
            ]
            assert prop.default == getattr(DEFAULTS, name)
        else:
            assert prop.hard_min == pytest.approx(info.minimum)
            assert prop.hard_max == pytest.approx(info.maximum)
            assert prop.default == pytest.approx(getattr(DEFAULTS, name))
            if info.soft_maximum is not None:
                assert prop.soft_max == pytest.approx(info.soft_maximum)


@pytest.mark.parametrize("owner", OWNERS)
def test_every_property_has_words(owner):
    for name, prop in bl_properties(owner).items():
        assert prop.name, name
        assert len(prop.description) > 10 and not prop.description.endswith("."), name


def test_presets_are_items():
    items = FrameletSettings.bl_rna.properties["preset"].enum_items
    assert [item.identifier for item in items] == [*PRESETS, module.CUSTOM]


def test_numbers_in_files_stay():
    """Files hold numbers: those of version 0.1.0 must keep their meaning."""
    properties = FrameletSettings.bl_rna.properties
    old = {
        "preset": "AUTO TRI_1 TRI_2 QUAD_1 QUAD_2 FREE_FORM PRISMATIC BILATERAL CUSTOM",
        "method": "POSITIONS - BILATERAL AUTO",
        "stencil": "MEAN STRAIGHT ADAPTIVE",
        "shrinkage": "BANDS VECTOR SCALAR",
        "boundary": "FIXED ALONG FREE",
    }
    for name, identifiers in old.items():
        numbers = {item.identifier: item.value for item in properties[name].enum_items}
        wanted = {identifier: number for number, identifier in enumerate(identifiers.split())}
        gone = wanted.pop("-", None)  # NORMALS, whose number nothing else may take
        assert {identifier: numbers[identifier] for identifier in wanted} == wanted
        assert sorted(numbers.values()) == [n for n in range(len(numbers) + (gone is not None)) if n != gone]


@pytest.mark.parametrize(("preset", "expected"), [("PRISMATIC", "PRISMATIC"), ("CUSTOM", "AUTO")])
def test_a_file_with_an_engine_that_is_gone_takes_the_default(scene_settings, tmp_path, preset, expected):
    scene_settings.preset = preset
    scene_settings.threads = 3
    store = scene_settings
    if hasattr(store, "bl_system_properties_get"):
        store = store.bl_system_properties_get(do_create=True)
    store["method"] = 1
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "old.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "old.blend"))
    loaded = bpy.context.scene.framelet
    assert (loaded.preset, loaded.method) == (preset, "AUTO")
    assert module.to_settings(loaded) == PRESETS[expected].settings.with_changes(threads=3)


def test_untouched_settings_are_the_default_preset(scene_settings):
    assert scene_settings.preset == DEFAULT_PRESET
    assert module.to_settings(scene_settings) == DEFAULTS
    assert (scene_settings.preset, scene_settings.method) == ("AUTO", "AUTO")


@pytest.mark.parametrize("preset", list(PRESETS))
def test_a_preset_fills_the_fields(scene_settings, preset):
    scene_settings.lambda_ = 1.7
    scene_settings.preset = "TRI_1"
    scene_settings.preset = preset
    assert scene_settings.preset == preset
    expected = PRESETS[preset].settings
    assert module.to_settings(scene_settings) == expected
    for name in FIELDS:
        assert getattr(scene_settings, name) == pytest.approx(getattr(expected, name)), name


def test_a_preset_keeps_the_number_of_threads(scene_settings):
    scene_settings.threads = 3
    scene_settings.preset = "TRI_1"
    assert scene_settings.threads == 3


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("method", "BILATERAL"),
        ("frame", "BOX_SPLINE_111_CANONICAL"),
        ("stencil", "MEAN"),
        ("shrinkage", "SCALAR"),
    ],
)
def test_another_combination_is_custom(scene_settings, name, value):
    scene_settings.preset = "POSITIONS"
    setattr(scene_settings, name, value)
    assert scene_settings.preset == module.CUSTOM
    assert module.to_settings(scene_settings) == DenoiseSettings(**{"method": "POSITIONS"} | {name: value})


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("lambda_", 0.7),
        ("iterations", 3),
        ("boundary", "FREE"),
        ("strength", 0.5),
        ("noise", "FINE"),
        ("tuning", "NOISE"),
    ],
)
@pytest.mark.parametrize("preset", [DEFAULT_PRESET, "POSITIONS"])
def test_other_numbers_keep_the_preset(scene_settings, preset, name, value):
    scene_settings.preset = preset
    setattr(scene_settings, name, value)
    assert scene_settings.preset == preset
    settings = PRESETS[preset].settings
    assert module.to_settings(scene_settings) == settings.with_changes(
        **used_settings({"method": settings.method, name: value})
    )
    assert module.all_values(scene_settings) == vars(settings) | {name: value}


@pytest.mark.parametrize("name", ["frame", "stencil", "shrinkage"])
@pytest.mark.parametrize("preset", [DEFAULT_PRESET, "PRISMATIC", "BILATERAL"])
def test_what_a_preset_does_not_use_keeps_it(scene_settings, preset, name):
    scene_settings.preset = preset
    value = FIELDS[name].metadata["info"].choices[-1].identifier
    setattr(scene_settings, name, value)
    assert scene_settings.preset == preset
    # It counts as soon as a method uses it.
    scene_settings.method = "POSITIONS"
    assert scene_settings.preset == module.CUSTOM
    assert getattr(module.to_settings(scene_settings), name) == value


@pytest.mark.parametrize("method", ["POSITIONS", "BILATERAL"])
def test_another_method_leaves_the_default_preset(scene_settings, method):
    scene_settings.method = method
    assert scene_settings.preset == module.CUSTOM
    assert module.to_settings(scene_settings) == DenoiseSettings(method=method)


def test_custom_with_nothing_set_is_what_the_fields_show(scene_settings):
    scene_settings.preset = module.CUSTOM
    assert module.to_settings(scene_settings) == DEFAULTS
    assert scene_settings.method == DEFAULTS.method


def test_choosing_custom_keeps_the_values(scene_settings):
    scene_settings.preset = "TRI_1"
    scene_settings.preset = module.CUSTOM
    assert module.to_settings(scene_settings) == PRESETS["TRI_1"].settings


def test_numbers_are_those_that_were_typed(scene_settings):
    scene_settings.method = "POSITIONS"
    scene_settings.lambda_ = 0.123456
    scene_settings.tolerance = 1e-4
    settings = module.to_settings(scene_settings)
    assert (settings.lambda_, settings.tolerance) == (0.123456, 1e-4)


def test_limits_are_valid_settings(scene_settings):
    for name, item in FIELDS.items():
        info = item.metadata["info"]
        for value in [choice.identifier for choice in info.choices] or [info.minimum, info.maximum]:
            setattr(scene_settings, name, int(value) if item.type == "int" else value)
            scene_settings.method = value if name == "method" else (*info.methods, "AUTO")[0]
            assert getattr(module.to_settings(scene_settings), name) == value


class Recorder:
    """Stands for the operator that a panel draws."""

    preset = DEFAULT_PRESET


def test_copying_takes_every_value(scene_settings):
    scene_settings.preset = "TRI_1"
    scene_settings.mu = 3.5
    scene_settings.shrinkage = "SCALAR"
    scene_settings.threads = 2
    copied = Recorder()
    module.copy_settings(scene_settings, copied)
    assert copied.preset == module.CUSTOM
    expected = PRESETS["TRI_1"].settings.with_changes(mu=3.5, shrinkage="SCALAR", threads=2)
    assert {name: getattr(copied, name) for name in FIELDS} == {
        name: getattr(expected, name) for name in FIELDS
    }


def test_a_method_hides_what_it_does_not_use():
    assert module.has_effect("POSITIONS", "lambda_") and not module.has_effect("POSITIONS", "sigma_c")
    assert module.has_effect("BILATERAL", "sigma_c") and not module.has_effect("BILATERAL", "lambda_")
    assert all(module.has_effect(method, "strength") for method in ("AUTO", "POSITIONS", "BILATERAL"))
    for name in ("noise", "passes"):
        assert module.has_effect("AUTO", name) and not module.has_effect("POSITIONS", name)
    assert not module.has_effect("AUTO", "iterations")
    for name in ("preset", "method", "iterations", "boundary", "threads"):
        assert module.has_effect("POSITIONS", name) and module.has_effect("BILATERAL", name)


def test_the_noise_replaces_three_settings_of_one_method(scene_settings):
    for method in ("AUTO", "POSITIONS", "BILATERAL"):
        scene_settings.method, scene_settings.tuning = method, "NOISE"
        replaced = [name for name in FIELDS if replaced_by(scene_settings, name)]
        assert replaced == (["lambda_", "mu", "iterations"] if method == "POSITIONS" else [])
        scene_settings.tuning = "GIVEN"
        assert not any(replaced_by(scene_settings, name) for name in FIELDS)
