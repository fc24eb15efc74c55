# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions for scripts. All take a mesh as arrays, vertices and faces, or as a `SurfaceMesh`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from .arguments import as_mesh, as_settings, takes_mesh
from .blocks import Blocks
from .denoise import denoise as _walk
from .errors import MeshError, SettingError
from .learned.noise_field import NoiseField
from .learned.noise_field import noise_field as _noise_field
from .limits.region import Region
from .mesh import geometry
from .mesh.connectivity import Connectivity
from .mesh.surface_mesh import SurfaceMesh
from .methods.problem import Callback
from .metrics import Comparison
from .metrics import compare as _compare
from .noise.estimate import NoiseEstimate
from .noise.estimate import estimate_noise as _estimate
from .noise.model import PAPER_SIGMA
from .noise.model import add_noise as _add
from .preparation_cache import PreparationCache
from .prepared import Prepared
from .prepared import prepare as _prepare
from .report import DenoiseResult
from .settings import DenoiseSettings
from .value_checks import check_kind


@overload
def denoise(
    mesh: SurfaceMesh,
    faces: DenoiseSettings | str | None = None,
    *,
    settings: DenoiseSettings | None = None,
    preset: str | None = None,
    movable: ArrayLike | None = None,
    region: Region | None = None,
    connectivity: Connectivity | None = None,
    callback: Callback | None = None,
    should_stop: Callable[[], bool] | None = None,
    dtype: DTypeLike = np.float32,
    prepared: Prepared | PreparationCache | None = None,
    max_bytes: int | None = None,
    **values: Any,
) -> DenoiseResult: ...


@overload
def denoise(
    mesh: ArrayLike, faces: ArrayLike, settings: DenoiseSettings | str | None = None, **options: Any
) -> Any: ...


def denoise(
    mesh: SurfaceMesh | ArrayLike,
    faces: ArrayLike | DenoiseSettings | str | None = None,
    settings: DenoiseSettings | str | None = None,
    *,
    preset: str | None = None,
    offsets: ArrayLike | None = None,
    movable: ArrayLike | None = None,
    region: Region | None = None,
    connectivity: Connectivity | None = None,
    callback: Callback | None = None,
    should_stop: Callable[[], bool] | None = None,
    dtype: DTypeLike = np.float32,
    prepared: Prepared | PreparationCache | None = None,
    max_bytes: int | None = None,
    full_output: bool | None = None,
    **values: Any,
) -> NDArray[np.floating] | DenoiseResult:
    """Clean a noisy surface.

    Parameters
    ----------
    mesh : array_like, shape (N, 3), or SurfaceMesh
        Positions, or a mesh for those who use it again; not modified.
    faces : array_like of int, shape (F, k), or list of lists
        The vertices of each face. Beside a `SurfaceMesh`: settings, or the name of a preset.
    settings : DenoiseSettings or str, optional
        The method and its parameters, or the name of a preset; by default AUTO.
    preset : str, optional
        Name of a preset, in any case: one of `PRESETS`, such as "auto", "free-form" or "tri-2".
    offsets : array_like of int, shape (F + 1,), optional
        First corner of each face, and the number of corners: `faces` is then the flat list of all corners.
    movable : array_like, shape (N,), bool, optional
        Vertices that may move; all by default.
    region, connectivity, callback, should_stop, dtype, prepared, max_bytes : optional
        See `core.denoise.denoise`.
    full_output : bool, optional
        Whether to return positions and report; by default so for a `SurfaceMesh`.
    **values
        Fields of `DenoiseSettings`; choices in any case. The frame may be a `FilterBank` of your own. A value
        without effect is an error, the default value too: the method does not use it, or another setting
        replaces it, as the tuning "noise" does λ.

    Returns
    -------
    ndarray, shape (N, 3), or DenoiseResult
        Positions in the dtype of the input, and with `full_output` the report.

    Raises
    ------
    FrameletError
        In one sentence: MeshError, SettingError, FrameError, RegionError or TooLargeError.

    Examples
    --------
    >>> vertices = np.random.default_rng(0).normal(0, 0.02, (9, 9, 3))
    >>> vertices[..., :2] += np.stack(np.meshgrid(range(9), range(9)), axis=-1)
    >>> corner = np.arange(72).reshape(8, 9)[:, :8].ravel()
    >>> faces = np.stack((corner, corner + 1, corner + 10, corner + 9), axis=1)
    >>> denoise(vertices.reshape(-1, 3), faces).shape
    (81, 3)
    >>> denoise(vertices.reshape(-1, 3), faces, preset="quad-2", levels=2, full_output=True).report.iterations
    10
    """
    check_kind("full_output", full_output, (bool, np.bool_), "True or False")
    is_arrays = not isinstance(mesh, SurfaceMesh)
    if not is_arrays and isinstance(faces, DenoiseSettings | str):
        given: Any = faces if settings is None else settings
        surface = as_mesh(mesh, None, offsets)
    else:
        given = settings
        surface = as_mesh(mesh, faces, offsets)  # type: ignore[arg-type]
    result = _walk(
        surface,
        as_settings(given, preset, values),
        movable=movable,  # type: ignore[arg-type]
        region=region,
        connectivity=connectivity,
        callback=callback,
        should_stop=should_stop,
        dtype=dtype,
        prepared=prepared,
        max_bytes=max_bytes,
    )
    return result.vertices if (is_arrays and not full_output) or full_output is False else result


@takes_mesh
def bilateral_filter(mesh: SurfaceMesh, /, **options: Any) -> NDArray[np.floating]:
    """Return the positions, shape (N, 3), after the bilateral filter of Fleishman et al.

    It is `denoise` with the preset BILATERAL; `options` are its settings `iterations`, `tolerance`,
    `sigma_c`, `sigma_s`, `boundary` and `threads`, and what else `denoise` takes.

    Examples
    --------
    >>> flat = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> bool(np.allclose(bilateral_filter(flat, [[0, 1, 2, 3]], iterations=2), flat))
    True
    """
    for name in ("preset", "settings", "full_output"):
        if name in options:
            raise SettingError(f"The bilateral filter has no {name}; call denoise, which has.")
    return denoise(mesh, preset="BILATERAL", **options).vertices


@takes_mesh
def estimate_noise(
    mesh: SurfaceMesh, *, connectivity: Connectivity | None = None, threads: int = 0
) -> NoiseEstimate:
    """Estimate the noise of a mesh from the mesh alone; see `core.noise.estimate.estimate_noise`.

    Examples
    --------
    >>> flat = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> estimate_noise(flat, [[0, 1, 2, 3]]).sigma
    0.0
    """
    with Blocks(threads) as blocks:
        return _estimate(mesh, connectivity, blocks)


@takes_mesh
def add_noise(mesh: SurfaceMesh, sigma: float = PAPER_SIGMA, seed: int = 0) -> NDArray[np.floating]:
    """Return positions, shape (N, 3), with the paper's noise; see `core.noise.model.add_noise`.

    Examples
    --------
    >>> flat = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> add_noise(flat, [[0, 1, 2, 3]], 0.1, seed=1)[:, 2].round(3).tolist()
    [0.035, 0.082, 0.033, -0.13]
    """
    return _add(mesh, sigma, seed)


def compare(
    mesh: SurfaceMesh | ArrayLike,
    faces: SurfaceMesh | ArrayLike | None = None,
    reference: SurfaceMesh | ArrayLike | None = None,
    *,
    offsets: ArrayLike | None = None,
) -> Comparison:
    """Compare a surface with a reference of the same faces; see `core.metrics.compare`.

    Parameters
    ----------
    mesh, faces : array_like
        The surface; or a `SurfaceMesh` in place of both, and in place of the faces the reference itself, if
        that is one.
    reference : SurfaceMesh, or array_like, shape (N, 3)
        A mesh with the same faces, or the positions of one.
    offsets : array_like, optional
        As in `denoise`.

    Examples
    --------
    >>> flat = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> compare(flat + [0, 0, 0.5], [[0, 1, 2, 3]], flat).rms_distance
    0.5
    """
    if reference is None:  # two arguments, and at least one is a mesh
        if isinstance(mesh, SurfaceMesh):
            faces, reference = None, faces
        elif isinstance(faces, SurfaceMesh):
            mesh, faces, reference = faces.with_vertices(mesh), None, faces
        if reference is None:
            raise MeshError("There is no reference; give positions or a SurfaceMesh to compare with.")
    surface = as_mesh(mesh, faces, offsets)  # type: ignore[arg-type]
    return _compare(
        surface, reference if isinstance(reference, SurfaceMesh) else surface.with_vertices(reference)
    )


@takes_mesh
def face_normals(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """Return the unit normals of the faces, shape (F, 3); 0 for faces without area.

    Examples
    --------
    >>> face_normals([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 2]]).tolist()
    [[0.0, 0.0, 1.0]]
    """
    return geometry.face_normals(mesh)


@takes_mesh
def vertex_normals(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """Return unit normals at the vertices, shape (N, 3): area-weighted means of the faces; 0 without a face.

    Examples
    --------
    >>> vertex_normals([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 2]]).tolist()
    [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
    """
    return geometry.vertex_normals(mesh)


@takes_mesh
def noise_field(mesh: SurfaceMesh, after: ArrayLike) -> NoiseField:
    """Return the noise that was taken away from a mesh; see `core.learned.noise_field.noise_field`.

    Parameters
    ----------
    vertices, faces : array_like
        The surface before, or a `SurfaceMesh` in place of both.
    after : array_like, shape (N, 3)
        Its positions after.

    Examples
    --------
    >>> flat = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> noise_field(flat + [0, 0, 0.25], [[0, 1, 2, 3]], flat).strength.round(6).tolist()
    [0.25, 0.25, 0.25, 0.25]
    """
    return _noise_field(mesh, after)  # type: ignore[arg-type]


prepare = takes_mesh(_prepare)
