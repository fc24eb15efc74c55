# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the command line for a region, made from the fields of RegionOptions."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import Field, fields
from typing import Any

from ...core.settings.setting_info import SettingInfo
from ..properties.region_options import RegionOptions
from .messages import USAGE_ERROR, CommandError


def option_name(item: Field[Any]) -> str:
    """Return the option of a field; of a switch there is also ``--no-...``."""
    return f"--{item.name.replace('_', '-')}"


def add_region_options(parser: argparse.ArgumentParser) -> None:
    """Add one option for each field of RegionOptions to a parser, besides `limit`."""
    group = parser.add_argument_group("region", "Lengths are in units of the file, with the objects' scale.")
    for item in fields(RegionOptions):
        info: SettingInfo = item.metadata["info"]
        if info.choices:
            continue
        words = info.description.replace("%", "%%")
        if item.type == "bool":
            words = f"{info.label}: {words} (default: {'on' if item.default else 'off'})"
            action = argparse.BooleanOptionalAction
            group.add_argument(option_name(item), dest=item.name, action=action, help=words)
            continue
        is_text = item.type == "str"
        group.add_argument(
            option_name(item),
            dest=item.name,
            type=str if is_text else _number_type(item),
            metavar={"str": "NAME", "int": "N"}.get(str(item.type), "X"),
            default=None,
            help=f"{info.label}: {words}",
        )


def region_options_from(arguments: argparse.Namespace) -> RegionOptions:
    """Return the options that were given.

    Raises
    ------
    CommandError
        In one sentence, if two options contradict each other or one has no effect.
    """
    given = {
        item.name: getattr(arguments, item.name)
        for item in fields(RegionOptions)
        if getattr(arguments, item.name, None) is not None
    }
    if "max_edges" in given and "max_length" in given:
        raise CommandError("--max-edges and --max-length are two limits; leave one of them out.", USAGE_ERROR)
    if given.get("invert_group") and not given.get("vertex_group"):
        raise CommandError("--invert-group has no effect without --vertex-group; add it.", USAGE_ERROR)
    if "weld_distance" in given and not given.get("weld", True):
        raise CommandError("--weld-distance has no effect with --no-weld; leave one out.", USAGE_ERROR)
    for name, limit in (("max_edges", "EDGES"), ("max_length", "LENGTH")):
        if name in given:
            given["limit"] = limit
    return RegionOptions(**given)


def _number_type(item: Field[Any]) -> Callable[[str], int | float]:
    """Return the function that reads the value of a field and checks it."""

    read, wanted = (int, "a whole number") if item.type == "int" else (float, "a number")

    def value_of(text: str) -> int | float:
        try:
            value = read(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not {wanted}") from None
        change: dict[str, Any] = {item.name: value}
        try:
            RegionOptions(**change)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return value

    return value_of
