# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is compared: presets, and every frame with every stencil and number of levels."""

from itertools import product
from typing import Any, NamedTuple

import checkout  # noqa: F401
from framelet.core import BANKS, PRESETS, DenoiseSettings
from framelet.core.settings.frame_catalog import FRAME_CATALOG

PRESET_FACTORS = (0.25, 0.5, 0.7, 1.4, 2.0, 4.0)
FRAME_FACTORS = (0.125, 0.25, 0.5, 2.0, 4.0)
"""What the default lambda is multiplied by, besides 1."""

SIGMAS_C = (0.7, 1.0, 1.5, 2.0)
SIGMAS_S = (0.0, 0.1, 0.15, 0.25, 0.4)
"""Widths of the bilateral filter; a sigma_s of 0 measures the heights of the mesh, which is the default. The
largest sigma_c is left out on large meshes, for time."""

LEVELS = (1, 2, 3)
NORMALS = ("FREE_FORM", "PRISMATIC")
"""Presets on normals, which the paper does not have."""

MAX_VERTICES = 7_000
"""Up to here every frame is run, on larger meshes only those of `ON_LARGE_MESHES`."""

ON_LARGE_MESHES = (("BOX_SPLINE_111", "STRAIGHT"), ("LINEAR_SPLINE", "STRAIGHT"), ("ADAPTIVE", "ADAPTIVE"))
"""Frames and stencils that run with all levels on meshes of any size."""


class Algorithm(NamedTuple):
    """Settings, and what they may be changed to when the best are looked for."""

    name: str
    group: str
    """PRESETS, FRAMES or EXTRA."""
    settings: DenoiseSettings
    grid: tuple[dict[str, Any], ...]


def algorithms_for(is_quad: bool, n_vertices: int, is_quick: bool) -> list[Algorithm]:
    """Return what is run on a mesh.

    Parameters
    ----------
    is_quad : bool
        True for a mesh of quads, False for one of triangles.
    n_vertices : int
        Its size.
    is_quick : bool
        True leaves out most.
    """
    found = [preset_algorithm(key, n_vertices) for key in preset_keys(is_quad)]
    if n_vertices <= MAX_VERTICES:
        found += extra_algorithms(is_quad)
    factors = FRAME_FACTORS[2:3] if is_quick else FRAME_FACTORS
    for frame, stencil in frames_for(is_quad):
        is_main = (frame, stencil) in ON_LARGE_MESHES
        all_levels = is_main or (n_vertices <= MAX_VERTICES and not is_quick)
        is_mean_of_main = stencil == "MEAN" and (frame, "STRAIGHT") in ON_LARGE_MESHES
        if not all_levels and not is_mean_of_main:
            continue
        for levels in LEVELS[: 2 if is_quick else 3] if all_levels else (1,):
            settings = DenoiseSettings(method="POSITIONS", frame=frame, stencil=stencil, levels=levels)
            found.append(
                Algorithm(f"{frame} {stencil} {levels}", "FRAMES", settings, lambda_grid(settings, factors))
            )
    return found


def preset_keys(is_quad: bool) -> tuple[str, ...]:
    """Return the presets for triangles or for quads."""
    return ("BILATERAL", "QUAD_1", "QUAD_2") if is_quad else ("BILATERAL", "TRI_1", "TRI_2")


def extra_algorithms(is_quad: bool) -> list[Algorithm]:
    """Return the paper's presets with more levels, and the presets on normals, at their defaults."""
    found = [
        Algorithm(f"{key} {levels}", "EXTRA", PRESETS[key].settings.with_changes(levels=levels), ())
        for key in preset_keys(is_quad)[1:]
        for levels in LEVELS[1:]
    ]
    return found + [Algorithm(key, "EXTRA", PRESETS[key].settings, ()) for key in NORMALS]


def preset_algorithm(key: str, n_vertices: int) -> Algorithm:
    """Return a preset with its grid on a mesh of some size."""
    settings = PRESETS[key].settings
    if settings.method == "BILATERAL":
        sigmas_c = SIGMAS_C if n_vertices <= MAX_VERTICES else SIGMAS_C[:-1]
        widths = [{"sigma_c": c, "sigma_s": s} for c, s in product(sigmas_c, SIGMAS_S)]
        grid = tuple(w for w in widths if settings.with_changes(**w) != settings)
    else:
        grid = lambda_grid(settings, PRESET_FACTORS)
    return Algorithm(key, "PRESETS", settings, grid)


def frames_for(is_quad: bool) -> list[tuple[str, str]]:
    """Return each frame that is made for the faces, with each stencil that makes a difference to it.

    Masks that fit the valence take no stencil but their own, and those of the larger banks follow lines of
    the mesh instead of a rule; with the stencil ADAPTIVE every frame is the frame ADAPTIVE.
    """
    found = []
    for entry in FRAME_CATALOG:
        if entry.lattice not in ("ANY", "QUADS" if is_quad else "TRIANGLES"):
            continue
        if entry.identifier not in BANKS:
            found.append((entry.identifier, "ADAPTIVE"))
            continue
        bank = BANKS[entry.identifier]
        is_walked = bank.is_cell_centered or bank.reach > 1
        found += [(entry.identifier, stencil) for stencil in ("MEAN", "STRAIGHT")[: 1 if is_walked else 2]]
    return found


def lambda_grid(settings: DenoiseSettings, factors: tuple[float, ...]) -> tuple[dict[str, Any], ...]:
    """Return the changes of lambda that are tried besides the default."""
    return tuple({"lambda_": round(factor * settings.lambda_, 4)} for factor in factors)
