# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mathematics of Framelet on plain numpy arrays; knows nothing of Blender, files or printing.

The public names are imported when they are first used, so that enabling the extension costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .equalizer import equalize
    from .errors import FrameError, FrameletError, MeshError, RegionError, SettingError, TooLargeError
    from .frames import BANKS, FilterBank
    from .learned.noise_field import NoiseBelief, NoiseField, noise_field
    from .library import (
        add_noise,
        bilateral_filter,
        compare,
        denoise,
        estimate_noise,
        face_normals,
        vertex_normals,
    )
    from .limits.region import Region
    from .mesh.connectivity import Connectivity, connect
    from .mesh.surface_mesh import SurfaceMesh
    from .methods.proximal import FirmThreshold, HardThreshold, SoftThreshold
    from .methods.solver import split_bregman
    from .metrics import Comparison
    from .noise import NoiseEstimate
    from .preparation_cache import PreparationCache
    from .prepared import Prepared, prepare
    from .report import DenoiseReport, DenoiseResult
    from .settings import DEFAULT_PRESET, PRESETS, DenoiseSettings
    from .stencils import Stencil, make_stencil
    from .transform import FrameCoefficients, FrameTransform, adjoint, analyze, make_transform, synthesize

_HOMES = {
    "BANKS": ".frames",
    "Comparison": ".metrics",
    "Connectivity": ".mesh.connectivity",
    "DEFAULT_PRESET": ".settings",
    "DenoiseReport": ".report",
    "DenoiseResult": ".report",
    "DenoiseSettings": ".settings",
    "FilterBank": ".frames",
    "FirmThreshold": ".methods.proximal",
    "FrameCoefficients": ".transform",
    "FrameError": ".errors",
    "FrameTransform": ".transform",
    "FrameletError": ".errors",
    "HardThreshold": ".methods.proximal",
    "MeshError": ".errors",
    "NoiseBelief": ".learned.noise_field",
    "NoiseEstimate": ".noise",
    "NoiseField": ".learned.noise_field",
    "PRESETS": ".settings",
    "PreparationCache": ".preparation_cache",
    "Prepared": ".prepared",
    "Region": ".limits.region",
    "RegionError": ".errors",
    "SettingError": ".errors",
    "SoftThreshold": ".methods.proximal",
    "Stencil": ".stencils",
    "SurfaceMesh": ".mesh.surface_mesh",
    "TooLargeError": ".errors",
    "add_noise": ".library",
    "adjoint": ".transform",
    "analyze": ".transform",
    "bilateral_filter": ".library",
    "compare": ".library",
    "connect": ".mesh.connectivity",
    "denoise": ".library",
    "equalize": ".equalizer",
    "estimate_noise": ".library",
    "face_normals": ".library",
    "make_stencil": ".stencils",
    "make_transform": ".transform",
    "noise_field": ".learned.noise_field",
    "prepare": ".prepared",
    "split_bregman": ".methods.solver",
    "synthesize": ".transform",
    "vertex_normals": ".library",
}

__all__ = [
    "BANKS",
    "DEFAULT_PRESET",
    "PRESETS",
    "Comparison",
    "Connectivity",
    "DenoiseReport",
    "DenoiseResult",
    "DenoiseSettings",
    "FilterBank",
    "FirmThreshold",
    "FrameCoefficients",
    "FrameError",
    "FrameTransform",
    "FrameletError",
    "HardThreshold",
    "MeshError",
    "NoiseBelief",
    "NoiseEstimate",
    "NoiseField",
    "PreparationCache",
    "Prepared",
    "Region",
    "RegionError",
    "SettingError",
    "SoftThreshold",
    "Stencil",
    "SurfaceMesh",
    "TooLargeError",
    "add_noise",
    "adjoint",
    "analyze",
    "bilateral_filter",
    "compare",
    "connect",
    "denoise",
    "equalize",
    "estimate_noise",
    "face_normals",
    "make_stencil",
    "make_transform",
    "noise_field",
    "prepare",
    "split_bregman",
    "synthesize",
    "vertex_normals",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = import_module(_HOMES[name], __name__)
    # All names of a home at once: a module may be called like a function, as `denoise` is.
    names = [other for other, place in _HOMES.items() if place == _HOMES[name]]
    globals().update({other: getattr(home, other) for other in names})
    return globals()[name]
