# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Options: made from the settings, checked, understood in several spellings, put over the preset."""

import functools
from dataclasses import fields

import pytest
from framelet.core.settings import DEFAULT_PRESET, PRESETS, DenoiseSettings
from framelet.core.settings.frame_catalog import FRAME_CATALOG
from framelet.operators.command_line.arguments import as_word, option_name, settings_from
from framelet.operators.command_line.messages import CommandError
from framelet.operators.command_line.parser import make_parser
from framelet.operators.properties.setting_values import has_effect

parser = functools.cache(make_parser)
"""One parser for all command lines that are read here."""


def parse(*options):
    """Return the settings of a command line with these options."""
    return settings_from(parser("framelet").parse_args(["denoise", "a.ply", "b.ply", *options]))


def test_names_of_options():
    assert option_name("lambda_") == "--lambda"
    assert option_name("sigma_c") == "--sigma-c"


def test_without_options_the_default_preset():
    assert parse() == parse("--preset", "auto") == PRESETS[DEFAULT_PRESET].settings
    assert parse().method == "AUTO"


@pytest.mark.parametrize("item", fields(DenoiseSettings), ids=lambda item: item.name)
def test_every_field_has_an_option(item):
    info = item.metadata["info"]
    values = [choice.identifier for choice in info.choices] or [item.default, info.minimum, info.maximum]
    preset = preset_with(item.name)
    for value in values:
        for text in (str(value), as_word(str(value))):
            settings = parse("--preset", preset, option_name(item.name), text)
            assert getattr(settings, item.name) == value


def preset_with(name):
    """Return the first preset whose method uses a setting, as it is typed."""
    return as_word(next(key for key, preset in PRESETS.items() if has_effect(preset.settings.method, name)))


@pytest.mark.parametrize("item", fields(DenoiseSettings), ids=lambda item: item.name)
@pytest.mark.parametrize("key", PRESETS)
def test_options_without_effect_are_refused(key, item):
    option = option_name(item.name)
    text = as_word(str(getattr(PRESETS[key].settings, item.name)))
    if has_effect(PRESETS[key].settings.method, item.name):
        assert parse("--preset", as_word(key), option, text) == PRESETS[key].settings
        return
    with pytest.raises(CommandError) as caught:
        parse("--preset", as_word(key), option, text)
    sentence = str(caught.value)
    assert sentence.startswith(f"{option} has no effect with ") and as_word(key) in sentence
    assert sentence.count(". ") == 0 and sentence.endswith(f" --preset {preset_with(item.name)}.")
    assert caught.value.exit_code == 2
    # The advice works.
    parse("--preset", preset_with(item.name), option, text)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--lambda", "1"], "--lambda has no effect with the preset auto; add --preset positions."),
        (
            ["--preset", "bilateral", "--passes", "1"],
            "--passes has no effect with --preset bilateral; use --preset auto.",
        ),
        (
            ["--preset", "tri-1", "--method", "auto", "--lambda", "1"],
            "--lambda has no effect with --method auto; use --method positions.",
        ),
        (
            ["--preset", "tri-1", "--tuning", "noise", "--mu", "1"],
            "--mu has no effect with --tuning noise, which takes it from the measured noise; "
            "leave one of them out.",
        ),
        (
            ["--preset", "positions", "--stencil", "adaptive", "--frame", "linear-spline"],
            "--frame has no effect with --stencil adaptive, which has masks of its own; "
            "leave one of them out.",
        ),
    ],
)
def test_the_sentence_says_what_to_do(fails, words, sentence):
    assert fails("denoise", "a.ply", "b.ply", *words, code=2) == f"framelet: {sentence}"


def test_a_method_makes_its_options_count():
    settings = parse("--method", "positions", "--lambda", "0.7")
    assert settings == DenoiseSettings(method="POSITIONS", lambda_=0.7)
    assert parse("--preset", "positions", "--tuning", "noise", "--levels", "2").tuning == "NOISE"
    assert parse("--strength", "0.5", "--boundary", "free").strength == 0.5


@pytest.mark.parametrize("key", PRESETS)
def test_preset(key):
    assert parse("--preset", as_word(key)) == PRESETS[key].settings
    assert parse("--preset", key) == PRESETS[key].settings


@pytest.mark.parametrize("order", [1, -1])
def test_options_override_the_preset_in_any_order(order):
    pairs = [("--preset", "tri-1"), ("--lambda", "0.7"), ("--stencil", "straight")][::order]
    settings = parse(*(word for pair in pairs for word in pair))
    assert settings == PRESETS["TRI_1"].settings.with_changes(lambda_=0.7, stencil="STRAIGHT")


def test_option_equal_to_the_default_overrides_the_preset():
    default = DenoiseSettings().stencil
    assert PRESETS["TRI_1"].settings.stencil != default
    assert parse("--preset", "tri-1", "--stencil", as_word(default)).stencil == default


def test_help_of_denoise(command):
    result = command("denoise", "--help")
    assert (result.code, result.err) == (0, "")
    assert "usage: framelet denoise IN OUT" in result.out
    assert "example: framelet denoise " in result.out
    words = " ".join(result.out.split())
    for item in fields(DenoiseSettings):
        info = item.metadata["info"]
        assert option_name(item.name) in words
        assert info.description in words
        for choice in info.choices:
            assert f"- {as_word(choice.identifier)}: {choice.description}" in words
    for option in ("--preset", "--report", "--quiet"):
        assert option in words


@pytest.mark.parametrize("name", ["bands", "equalize"])
def test_help_of_commands_with_a_frame(command, name):
    result = command(name, "--help")
    assert (result.code, result.err) == (0, "")
    assert f"usage: framelet {name} IN " in result.out
    assert f"example: framelet {name} " in result.out
    words = " ".join(result.out.split())
    for option in ("--frame NAME", "--stencil {mean,straight,adaptive}", "--boundary", "--quiet"):
        assert option in words
    for entry in FRAME_CATALOG:
        assert f"- {as_word(entry.identifier)}: {entry.description}" in words
    assert "(default: auto)" in words and "preset" not in words


def test_long_lists_of_choices_stand_below_the_option(command):
    lines = command("denoise", "--help").out.splitlines()
    assert any(line.strip().startswith("--frame NAME") for line in lines)
    assert any(line.strip().startswith("- b-spline-6:") for line in lines)
    assert max(map(len, lines)) <= 120


def test_help_of_the_program(command):
    result = command("--help")
    assert (result.code, result.err) == (0, "")
    assert "denoise the meshes of a file" in result.out
    commands = [line.split()[0] for line in result.out.splitlines() if line.startswith("    ")]
    names = ["denoise", "equalize", "bands"]
    assert [word for word in commands if word in names] == names


def test_version(command):
    result = command("--version")
    assert (result.code, result.err) == (0, "")
    name, version = result.out.split()
    assert name == "Framelet" and version[0].isdigit()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "required: COMMAND"),
        (["polish"], "'polish'"),
        (["denoise"], "required: IN"),
        (["denoise", "a.ply"], "There is no OUT; name the file to write, or add --in-place"),
        (["denoise", "a.ply", "b.ply", "c.ply"], "unrecognized arguments: c.ply"),
        (["denoise", "a.ply", "b.ply", "--force", "3"], "unrecognized arguments: --force 3"),
        (["denoise", "a.ply", "b.ply", "--strength", "11"], "Strength is 11; it must be between 0 and 10"),
        (["denoise", "a.ply", "b.ply", "--iter", "3"], "unrecognized arguments: --iter 3"),
        (["denoise", "a.ply", "b.ply", "--lambda"], "--lambda: expected one argument"),
        (["denoise", "a.ply", "b.ply", "--lambda", "much"], "'much' is not a number"),
        (["denoise", "a.ply", "b.ply", "--lambda", "-1"], "Smoothing (λ) is -1; it must be between 0 and"),
        (["denoise", "a.ply", "b.ply", "--lambda", "nan"], "Smoothing (λ) is nan"),
        (["denoise", "a.ply", "b.ply", "--iterations", "2.5"], "'2.5' is not a whole number"),
        (["denoise", "a.ply", "b.ply", "--stencil", "round"], "'round' is not one of mean, straight"),
        (
            ["denoise", "a.ply", "b.ply", "--preset", "best"],
            "'best' is not one of auto, free-form, prismatic",
        ),
        (["denoise", "a.ply", "b.ply", "--frame", "haar"], "'haar' is not one of auto, box-spline-111"),
        (["denoise", "a.ply", "b.ply", "--levels", "0"], "Levels is 0; it must be between 1 and 6"),
        (["denoise", "a.ply", "b.ply", "--levels", "two"], "'two' is not a whole number"),
        (["bands"], "required: IN, --out"),
        (["bands", "a.ply"], "required: --out"),
        (["bands", "a.ply", "--out", "b.npz", "--levels", "7"], "Levels is 7; it must be between 1 and 6"),
        (["bands", "a.ply", "--out", "b.npz", "--max-size", "nan"], "'nan' is not a number of megabytes"),
        (["bands", "a.ply", "--out", "b.npz", "--lambda", "1"], "unrecognized arguments: --lambda 1"),
        (["equalize", "a.ply", "b.ply"], "required: --gains"),
        (["equalize", "a.ply", "b.ply", "--gains", ""], "there are no gains"),
        (["equalize", "a.ply", "b.ply", "--gains", "1,much"], "'1,much' is not a list of numbers"),
        (["equalize", "a.ply", "b.ply", "--gains", "1,,2"], "'1,,2' is not a list of numbers"),
        (["equalize", "a.ply", "b.ply", "--gains", "1 2"], "'1 2' is not a list of numbers"),
        (["equalize", "a.ply", "b.ply", "--gains", "1,nan"], "the gain of level 2 is nan"),
        (["equalize", "a.ply", "b.ply", "--gains=-1"], "the gain of level 1 is -1; it must be from 0 to 100"),
        (["equalize", "a.ply", "b.ply", "--gains", "101"], "the gain of level 1 is 101"),
        (["equalize", "a.ply", "b.ply", "--gains", "1,1,1,1,1,1,1"], "there are 7 gains, but at most 6"),
        (["equalize", "a.ply", "b.ply", "--gains", "1", "--levels", "2"], "unrecognized arguments: --levels"),
    ],
)
def test_usage_errors(fails, arguments, message):
    sentence = fails(*arguments, code=2)
    assert message in sentence
    assert "--help" in sentence
