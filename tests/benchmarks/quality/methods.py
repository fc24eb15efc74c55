# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The methods that are compared: Framelet's presets, and baselines with a grid of settings."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
import sources  # noqa: F401
from baselines import bilateral_normals, guided_normals, taubin
from baselines.surface_arrays import update_vertices
from cases import Case
from framelet.core import PRESETS, denoise

Settings = Mapping[str, Any]

FEWER_READINGS = 20_000
"""From this many faces on there are fewer readings of the filters of normals, for time."""

FEWER_VALUES = 60_000
"""From this many faces on there are fewer values of the knob, too."""


class Reading(NamedTuple):
    """A result of a method."""

    settings: Settings
    positions: np.ndarray
    """Shape (N, 3)."""
    seconds: float
    """Time on one thread, without the search for neighborhoods that depend on the topology alone."""


class Preset:
    """One of Framelet's presets, as it is."""

    def __init__(self, key: str) -> None:
        self.name = key
        self.settings = dict(PRESETS[key].changes)

    def is_available(self) -> bool:
        """Tell whether the method can run here."""
        return True

    def serves(self, is_quad: bool) -> bool:
        """Tell whether the preset is for models of quads, or of triangles."""
        kind = "TRI_" if is_quad else "QUAD_"
        return not self.name.startswith(kind)

    def run(self, case: Case, settings: Settings) -> Reading:
        """Denoise a case with the preset."""
        full = PRESETS[self.name].settings.with_changes(**settings, threads=1)
        connectivity = case.model.connectivity
        began = perf_counter()
        positions = denoise(case.noisy, full, connectivity=connectivity).vertices
        return Reading(settings, positions, perf_counter() - began)


class Baseline(ABC):
    """A published method with a default and a grid.

    The grid is made of `values` of one setting, the `knob`, from low to high, and of readings for each:
    results at several numbers of iterations, which one run yields one after the other.
    """

    name: str
    defaults: Settings
    knob: str
    values: tuple
    fewer_values: tuple
    """Those on large models."""
    is_quick = False
    """True if every value is tried on any model."""
    patience: int = 2

    def is_available(self) -> bool:
        """Tell whether the method can run here."""
        return True

    def serves(self, is_quad: bool) -> bool:
        """Tell whether the method is for models of quads, or of triangles."""
        return True

    def values_on(self, case: Case) -> tuple:
        """Return the values of the knob for a case."""
        return self.fewer_values if case.model.clean.n_faces >= FEWER_VALUES else self.values

    def patience_on(self, case: Case) -> int:
        """Return the readings without improvement after which a run on a case is given up."""
        return self.patience

    @abstractmethod
    def readings(self, case: Case, knob: Any, only: Settings | None = None) -> Iterator[Reading]:
        """Yield results for a value of the knob; only those with some settings if these are given."""

    def run(self, case: Case, settings: Settings) -> Reading:
        """Denoise a case with some settings."""
        *_, last = self.readings(case, settings[self.knob], settings)
        return last


class BilateralNormals(Baseline):
    """Bilateral normal filtering, local scheme (Zheng et al. 2011)."""

    name = "LBNF"
    defaults = {
        "sigma_s": bilateral_normals.SIGMA_S,
        "normal_iterations": bilateral_normals.NORMAL_ITERATIONS,
        "vertex_iterations": bilateral_normals.VERTEX_ITERATIONS,
    }
    knob = "sigma_s"
    values = (0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.7, 0.8)
    fewer_values = (0.25, 0.35, 0.5, 0.7)
    normal_iterations = (1, 2, 5, 10, 14, 20, 28, 40, 80)
    vertex_iterations = (5, 10, 20, 40)
    fewer_vertex_iterations = (10, 20)

    def values_on(self, case: Case) -> tuple:
        """Return the values of the knob for a case."""
        return self.fewer_values if case.model.clean.n_faces >= FEWER_VALUES else self.values

    def patience_on(self, case):
        """Allow two numbers of normal iterations without improvement."""
        return 2 * len(self._inner(case))

    def _inner(self, case):
        is_large = case.model.clean.n_faces >= FEWER_READINGS
        return self.fewer_vertex_iterations if is_large else self.vertex_iterations

    def readings(self, case, knob, only=None):
        """Yield results at all pairs of numbers of iterations."""
        outer = (only["normal_iterations"],) if only else self.normal_iterations
        inner = (only["vertex_iterations"],) if only else self._inner(case)
        graph = case.model.graph
        seconds, began = 0.0, perf_counter()
        for n, normals in zip(
            outer, bilateral_normals.filtered_normals(case.rows, graph, knob, outer), strict=True
        ):
            seconds += perf_counter() - began
            points, done, vertex_seconds = case.rows, 0, 0.0
            for v in inner:
                began = perf_counter()
                points, done = update_vertices(points, normals, graph, v - done), v
                vertex_seconds += perf_counter() - began
                settings = {"sigma_s": knob, "normal_iterations": n, "vertex_iterations": v}
                yield Reading(settings, case.positions(points), seconds + vertex_seconds)
            began = perf_counter()


class GuidedNormals(Baseline):
    """Guided normal filtering (Zhang et al. 2015)."""

    name = "GNF"
    defaults = {
        "sigma_r": guided_normals.SIGMA_R,
        "normal_iterations": guided_normals.NORMAL_ITERATIONS,
    }
    knob = "sigma_r"
    values = (0.1, 0.15, 0.2, 0.25, 0.35, 0.5, 0.7, 1.0)
    fewer_values = (0.25, 0.5, 1.0)
    normal_iterations = (1, 2, 3, 5, 7, 10, 15, 20, 30, 40, 60)
    fewer_normal_iterations = (1, 2, 3, 5, 7, 10, 20, 40)
    patience = 2

    def readings(self, case, knob, only=None):
        """Yield results at all numbers of iterations."""
        is_large = case.model.clean.n_faces >= FEWER_READINGS
        outer = self.fewer_normal_iterations if is_large else self.normal_iterations
        outer = (only["normal_iterations"],) if only else outer
        seconds, began = 0.0, perf_counter()
        for n, points in zip(
            outer, guided_normals.filtered_positions(case.rows, case.model.graph, knob, outer), strict=True
        ):
            seconds += perf_counter() - began
            yield Reading({"sigma_r": knob, "normal_iterations": n}, case.positions(points), seconds)
            began = perf_counter()


class BilateralPositions(Baseline):
    """Bilateral mesh filtering (Fleishman et al. 2003), Framelet's preset BILATERAL."""

    name = "BILATERAL"
    defaults = {"sigma_s": 0.0, "iterations": PRESETS["BILATERAL"].settings.iterations}
    knob = "sigma_s"
    values = (0.05, 0.1, 0.15, 0.25, 0.4)
    fewer_values = (0.15, 0.4)
    iterations = (2, 5, 10)
    patience = 2

    def readings(self, case, knob, only=None):
        """Yield results at all numbers of iterations, each from a run of its own."""
        connectivity = case.model.connectivity
        for iterations in (only["iterations"],) if only else self.iterations:
            changes = {"sigma_s": knob, "iterations": iterations}
            settings = PRESETS["BILATERAL"].settings.with_changes(**changes, threads=1)
            began = perf_counter()
            positions = denoise(case.noisy, settings, connectivity=connectivity).vertices
            yield Reading(changes, positions, perf_counter() - began)


class Taubin(Baseline):
    """Taubin's smoothing (1995) as the library trimesh has it."""

    name = "TAUBIN"
    defaults = {"factors": "0.5/0.5", "iterations": 10}
    knob = "factors"
    values = fewer_values = ("0.2/0.2", "0.33/0.34", "0.5/0.5", "0.5/0.53", "0.8/0.8")
    iterations = (2, 4, 6, 10, 16, 24, 40, 64, 100, 160, 250, 400)
    patience = 3
    is_quick = True

    def is_available(self):
        """Tell whether the library is installed."""
        return taubin.is_installed()

    def readings(self, case, knob, only=None):
        """Yield results at all numbers of iterations."""
        shrink, grow = map(float, knob.split("/"))
        outer = (only["iterations"],) if only else self.iterations
        points, done, seconds = case.noisy.vertices.astype(np.float64), 0, 0.0
        smoother = taubin.Smoother(case.noisy)
        for n in outer:
            began = perf_counter()
            # All numbers are even, so that each run goes on with a shrinking step.
            points, done = smoother.run(points, shrink, grow, n - done), n
            seconds += perf_counter() - began
            yield Reading({"factors": knob, "iterations": n}, points, seconds)


BASELINES = {
    method.name: method for method in (BilateralNormals(), GuidedNormals(), BilateralPositions(), Taubin())
}
FRAMELET = {key: Preset(key) for key in PRESETS if key not in BASELINES}
METHODS = {**FRAMELET, **BASELINES}
"""All methods by name."""
