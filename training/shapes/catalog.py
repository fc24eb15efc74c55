# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which families there are, how often each is drawn, and how a drawn mesh is finished."""

from __future__ import annotations

import numpy as np

from .islands import make_islands
from .marching import make_marching
from .mesh import Mesh, bends, condition, flipped, select_faces, volume
from .noise import chance, log_uniform, random_rotation
from .organic import make_cutout, make_organic
from .parts import make_part
from .plates import make_plate
from .quads import make_coarse_quads, make_quads
from .scanned import make_scanned
from .shells import make_shell
from .sweeps import make_ball, make_sweep, make_thin_tube
from .terrain import make_terrain
from .uneven import make_uneven

FAMILIES = {
    "part": (make_part, 2.0),
    "organic": (make_organic, 2.5),
    "plate": (make_plate, 1.0),
    "sweep": (make_sweep, 1.0),
    "quads": (make_quads, 2.2),
    "terrain": (make_terrain, 1.0),
    "shell": (make_shell, 1.0),
    "uneven": (make_uneven, 1.0),
    "islands": (make_islands, 1.0),
    "marching": (make_marching, 1.0),
}
"""Name of a family: its function and its weight."""

FIRST_COARSE = 600
"""Number of the first coarse mesh: there the surface bends a lot from face to face."""

COARSE_FAMILIES = {
    "part": (make_part, 2.0),
    "quads": (make_coarse_quads, 4.0),
    "organic": (make_organic, 1.5),
    "sweep": (make_sweep, 1.0),
    "terrain": (make_terrain, 0.7),
    "shell": (make_shell, 0.7),
    "plate": (make_plate, 0.6),
    "marching": (make_marching, 0.5),
}

FIRST_SCANNED = 1050
"""Number of the first range image: there surfaces are smooth and sampled as a sensor or a program does it."""

SCANNED_FAMILIES = {"scanned": (make_scanned, 3.0), "ball": (make_ball, 1.0)}

FIRST_TINY = 1250
"""Number of the first mesh of a few hundred faces: thin tubes, blocky bodies."""

TINY_FAMILIES = {
    "quads": (make_coarse_quads, 3.0),
    "tube": (make_thin_tube, 3.0),
    "organic": (make_organic, 2.0),
}

FIRST_CUTOUT = 1350
"""Number of the first piece of a body of up to 100,000 faces."""

CUTOUT_FAMILIES = {"organic": (make_cutout, 1.0)}

N_TRIES = 6
LEAST_FACES, LEAST_COARSE = 3000, 350
MOST_FACES = 26000


def family_of(index: int) -> str:
    """Return the family of a mesh, interleaved so that any run of meshes is a fair mixture."""
    families = _families(index)
    names = list(families)
    weights = np.array([weight for _, weight in families.values()])
    weights = weights / weights.sum()
    # The golden ratio visits the unit interval evenly.
    place = (index * 0.6180339887498949 + 0.5) % 1
    return names[min(int(np.searchsorted(np.cumsum(weights), place)), len(names) - 1)]


def is_coarse(index: int) -> bool:
    """Return whether a mesh is one of those whose surface bends a lot from face to face."""
    return FIRST_COARSE <= index < FIRST_SCANNED or FIRST_TINY <= index < FIRST_CUTOUT


def _families(index: int) -> dict:
    if index >= FIRST_CUTOUT:
        return CUTOUT_FAMILIES
    if index >= FIRST_TINY:
        return TINY_FAMILIES
    if index >= FIRST_SCANNED:
        return SCANNED_FAMILIES
    return COARSE_FAMILIES if is_coarse(index) else FAMILIES


def _target(rng, index: int) -> int:
    if index >= FIRST_CUTOUT:
        return int(log_uniform(rng, 7000, 16000))
    if is_coarse(index):
        return int(log_uniform(rng, 500, 4500 if index < FIRST_TINY else 1500))
    return int(log_uniform(rng, 6000, 14000) if chance(rng, 0.8) else log_uniform(rng, 4200, 22000))


def _without_loose_vertices(mesh: Mesh) -> Mesh:
    used = np.unique(mesh.corner_vertex)
    if len(used) < len(mesh.vertices):
        mesh = select_faces(mesh, np.ones(mesh.n_faces, bool))
    return mesh


def problem(mesh: Mesh, least: int = LEAST_FACES) -> str:
    """Say why a mesh is no good, or nothing."""
    if not np.isfinite(mesh.vertices).all():
        return "not finite"
    if not least <= mesh.n_faces <= MOST_FACES:
        return f"{mesh.n_faces} faces"
    state = condition(mesh)
    if state.non_manifold:
        return f"{state.non_manifold} non-manifold edges"
    if state.pinched > 8:
        return f"{state.pinched} pinched vertices"
    if state.degenerate > 0.002 * mesh.n_faces:
        return f"{state.degenerate} degenerate faces"
    bend = bends(mesh)
    if (bend > 150).mean() > 0.004 or (bend > 172).mean() > 0.001:
        return f"{(bend > 150).sum() // 2} folded edges"
    return ""


def make(seed: int, index: int) -> tuple[Mesh, str]:
    """Make one mesh; it depends on the two numbers only.

    Parameters
    ----------
    seed, index : int

    Returns
    -------
    Mesh
    str
        The family.
    """
    kind = family_of(index)
    reason = ""
    for attempt in range(N_TRIES):
        rng = np.random.default_rng([seed, index, attempt])
        try:
            mesh = _without_loose_vertices(_families(index)[kind][0](rng, _target(rng, index)))
            mesh = _finished(rng, mesh)
            reason = problem(mesh, LEAST_COARSE if is_coarse(index) else LEAST_FACES)
        except Exception as error:  # a tool that gives up on one shape must not stop the others
            reason = f"{type(error).__name__}: {error}"
        if not reason:
            return mesh, kind
    raise ValueError(f"{kind}: {reason}")


def _finished(rng, mesh: Mesh) -> Mesh:
    """Stretch, turn and scale a mesh, with its faces outward."""
    low, high = mesh.vertices.min(0), mesh.vertices.max(0)
    change = np.eye(3)
    if chance(rng, 0.5):
        axes = random_rotation(rng)
        change = axes @ np.diag(np.exp(rng.uniform(-0.3, 0.3, 3))) @ axes.T
    change = change @ random_rotation(rng).T
    points = (mesh.vertices - (high + low) / 2) @ change
    scale = log_uniform(rng, 0.01, 1000) / np.ptp(points, axis=0).max()
    if mesh.noisy is not None:
        mesh = mesh._replace(noisy=(mesh.noisy - (high + low) / 2) @ change * scale)
    if mesh.grid is not None:
        counting = mesh.grid[:2] @ np.linalg.inv(change).T / scale
        sight = mesh.grid[2] @ change
        mesh = mesh._replace(grid=np.vstack([counting, sight / np.linalg.norm(sight)]))
    mesh = mesh.moved(points * scale)
    if condition(mesh).border == 0 and volume(mesh) < 0:
        mesh = flipped(mesh)
    return mesh
