# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the command line, made from the fields of DenoiseSettings.

Names, ranges, words and defaults are those of `core.settings`; a new field there is a new option here.
"""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import Field, fields
from typing import Any

from ...core.settings import (
    DEFAULT_PRESET,
    METHODS,
    PRESETS,
    DenoiseSettings,
    SettingInfo,
    check_setting,
    replaced_by,
    used_settings,
)
from ..properties.setting_values import has_effect
from .messages import USAGE_ERROR, CommandError

LONGEST_LIST = 60
"""Letters up to which the choices of an option stand beside its name; longer lists stand below it only."""


class HelpFormatter(argparse.HelpFormatter):
    """A formatter that keeps the lines of a help text, and words with dashes whole."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        wrapped = []
        for line in text.splitlines():
            indent = "  " if line.startswith("- ") else ""
            wrapped += textwrap.wrap(line, width, subsequent_indent=indent, break_on_hyphens=False)
        return wrapped

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        # Lines that are indented continue the one before.
        paragraphs = text.replace("\n  ", " ").splitlines()
        lines = [line for part in paragraphs for line in self._split_lines(part, width - len(indent)) or [""]]
        return "\n".join(indent + line for line in lines)


def option_name(field_name: str) -> str:
    """Return the option of a field: ``--sigma-c`` for ``sigma_c``, ``--lambda`` for ``lambda_``."""
    return "--" + as_word(field_name.rstrip("_"))


def as_word(identifier: str) -> str:
    """Return an identifier as it is typed: ``tri-1`` for ``TRI_1``."""
    return identifier.lower().replace("_", "-")


def add_setting_options(parser: argparse.ArgumentParser) -> None:
    """Add ``--preset`` and one option for each field of DenoiseSettings to a parser."""
    algorithm = parser.add_argument_group("algorithm")
    numbers = parser.add_argument_group("numbers", "Lengths are in mean edge lengths of the mesh.")
    algorithm.add_argument(
        "--preset",
        type=choice_type(PRESETS),
        metavar=choice_list(PRESETS),
        default=DEFAULT_PRESET,
        help=_escaped(
            f"Start from these settings; other options override them (default: {as_word(DEFAULT_PRESET)})"
            + describe_choices((key, preset.description) for key, preset in PRESETS.items())
        ),
    )
    for item in fields(DenoiseSettings):
        group = algorithm if item.metadata["info"].choices else numbers
        # None tells what was typed from what the preset says.
        _add_option(group, item, None, _default_text(item.name))


def add_frame_options(parser: argparse.ArgumentParser, names: Sequence[str]) -> None:
    """Add the options of some fields of DenoiseSettings, for commands that have no presets."""
    group = parser.add_argument_group("algorithm")
    by_name = {item.name: item for item in fields(DenoiseSettings)}
    for name in names:
        _add_option(group, by_name[name], by_name[name].default, _shown(by_name[name].default))


def settings_from(arguments: argparse.Namespace) -> DenoiseSettings:
    """Return the settings of the preset, with the options that were given put over them.

    Raises
    ------
    CommandError
        In one sentence, if an option was given that the method does not use.
    """
    given = {item.name: getattr(arguments, item.name) for item in fields(DenoiseSettings)}
    changes = {name: value for name, value in given.items() if value is not None}
    values = vars(PRESETS[arguments.preset].settings) | changes
    for name in changes:
        if not has_effect(values["method"], name):
            raise CommandError(_says_unused(name, arguments.preset, arguments.method), USAGE_ERROR)
    settings = DenoiseSettings(**used_settings(values))
    for name in changes:
        entry = replaced_by(settings, name)
        if entry is not None:
            other = f"{option_name(entry.beside)} {as_word(getattr(settings, entry.beside))}"
            raise CommandError(
                f"{option_name(name)} has no effect with {other}, {entry.reason}; leave one of them out.",
                USAGE_ERROR,
            )
    return settings


def _says_unused(name: str, preset: str, method: str | None) -> str:
    """Say that a method does not use an option, and what to add: a method or else a preset."""
    option = option_name(name)
    if method is not None:
        others = [item.identifier for item in METHODS if has_effect(item.identifier, name)]
        return f"{option} has no effect with --method {as_word(method)}; use --method {as_word(others[0])}."
    other = next(key for key, each in PRESETS.items() if has_effect(each.settings.method, name))
    if preset == DEFAULT_PRESET:
        return f"{option} has no effect with the preset {as_word(preset)}; add --preset {as_word(other)}."
    return f"{option} has no effect with --preset {as_word(preset)}; use --preset {as_word(other)}."


def _add_option(group: argparse._ArgumentGroup, item: Field[Any], default: Any, default_text: str) -> None:
    """Add the option of a field."""
    group.add_argument(
        option_name(item.name),
        dest=item.name,
        default=default,
        type=_value_type(item),
        metavar=_metavar(item),
        help=_escaped(_help(item, default_text)),
    )


def _value_type(item: Field[Any]) -> Callable[[str], Any]:
    """Return the function that reads the value of a field and checks it."""
    info: SettingInfo = item.metadata["info"]
    if info.choices:
        return choice_type([choice.identifier for choice in info.choices])
    read, wanted = (int, "a whole number") if item.type == "int" else (float, "a number")

    def value_of(text: str) -> int | float:
        try:
            value = read(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not {wanted}") from None
        try:
            check_setting(item.name, value)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return value

    return value_of


def choice_type(identifiers: Iterable[str]) -> Callable[[str], str]:
    """Return a function that reads one of some identifiers, in any case, with dashes or underscores."""
    names = tuple(identifiers)

    def identifier_of(text: str) -> str:
        identifier = text.upper().replace("-", "_")
        if identifier not in names:
            choices = ", ".join(as_word(name) for name in names)
            raise argparse.ArgumentTypeError(f"{text!r} is not one of {choices}")
        return identifier

    return identifier_of


def _metavar(item: Field[Any]) -> str:
    """Return what stands for the value in the help text."""
    info: SettingInfo = item.metadata["info"]
    if info.choices:
        return choice_list(choice.identifier for choice in info.choices)
    return "N" if item.type == "int" else "X"


def choice_list(identifiers: Iterable[str]) -> str:
    """Return the choices as argparse shows them, or a word for them if they are many."""
    choices = ",".join(as_word(identifier) for identifier in identifiers)
    return "{" + choices + "}" if len(choices) <= LONGEST_LIST else "NAME"


def _help(item: Field[Any], default_text: str) -> str:
    """Return label, description, defaults and choices of a field."""
    info: SettingInfo = item.metadata["info"]
    text = f"{info.description} (default: {default_text})"
    if as_word(info.label) != option_name(item.name).lstrip("-"):
        text = f"{info.label} ({info.symbol}): {text}" if info.symbol else f"{info.label}: {text}"
    return text + describe_choices((choice.identifier, choice.description) for choice in info.choices)


def _default_text(name: str) -> str:
    """Return the default of a field, the presets that have another one, and the methods that use it."""
    default = getattr(PRESETS[DEFAULT_PRESET].settings, name)
    text = _shown(default)
    for key, preset in PRESETS.items():
        value = getattr(preset.settings, name)
        if value != default:
            text += f"; preset {as_word(key)}: {_shown(value)}"
    methods = [method.identifier for method in METHODS if has_effect(method.identifier, name)]
    if len(methods) < len(METHODS):
        text += f"; method {' or '.join(map(as_word, methods))} only"
    return text


def _shown(value: Any) -> str:
    """Return a value as it is typed."""
    return as_word(value) if isinstance(value, str) else f"{value:g}"


def describe_choices(choices: Iterable[tuple[str, str]]) -> str:
    """Return choices and their descriptions, a line each."""
    return "".join(f"\n- {as_word(identifier)}: {description}" for identifier, description in choices)


def _escaped(text: str) -> str:
    """Return a help text in which argparse finds no formatting."""
    return text.replace("%", "%%")
