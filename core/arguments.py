# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts may give: arrays for a mesh, words in any case for choices, keywords for settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from inspect import Parameter, Signature, signature
from types import SimpleNamespace
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar, overload

from numpy.typing import ArrayLike

from .errors import MeshError, SettingError
from .mesh.surface_mesh import SurfaceMesh
from .settings import INFOS, PRESETS, DenoiseSettings, check_effect, check_used
from .value_checks import check_choice, shown

Rest = ParamSpec("Rest")
Result = TypeVar("Result", covariant=True)


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


class TakesMesh(Protocol[Rest, Result]):
    """A function of a mesh as arrays or as a `SurfaceMesh`, and of what else it needs."""

    @overload
    def __call__(self, mesh: SurfaceMesh, /, *rest: Rest.args, **options: Rest.kwargs) -> Result: ...

    @overload
    def __call__(self, vertices: ArrayLike, faces: ArrayLike, /, *rest: Any, **options: Any) -> Result: ...


def takes_mesh(function: Callable[Concatenate[SurfaceMesh, Rest], Result]) -> TakesMesh[Rest, Result]:
    """Let a function of a mesh take vertices and faces in its place; `offsets` by name, see `as_mesh`.

    Examples
    --------
    >>> @takes_mesh
    ... def size(mesh, unit=1.0):
    ...     return mesh.n_faces * unit
    >>> size(np.eye(3), [[0, 1, 2]], 2.0), size(SurfaceMesh.from_faces(np.eye(3), [[0, 1, 2]]), 2.0)
    (2.0, 2.0)
    """

    @wraps(function)
    def call(*arguments: Any, **options: Any) -> Result:
        mesh, rest = split_mesh(arguments, options)
        return function(mesh, *rest, **options)

    call.__signature__ = signature_with_faces(function)  # type: ignore[attr-defined]
    return call


def split_mesh(arguments: tuple[Any, ...], options: dict[str, Any]) -> tuple[SurfaceMesh, list[Any]]:
    """Return the mesh that arguments begin with, as arrays or as it is, and the others.

    `faces` and `offsets` may be given by name, and are taken out of `options`.
    """
    if not arguments:
        raise MeshError("There is no mesh; give vertices and faces, or a SurfaceMesh, first.")
    mesh, *rest = arguments
    faces, offsets = options.pop("faces", None), options.pop("offsets", None)
    if faces is None and rest and not isinstance(mesh, SurfaceMesh):
        faces = rest.pop(0)
    return as_mesh(mesh, faces, offsets), rest


def signature_with_faces(function: Callable[..., Any]) -> Signature:
    """Return the signature of a function of a mesh with `vertices, faces` for the mesh, and `offsets`."""
    known = signature(function)
    _, *rest = known.parameters.values()
    first = [Parameter(name, Parameter.POSITIONAL_ONLY) for name in ("vertices", "faces")]
    offsets = Parameter("offsets", Parameter.KEYWORD_ONLY, default=None)
    open_ended = [each for each in rest if each.kind is Parameter.VAR_KEYWORD]
    named = [each for each in rest if each.kind is not Parameter.VAR_KEYWORD]
    return known.replace(parameters=[*first, *named, offsets, *open_ended])


def as_identifier(word: Any) -> Any:
    """Return a word as choices are called, as ``"TRI_2"`` for ``"tri-2"``, and anything else as it is."""
    return word.upper().replace("-", "_") if isinstance(word, str) else word


def check_frame(frame: Any, stencil: Any) -> None:
    """Raise SettingError if a frame is asked for that the stencil replaces."""
    given = {"method": "POSITIONS", "tuning": "GIVEN", "frame": frame, "stencil": stencil}
    check_effect(SimpleNamespace(**given), "frame")


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
        key = as_identifier(name)
        check_choice("The preset", key, PRESETS)
        base = PRESETS[key].settings
    changes = dict(values)
    for each, value in changes.items():
        if each not in INFOS:
            raise SettingError(f"There is no setting {each}; choose from {', '.join(INFOS)}.")
        if INFOS[each].choices:
            changes[each] = as_identifier(value)
    found = base.with_changes(**changes)
    for each, value in changes.items():  # what was given by name counts, the default value too
        check_used(INFOS[each], found.method, each, value)
        check_effect(found, each)
    return found
