# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is denoised: a clean mesh, a noisy one, and what is known of both."""

import os
from functools import cache
from pathlib import Path
from typing import NamedTuple

import checkout
import numpy as np
from framelet.core import Connectivity, SurfaceMesh, add_noise, compare, connect
from framelet.core.mesh.geometry import face_normals
from framelet.core.metrics import normal_angles
from made import MADE
from mesh_files import read_mesh

SIGMA = 0.2
"""Noise in mean edge lengths, as in the paper's experiments."""

SEED = 0
CREASE = 30.0
"""Angle in degrees between the normals of two faces from which their common edge is a crease."""

FEWEST_CREASE_FACES = 20
LARGEST = 50_000
"""Meshes with more vertices are left out unless they are named, for time."""

PARTNERS = {"tri/fandisk_noisy03": "tri/fandisk", "tri/fandisk_noisy07": "tri/fandisk"}
"""Noisy meshes that came with their own clean partner."""

LEFT_OUT = ("tri/bunny_scan35k",)
"""Left out unless named: the same bunny as tri/bunny_closed35k."""

QUICK = ("made/box_tri", "made/bumpy_sphere_quad")


class Case(NamedTuple):
    """A noisy mesh with its clean partner."""

    name: str
    clean: SurfaceMesh
    noisy: SurfaceMesh
    connectivity: Connectivity
    near_crease: np.ndarray
    """Faces, shape (F,), bool, with an edge that is a crease of the clean mesh."""

    @property
    def is_quad(self) -> bool:
        """True for a mesh of quads."""
        return self.connectivity.has_quads


class Measurement(NamedTuple):
    """Distance of a result from the clean mesh."""

    angle: float
    """Mean angle between face normals in degrees."""
    crease_angle: float
    """The same over faces at creases; NaN if there are few."""
    rms: float
    """Distance of vertices, rms, in clean mean edge lengths."""
    flips: int


def mesh_folder() -> Path | None:
    """Return the folder of the development meshes; None without one."""
    folder = Path(os.environ.get("FRAMELET_MESHES") or checkout.ROOT.parent / "shared" / "meshes")
    return folder if folder.is_dir() else None


def case_names(wanted: list[str], is_quick: bool) -> list[str]:
    """Return the names of the cases that run, those with most vertices first.

    Raises
    ------
    ValueError
        If a wanted name is not known.
    """
    folder = mesh_folder()
    known = [*MADE]
    if folder is not None:
        known += [
            f"{path.parent.name}/{path.stem}"
            for kind in ("tri", "quad")
            for path in folder.glob(f"{kind}/*.ply")
        ]
    for name in wanted:
        if name not in known:
            raise ValueError(f"There is no mesh {name!r}; choose from {', '.join(sorted(known))}.")
    if not wanted:
        if is_quick:
            wanted = list(QUICK)
        elif folder is None:
            wanted = list(MADE)
        else:
            wanted = [name for name in known if name not in (*MADE, *LEFT_OUT)]
            wanted = [name for name in wanted if clean_mesh(name).n_vertices <= LARGEST]
    return sorted(wanted, key=lambda name: (-clean_mesh(name).n_vertices, name))


@cache
def clean_mesh(name: str) -> SurfaceMesh:
    """Return the clean mesh of a case, with float32 positions."""
    if name in MADE:
        mesh = MADE[name]()
        return mesh.with_vertices(mesh.vertices.astype(np.float32))
    return read_mesh(mesh_folder() / f"{PARTNERS.get(name, name)}.ply")


@cache
def load(name: str) -> Case:
    """Return a case; each process makes it once."""
    clean = clean_mesh(name)
    if name in PARTNERS:
        noisy = clean.with_vertices(read_mesh(mesh_folder() / f"{name}.ply").vertices)
    else:
        noisy = clean.with_vertices(add_noise(clean, SIGMA, SEED))
    return Case(name, clean, noisy, connect(clean), _near_crease(clean))


def measure(case: Case, vertices: np.ndarray) -> Measurement:
    """Compare positions, shape (N, 3), with the clean mesh of a case."""
    result = case.clean.with_vertices(vertices)
    found = compare(result, case.clean)
    crease_angle = np.nan
    if case.near_crease.sum() >= FEWEST_CREASE_FACES:
        angles = normal_angles(face_normals(result), face_normals(case.clean))[case.near_crease]
        crease_angle = float(np.nanmean(angles))
    return Measurement(
        found.mean_angle, crease_angle, found.rms_distance / found.mean_edge_length, found.flipped_faces
    )


def _near_crease(mesh: SurfaceMesh) -> np.ndarray:
    """Return the faces with an edge at which the surface bends by `CREASE` or more."""
    face = np.repeat(np.arange(mesh.n_faces), mesh.face_sizes())
    order = np.argsort(mesh.corner_edge, kind="stable")
    counts = np.bincount(mesh.corner_edge, minlength=mesh.n_edges)
    first = (np.cumsum(counts) - counts)[counts == 2]
    pairs = face[order[np.stack((first, first + 1))]]
    normals = face_normals(mesh)
    bends = normal_angles(normals[pairs[0]], normals[pairs[1]]) >= CREASE
    near = np.zeros(mesh.n_faces, bool)
    near[pairs[:, bends]] = True
    return near
