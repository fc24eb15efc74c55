# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which settings have no effect beside the others, for scripts, the command line and panels."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..errors import SettingError
from ..value_checks import shown
from .setting_info import SettingInfo


class Replaced(NamedTuple):
    """Settings of a method that do not count beside certain values of another one, `beside`.

    Their values in `unless` do. `reason` ends the sentence that says so.
    """

    method: str
    names: tuple[str, ...]
    beside: str
    values: tuple[str, ...]
    reason: str
    unless: tuple[str, ...] = ()


REPLACED = (
    Replaced(
        "POSITIONS",
        ("lambda_", "mu", "iterations"),
        "tuning",
        ("NOISE",),
        "which takes it from the measured noise",
    ),
    Replaced(
        "POSITIONS",
        ("frame",),
        "stencil",
        ("ADAPTIVE",),
        "which has masks of its own",
        unless=("AUTO", "ADAPTIVE", "PAIRWISE"),
    ),
    Replaced(
        "POSITIONS",
        ("stencil",),
        "frame",
        ("ADAPTIVE", "PAIRWISE"),
        "whose masks fit every vertex",
        unless=("ADAPTIVE",),
    ),
)


def replaced_by(settings: Any, name: str) -> Replaced | None:
    """Return the entry by which a setting has no effect beside the others; None if there is none.

    Parameters
    ----------
    settings : DenoiseSettings, or anything with the same attributes
        All of them.
    name : str
        The one in question.

    Examples
    --------
    >>> from framelet.core import DenoiseSettings
    >>> replaced_by(DenoiseSettings(method="POSITIONS", tuning="NOISE"), "mu").beside
    'tuning'
    """
    for entry in REPLACED:
        value, other = getattr(settings, name), getattr(settings, entry.beside)
        is_used = name in entry.names and settings.method == entry.method
        if is_used and isinstance(other, str) and other in entry.values:
            return None if isinstance(value, str) and value in entry.unless else entry
    return None


def check_used(info: SettingInfo, method: str, name: str, value: Any) -> None:
    """Raise SettingError unless a method uses a setting."""
    if not info.has_effect(method):
        raise SettingError(
            f"{name} is {_shown(value)}, but the method {method} does not use it; leave it out, or give "
            f'method="{info.methods[0]}".'
        )


def check_effect(settings: Any, name: str) -> None:
    """Raise SettingError if another setting replaces one that was given."""
    entry = replaced_by(settings, name)
    if entry is not None:
        other = f'{entry.beside}="{getattr(settings, entry.beside)}"'
        raise SettingError(
            f"{name} is {_shown(getattr(settings, name))}, but has no effect with {other}, {entry.reason}; "
            "leave one of them out."
        )


def _shown(value: Any) -> str:
    return f"{value:g}" if isinstance(value, int | float) else shown(value)
