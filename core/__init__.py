# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mathematics of Framelet on plain numpy arrays; knows nothing of Blender, files or printing.

The public names are imported when they are first used, so that enabling the extension costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .denoise import denoise
    from .equalizer import equalize
    from .frames import BANKS, FilterBank
    from .learned.noise_field import NoiseBelief, NoiseField, noise_field
    from .limits.region import Region
    from .mesh.connectivity import Connectivity, connect
    from .mesh.surface_mesh import SurfaceMesh
    from .metrics import Comparison, compare
    from .noise import NoiseEstimate, add_noise, estimate_noise
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
    "FrameCoefficients": ".transform",
    "FrameTransform": ".transform",
    "NoiseBelief": ".learned.noise_field",
    "NoiseEstimate": ".noise",
    "NoiseField": ".learned.noise_field",
    "PRESETS": ".settings",
    "PreparationCache": ".preparation_cache",
    "Prepared": ".prepared",
    "Region": ".limits.region",
    "Stencil": ".stencils",
    "SurfaceMesh": ".mesh.surface_mesh",
    "add_noise": ".noise",
    "adjoint": ".transform",
    "analyze": ".transform",
    "compare": ".metrics",
    "connect": ".mesh.connectivity",
    "denoise": ".denoise",
    "equalize": ".equalizer",
    "estimate_noise": ".noise",
    "make_stencil": ".stencils",
    "make_transform": ".transform",
    "noise_field": ".learned.noise_field",
    "prepare": ".prepared",
    "synthesize": ".transform",
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
    "FrameCoefficients",
    "FrameTransform",
    "NoiseBelief",
    "NoiseEstimate",
    "NoiseField",
    "PreparationCache",
    "Prepared",
    "Region",
    "Stencil",
    "SurfaceMesh",
    "add_noise",
    "adjoint",
    "analyze",
    "compare",
    "connect",
    "denoise",
    "equalize",
    "estimate_noise",
    "make_stencil",
    "make_transform",
    "noise_field",
    "prepare",
    "synthesize",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name], __name__), name)
    globals()[name] = value
    return value
