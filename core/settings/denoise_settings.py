# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a denoising run: names, defaults, ranges, words and validation.

They exist once. The dataclass below is what scripts pass to `framelet.core.denoise`; operator properties,
scene settings and command line options are generated from its fields.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

from .choices import BOUNDARIES, FRAMES, METHODS, NOISES, SHRINKAGES, STENCILS, TUNINGS
from .effects import check_used
from .setting_info import SettingInfo as SettingInfo
from .setting_info import check_value
from .setting_info import setting_field as _setting


@dataclass(frozen=True)
class DenoiseSettings:
    """Parameters of `framelet.core.denoise`.

    Lengths (`lambda_`, `sigma_c`, `sigma_s`) are in units of the mean edge length of the mesh, so that the
    same numbers mean the same on every mesh. The defaults are those of the preset AUTO.

    Raises
    ------
    SettingError
        On construction, in one sentence, if a value is out of range or not one of the choices, or if a
        setting that the method does not use has another value than its default.

    Examples
    --------
    >>> DenoiseSettings(method="POSITIONS", lambda_=0.3).levels
    1
    >>> DenoiseSettings(lambda_=0.3)
    Traceback (most recent call last):
    ...
    framelet.core.errors.SettingError: lambda_ is 0.3, but the method AUTO does not use it; leave it out, or \
give method="POSITIONS".
    """

    method: str = _setting("AUTO", "Engine", "How the surface is cleaned", choices=METHODS)
    strength: float = _setting(
        1.0,
        "Strength",
        "How strong the noise is taken to be, in units of what the mesh shows, or of λ and of the height "
        "below: larger removes more noise and more detail; 1 trusts them, 0 changes nothing",
        minimum=0.0,
        maximum=10.0,
        soft_maximum=2.0,
    )
    noise: str = _setting(
        "AUTO",
        "Noise",
        "How wide the noise is: fine relief and wide noise look alike, and nobody but you knows which it is",
        choices=NOISES,
        methods=("AUTO",),
    )
    passes: int = _setting(
        2,
        "Passes",
        "How often the surface is cleaned, each time guided by the result before: larger cleans strong noise "
        "on machine parts better",
        minimum=1,
        maximum=10,
        soft_maximum=4,
        methods=("AUTO",),
    )
    tuning: str = _setting(
        "GIVEN",
        "Parameters",
        "Where λ, μ and the number of iterations come from",
        choices=TUNINGS,
        methods=("POSITIONS",),
    )
    frame: str = _setting(
        "AUTO",
        "Frame",
        "The filter bank of the wavelet frame",
        choices=FRAMES,
        methods=("POSITIONS",),
        own="masks",
    )
    stencil: str = _setting(
        "STRAIGHT",
        "Stencil",
        "Which points fill the masks at irregular vertices; masks wider than 3x3 and those on cells follow "
        "the lines of the mesh instead, except with Adaptive",
        choices=STENCILS,
        methods=("POSITIONS",),
    )
    shrinkage: str = _setting(
        "VECTOR", "Shrinkage", "What is shrunk together", choices=SHRINKAGES, methods=("POSITIONS",)
    )
    levels: int = _setting(
        1,
        "Levels",
        "Number of scales: larger also removes coarser noise",
        minimum=1,
        maximum=6,
        methods=("POSITIONS",),
    )
    lambda_: float = _setting(
        0.25,
        "Smoothing",
        "Weight of the frame coefficients, in mean edge lengths: larger removes more noise and more detail",
        minimum=0.0,
        maximum=100.0,
        soft_maximum=2.0,
        symbol="λ",
        methods=("POSITIONS",),
    )
    mu: float = _setting(
        1.0,
        "Penalty",
        "Coupling of surface and coefficients, without unit: larger takes smaller, safer steps and needs "
        "more iterations",
        minimum=1e-3,
        maximum=1e4,
        soft_maximum=20.0,
        symbol="μ",
        methods=("POSITIONS",),
    )
    delta: float = _setting(
        0.0,
        "Feedback",
        "Share of the removed detail that comes back at each iteration: larger stays closer to the input",
        minimum=0.0,
        maximum=1.0,
        symbol="δ",
        methods=("POSITIONS",),
    )
    iterations: int = _setting(
        10,
        "Iterations",
        "Number of iterations: larger comes closer to the minimum, which is smoother, and takes longer",
        minimum=1,
        maximum=10000,
        soft_maximum=50,
        methods=("POSITIONS", "BILATERAL"),
    )
    tolerance: float = _setting(
        0.0,
        "Tolerance",
        "Stop early once an iteration moves the vertices by less than this (rms, in mean edge lengths): "
        "larger stops sooner; 0 runs all iterations",
        minimum=0.0,
        maximum=1.0,
        soft_maximum=0.01,
        methods=("POSITIONS", "BILATERAL"),
    )
    boundary: str = _setting("ALONG", "Boundary", "What happens at open borders", choices=BOUNDARIES)
    sigma_c: float = _setting(
        1.0,
        "Neighborhood",
        "Bilateral: width of the neighborhood, in mean edge lengths; larger smooths over a wider area",
        minimum=0.1,
        maximum=4.0,
        symbol="σc",
        methods=("BILATERAL",),
    )
    sigma_s: float = _setting(
        0.0,
        "Height",
        "Bilateral: heights up to this are treated as noise, in mean edge lengths; larger smooths over "
        "higher features; 0 measures the heights of the mesh",
        minimum=0.0,
        maximum=10.0,
        soft_maximum=1.0,
        symbol="σs",
        methods=("BILATERAL",),
    )
    threads: int = _setting(
        0,
        "Threads",
        "Number of threads: larger is faster, up to the number of cores, with the same result; 0 uses all",
        minimum=0,
        maximum=256,
        soft_maximum=32,
    )

    def __post_init__(self) -> None:
        for item in fields(self):
            info, value = item.metadata["info"], getattr(self, item.name)
            check_value(info, str(item.type), value)
            if value != item.default:
                check_used(info, self.method, item.name, value)

    def with_changes(self, **changes: Any) -> DenoiseSettings:
        """Return a copy with some fields changed.

        Raises
        ------
        SettingError
            If a value is not allowed, or the method does not use it.
        """
        return replace(self, **changes)


INFOS: Mapping[str, SettingInfo] = {item.name: item.metadata["info"] for item in fields(DenoiseSettings)}
"""What is known of each setting, by name."""


def check_setting(name: str, value: Any) -> None:
    """Raise SettingError, in one sentence, unless a value is allowed for a setting, whatever the method."""
    item = next(item for item in fields(DenoiseSettings) if item.name == name)
    check_value(INFOS[name], str(item.type), value)


def used_settings(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return those of some values, by name, that the method among them uses.

    Interfaces show the settings of all methods at once; those of the others are not passed on.

    Examples
    --------
    >>> used_settings({"method": "BILATERAL", "sigma_c": 2.0, "lambda_": 0.3})
    {'method': 'BILATERAL', 'sigma_c': 2.0}
    """
    method = values.get("method", DenoiseSettings.method)
    return {name: value for name, value in values.items() if INFOS[name].has_effect(method)}


class Preset(NamedTuple):
    """A named algorithm: what it is for, and the settings that differ from the defaults."""

    label: str
    description: str
    changes: Mapping[str, Any]

    @property
    def settings(self) -> DenoiseSettings:
        """The complete settings of this preset."""
        return DenoiseSettings(**self.changes)


PRESETS: Mapping[str, Preset] = {
    "AUTO": Preset(
        "Automatic",
        "For any noisy mesh: sees how strong the noise is at each place; keeps sharp features",
        {"method": "AUTO"},
    ),
    "FREE_FORM": Preset(
        "Scan (free-form)",
        "For scans and organic shapes: takes noise that is several edges wide for noise, too",
        {"method": "AUTO", "noise": "WIDE", "strength": 1.5},
    ),
    "PRISMATIC": Preset(
        "CAD (prismatic)",
        "For machine parts and buildings with strong noise: one pass more, for sharper creases",
        {"method": "AUTO", "passes": 3},
    ),
    "MARCHING_CUBES": Preset(
        "Marching Cubes / CT",
        "For surfaces made of voxels, as from CT: turns steps into smooth shapes and does not shrink them",
        {"method": "AUTO", "noise": "WIDE", "passes": 3},
    ),
    "SCULPT": Preset(
        "Sculpt (keep detail)",
        "For sculpted and finely detailed meshes with a little noise: keeps strokes a few edges wide",
        {"method": "AUTO", "noise": "FINE"},
    ),
    "POSITIONS": Preset(
        "Positions",
        "For even, soft smoothing of any mesh: the frame that fits its faces, vector shrinkage",
        {"method": "POSITIONS"},
    ),
    "TRI_1": Preset(
        "Paper Tri-1",
        "The paper's algorithm for triangles, even and soft: one-ring means, all bands shrunk together",
        {
            "method": "POSITIONS",
            "frame": "BOX_SPLINE_111",
            "stencil": "MEAN",
            "shrinkage": "BANDS",
            "lambda_": 0.5,
        },
    ),
    "TRI_2": Preset(
        "Paper Tri-2",
        "The paper's algorithm for triangles that keeps edges better: straight pairs, vector shrinkage",
        {"method": "POSITIONS", "frame": "BOX_SPLINE_111", "lambda_": 0.3},
    ),
    "QUAD_1": Preset(
        "Paper Quad-1",
        "The paper's algorithm for quads, even and soft: one-ring means, every number shrunk by itself",
        {
            "method": "POSITIONS",
            "frame": "LINEAR_SPLINE",
            "stencil": "MEAN",
            "shrinkage": "SCALAR",
            "lambda_": 0.15,
        },
    ),
    "QUAD_2": Preset(
        "Paper Quad-2",
        "The paper's algorithm for quads that keeps edges better: straight pairs, vector shrinkage",
        {"method": "POSITIONS", "frame": "LINEAR_SPLINE", "lambda_": 0.2},
    ),
    "BILATERAL": Preset(
        "Bilateral",
        "The method that the paper compares with: bilateral mesh filtering, five iterations",
        {"method": "BILATERAL", "iterations": 5},
    ),
}
"""In the order in which lists show them, each with one line that says what it is for."""

DEFAULT_PRESET = "AUTO"
