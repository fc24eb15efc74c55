# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is denoised: a model, a noise and a seed."""

import os
from functools import cache, cached_property, lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import sources
from framelet.core import SurfaceMesh, compare, connect
from mesh_files import read_mesh
from noise import NOISES
from shapes import MADE, QUICK

DEVELOPMENT = (
    "tri/fandisk",
    "tri/elephant20k",
    "tri/camelhead_open11k",
    "tri/plate5k",
    "tri/cadarm2k",
    "tri/arm8k",
    "quad/spot2930",
    "quad/fandisk1742",
    "quad/botijo10k",
    "quad/bunny_hexsurf7706",
    "quad/gitter_open1341",
    "quad/armadillo_hexsurf9036",
)
"""Models that were looked at while learned shrinkage was built. None is in its training."""

SEEDS = (0, 1, 2)
TUNING_SEED = 0
"""The seed on which baselines are tuned, with the clean mesh in hand."""

LEFT_OUT = ("tri/bunny_scan35k", "tri/fandisk_noisy03", "tri/fandisk_noisy07")
"""The same bunny as tri/bunny_closed35k, and meshes that are noisy already."""

QUICK_NOISES = ("normal 0.2", "impulsive 0.5")


class CaseName(NamedTuple):
    """What tells one case from another."""

    model: str
    noise: str
    seed: int


class Measurement(NamedTuple):
    """Distance of a result from the clean model."""

    angle: float
    """Mean angle between face normals in degrees, all faces alike."""
    rms: float
    """Distance of vertices, rms, in clean mean edge lengths."""
    flips: int
    """Faces more than a right angle from their clean normals."""


class Model:
    """A clean mesh and what is known of its topology."""

    def __init__(self, name: str, clean: SurfaceMesh) -> None:
        self.name = name
        self.clean = clean

    @cached_property
    def connectivity(self):
        """Framelet's neighborhoods."""
        return connect(self.clean)

    @cached_property
    def graph(self):
        """The neighborhoods of the baselines."""
        from baselines.face_graph import FaceGraph

        return FaceGraph(self.clean)


class Case:
    """A noisy mesh with its clean partner."""

    def __init__(self, name: CaseName, model: Model) -> None:
        self.name = name
        self.model = model
        self.noisy = model.clean.with_vertices(NOISES[name.noise](model.clean, name.seed))
        points = self.noisy.vertices.astype(np.float64)
        self._center = points.mean(axis=0)
        self._edge = compare(self.noisy, model.clean).mean_edge_length
        self.rows = np.ascontiguousarray(((points - self._center) / self._edge).T, np.float32)
        """Noisy positions in rows, (3, N) float32, centered and in clean mean edge lengths: for baselines."""

    def positions(self, rows: np.ndarray) -> np.ndarray:
        """Return positions, shape (N, 3), from those in rows."""
        return rows.T.astype(np.float64) * self._edge + self._center

    def measure(self, positions: np.ndarray) -> Measurement:
        """Compare positions, shape (N, 3), with the clean model."""
        found = compare(self.model.clean.with_vertices(positions), self.model.clean)
        return Measurement(found.mean_angle, found.rms_distance / self._edge, found.flipped_faces)


def mesh_folder() -> Path | None:
    """Return the folder of the development meshes; None without one."""
    folder = Path(os.environ.get("FRAMELET_MESHES") or sources.ROOT.parent / "shared" / "meshes")
    return folder if folder.is_dir() else None


def model_names(wanted: list[str], is_quick: bool) -> list[str]:
    """Return the names of the models that run, development set and small ones first.

    Raises
    ------
    ValueError
        If a wanted name is not known.
    """
    folder = mesh_folder()
    known = []
    if folder is not None:
        paths = [path for kind in ("tri", "quad") for path in folder.glob(f"{kind}/*.ply")]
        known = [f"{path.parent.name}/{path.stem}" for path in paths]
        known = [name for name in known if name not in LEFT_OUT]
    for name in wanted:
        if name not in (*known, *MADE, *QUICK):
            raise ValueError(
                f"There is no model {name!r}; choose from {', '.join(sorted([*known, *MADE, *QUICK]))}."
            )
    names = wanted or (list(QUICK) if is_quick else known or list(MADE))
    return sorted(names, key=lambda name: (name not in DEVELOPMENT, load_clean(name).n_faces, name))


def load_clean(name: str) -> SurfaceMesh:
    """Return a clean mesh, with float32 positions."""
    made = {**MADE, **QUICK}
    if name in made:
        mesh = made[name]()
        return mesh.with_vertices(mesh.vertices.astype(np.float32))
    return read_mesh(mesh_folder() / f"{name}.ply")


@cache
def has_quads(name: str) -> bool:
    """Tell whether a model has quads."""
    return bool((load_clean(name).face_sizes() > 3).any())


@lru_cache(maxsize=1)
def load_model(name: str) -> Model:
    """Return a model; the last one is kept, since cases come model by model."""
    return Model(name, load_clean(name))


def load_case(name: CaseName) -> Case:
    """Return a case."""
    return Case(name, load_model(name.model))
