# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mathematics of Framelet on plain numpy arrays; knows nothing of Blender, files or printing.

The public names are imported when they are first used, so that enabling the extension costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .blocks import Stopped
    from .equalizer import equalize
    from .errors import FrameError, FrameletError, MeshError, RegionError, SettingError, TooLargeError
    from .frames import BANKS, FilterBank
    from .learned.noise_field import NoiseBelief, NoiseField
    from .library import (
        add_noise,
        bilateral_filter,
        compare,
        denoise,
        estimate_noise,
        face_normals,
        noise_field,
        prepare,
        vertex_normals,
    )
    from .library_tables import analyze, connect, make_stencil, make_transform
    from .limits.region import Region
    from .mesh.connectivity import Connectivity
    from .mesh.surface_mesh import SurfaceMesh
    from .methods.proximal import FirmThreshold, HardThreshold, SoftThreshold
    from .methods.solver import split_bregman
    from .metrics import Comparison
    from .noise import NoiseEstimate
    from .preparation_cache import PreparationCache
    from .prepared import Prepared
    from .report import DenoiseReport, DenoiseResult
    from .settings import DEFAULT_PRESET, PRESETS, DenoiseSettings
    from .stencils import Stencil
    from .transform import FrameCoefficients, FrameTransform, adjoint, synthesize

_NAMES = {
    ".equalizer": "equalize",
    ".blocks": "Stopped",
    ".errors": "FrameError FrameletError MeshError RegionError SettingError TooLargeError",
    ".frames": "BANKS FilterBank",
    ".learned.noise_field": "NoiseBelief NoiseField",
    ".library": "add_noise bilateral_filter compare denoise estimate_noise face_normals noise_field prepare "
    "vertex_normals",
    ".limits.region": "Region",
    ".mesh.connectivity": "Connectivity",
    ".mesh.surface_mesh": "SurfaceMesh",
    ".methods.proximal": "FirmThreshold HardThreshold SoftThreshold",
    ".methods.solver": "split_bregman",
    ".metrics": "Comparison",
    ".noise": "NoiseEstimate",
    ".preparation_cache": "PreparationCache",
    ".prepared": "Prepared",
    ".report": "DenoiseReport DenoiseResult",
    ".settings": "DEFAULT_PRESET DenoiseSettings PRESETS",
    ".stencils": "Stencil",
    ".library_tables": "analyze connect make_stencil make_transform",
    ".transform": "FrameCoefficients FrameTransform adjoint synthesize",
}
"""The public names of each module."""

_HOMES = {name: home for home, names in _NAMES.items() for name in names.split()}

__all__ = sorted(_HOMES)


def __dir__() -> list[str]:
    return __all__


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = import_module(_HOMES[name], __name__)
    # All names of a home at once: a module may be called like a function, as `denoise` is.
    globals().update({other: getattr(home, other) for other in _NAMES[_HOMES[name]].split()})
    return globals()[name]
