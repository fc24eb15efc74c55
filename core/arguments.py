# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts may give: arrays for a mesh, words in any case for choices, keywords for settings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import ArrayLike

from .errors import MeshError, SettingError
from .mesh.surface_mesh import SurfaceMesh
from .settings import INFOS, PRESETS, DenoiseSettings, check_counts, check_used
from .value_checks import check_choice, shown


def as_mesh(
    mesh: SurfaceMesh | ArrayLike, faces: ArrayLike | None = None, offsets: ArrayLike | None = None
) -> SurfaceMesh:
    """Return a mesh as it was given, or made of positions and faces; see `SurfaceMesh.from_faces`.

    Raises
    ------
    MeshError
        If there are no faces, or faces beside a mesh that has its own, or if they are no mesh.
    """
    if isinstance(mesh, SurfaceMesh):
        if faces is not None or offsets is not None:
            raise MeshError("The mesh has faces of its own; give either a SurfaceMesh or vertices and faces.")
        return mesh
    if faces is None:
        raise MeshError("There are no faces; give vertices and faces, or a SurfaceMesh.")
    return SurfaceMesh.from_faces(mesh, faces, offsets=offsets)


def as_identifier(word: str) -> str:
    """Return a word as choices are called, as ``"TRI_2"`` for ``"tri-2"``."""
    return word.upper().replace("-", "_")


def as_settings(
    settings: DenoiseSettings | str | None, preset: str | None, values: Mapping[str, Any]
) -> DenoiseSettings:
    """Return the settings of a run.

    Parameters
    ----------
    settings : DenoiseSettings or str or None
        All of them, or the name of a preset.
    preset : str or None
        The name of a preset, if no settings are given.
    values : mapping
        Values by name, put over these.

    Raises
    ------
    SettingError
        If a name is not known, a value is not allowed, or a value given by name has no effect: the method
        does not use it, or another setting replaces it.

    Examples
    --------
    >>> as_settings("tri-2", None, {"levels": 2}).lambda_
    0.3
    >>> as_settings(None, None, {"strenght": 2})
    Traceback (most recent call last):
    ...
    framelet.core.errors.SettingError: There is no setting strenght; choose from method, strength, noise, ...
    """
    if settings is not None and not isinstance(settings, DenoiseSettings | str):
        raise SettingError(
            f"The settings are {shown(settings)}; give DenoiseSettings or the name of a preset."
        )
    if settings is not None and preset is not None:
        raise SettingError("There are settings and a preset; give one of them.")
    base = settings if isinstance(settings, DenoiseSettings) else DenoiseSettings()
    name = settings if isinstance(settings, str) else preset
    if name is not None:
        key = as_identifier(name) if isinstance(name, str) else name
        check_choice("The preset", key, PRESETS)
        base = PRESETS[key].settings
    changes = dict(values)
    for each, value in changes.items():
        if each not in INFOS:
            raise SettingError(f"There is no setting {each}; choose from {', '.join(INFOS)}.")
        if INFOS[each].choices and isinstance(value, str):
            changes[each] = as_identifier(value)
    found = base.with_changes(**changes)
    for each, value in changes.items():  # what was given by name counts, the default value too
        check_used(INFOS[each], found.method, each, value)
        check_counts(found, each)
    return found
