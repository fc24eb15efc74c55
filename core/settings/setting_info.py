# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What interfaces need to know about a setting, and how its values are checked."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ..errors import SettingError
from ..value_checks import check_choice, check_number
from .choices import Choice


@dataclass(frozen=True)
class SettingInfo:
    """What a user interface needs to know about one setting.

    Its words stand beside its range, as a docstring stands beside its function: the library's errors, the
    options of the command line and Blender's properties all say them, and a table elsewhere would have to
    follow each change.

    `soft_maximum` is where a slider ends; typing may go up to `maximum`. `symbol` is the paper's letter.
    `methods` are the methods that use the setting; empty for all. `own` is an attribute by which an object
    of one's own is known that may stand for a choice. `unit` is LENGTH for lengths in the scene.
    """

    label: str
    description: str
    minimum: float | None = None
    maximum: float | None = None
    soft_maximum: float | None = None
    choices: tuple[Choice, ...] = ()
    symbol: str = ""
    methods: tuple[str, ...] = ()
    unit: str = ""
    own: str = ""

    def has_effect(self, method: str) -> bool:
        """Tell whether a method uses the setting."""
        return not self.methods or method in self.methods


def setting_field(default: Any, label: str, description: str, **info: Any) -> Any:
    """Return the dataclass field of a setting; `info` are further fields of `SettingInfo`."""
    return field(default=default, metadata={"info": SettingInfo(label, description, **info)})


def check_value(info: SettingInfo, kind: str, value: Any) -> None:
    """Raise SettingError, with the value, unless it is allowed for this setting.

    `kind` is the type of the field: "int", "float", "bool" or "str".
    """
    label = f"{info.label} ({info.symbol})" if info.symbol else info.label
    if info.own and hasattr(value, info.own):
        return
    if info.choices:
        names = [choice.identifier for choice in info.choices]
        check_choice(label, value, names)
        return
    if kind in ("bool", "str"):
        if type(value).__name__ != kind:
            wanted = "True or False" if kind == "bool" else "a text"
            raise SettingError(f"{label} is {value!r}; it must be {wanted}.")
        return
    assert info.minimum is not None and info.maximum is not None
    check_number(label, value, info.minimum, info.maximum, is_whole=kind == "int")
