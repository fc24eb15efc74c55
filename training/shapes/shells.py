# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin shells and open surfaces: leaves, bowls, masks, torn cloth."""

from __future__ import annotations

import itertools

import numpy as np
from manifold3d import CrossSection, JoinType, Manifold, OpType

from .mesh import (
    Mesh,
    flipped,
    from_faces,
    half_edges,
    joined,
    largest_island,
    mean_edge,
    select_faces,
    vertex_normals,
)
from .noise import Noise, chance, log_uniform, octaves, random_rotation
from .organic import bend, smooth_body
from .parts import outline, to_mesh
from .relief import with_relief
from .resampling import decimated, edge_for, isotropic


def border_edges(mesh: Mesh):
    """Return start and end of the half edges without an opposite one."""
    start, end, _ = half_edges(mesh)
    n = len(mesh.vertices)
    lonely = ~np.isin(end.astype(np.int64) * n + start, start.astype(np.int64) * n + end)
    return start[lonely], end[lonely]


def without_pinches(mesh: Mesh) -> Mesh:
    """Remove the faces at border vertices where two borders touch, until there are none."""
    for _ in range(20):
        start, _ = border_edges(mesh)
        bad = np.bincount(start, minlength=len(mesh.vertices)) > 1
        if not bad.any():
            break
        face = np.repeat(np.arange(mesh.n_faces), np.diff(mesh.face_offset))
        keep = np.bincount(face, bad[mesh.corner_vertex], mesh.n_faces) == 0
        mesh = largest_island(select_faces(mesh, keep))
    return mesh


def thickened(mesh: Mesh, thickness) -> Mesh:
    """Give an open surface of triangles a thickness, and close its rim."""
    n = len(mesh.vertices)
    inner = mesh.moved(mesh.vertices - np.broadcast_to(thickness, n)[:, None] * vertex_normals(mesh))
    start, end = border_edges(mesh)
    rim = np.concatenate([np.stack([end, start, start + n], 1), np.stack([end, start + n, end + n], 1)])
    both = joined([mesh, flipped(inner)])
    return from_faces(both.vertices, np.concatenate([both.corner_vertex.reshape(-1, 3), rim]))


def _leaf(rng, target: int) -> Mesh:
    """Bend and roll a thin extruded outline, with veins or other relief."""
    if chance(rng, 0.5):
        t = np.linspace(0, np.pi, 80)
        half = rng.uniform(0.25, 0.6) * np.sin(t) ** rng.uniform(0.6, 1.5)
        half = half * (1 + rng.uniform(0, 0.12) * np.cos(t * rng.integers(8, 30)))
        x = -np.cos(t)
        rim = np.concatenate([np.stack([x, -half], 1), np.stack([x, half], 1)[::-1][1:-1]])
        figure = CrossSection([rim])
    else:
        figure = outline(rng)
        for _ in range(rng.integers(0, 5)):
            hole = CrossSection.circle(log_uniform(rng, 0.05, 0.25), 48)
            figure = figure - hole.translate(list(rng.uniform(-0.6, 0.6, 2)))
    edge = edge_for(2 * figure.area(), target)
    thick = edge * log_uniform(rng, 1, 4)
    mesh = isotropic(to_mesh(Manifold.extrude(figure, thick)), target, 30)
    if chance(rng, 0.6):
        x, y, _ = mesh.vertices.T
        veins = np.exp(-((y / (1.5 * edge)) ** 2))
        phase = (x + np.abs(y) * rng.uniform(0.5, 1.5)) * rng.uniform(4, 12)
        veins = np.maximum(veins, np.exp(-((np.sin(phase) / 0.25) ** 2)) * rng.uniform(0.3, 1))
        mesh = mesh.moved(mesh.vertices + [0, 0, 1] * (veins * thick * rng.uniform(0.2, 0.8))[:, None])
    return _rolled(rng, mesh)


def _rolled(rng, mesh: Mesh) -> Mesh:
    mesh = bend(rng, mesh, rng.uniform(0.02, 0.15))
    if chance(rng, 0.7):
        turn = rng.uniform(0.3, 2.8)
        angle = mesh.vertices[:, 0] * turn
        far = 1 / turn - mesh.vertices[:, 2]
        mesh = mesh.moved(
            np.stack([far * np.sin(angle), mesh.vertices[:, 1], 1 / turn - far * np.cos(angle)], 1)
        )
    return mesh


def _bowl(rng, target: int) -> Mesh:
    """Turn a thin profile."""
    t = np.linspace(0, 1, 60)
    power = rng.uniform(1.2, 4)
    line = np.stack([0.01 + t, rng.uniform(0.3, 1.4) * t**power + 0.08 * np.sin(t * rng.uniform(2, 14))], 1)
    surface = 2 * 2 * np.pi * 0.5 * 1.5
    edge = edge_for(surface, target)
    thick = edge * log_uniform(rng, 1, 4)
    dots = [CrossSection.circle(thick / 2, 16).translate(list(point)) for point in line]
    figure = CrossSection.batch_boolean(
        [CrossSection.batch_hull([a, b]) for a, b in itertools.pairwise(dots)], OpType.Add
    )
    if chance(rng, 0.4):
        figure = figure.offset(-thick * 0.1, JoinType.Miter)
    degrees = 360 if chance(rng, 0.7) else rng.uniform(120, 330)
    solid = Manifold.revolve(figure, int(rng.integers(64, 200)), degrees)
    for _ in range(rng.integers(0, 4)):
        solid = solid - Manifold.cylinder(4, log_uniform(rng, 0.05, 0.25), -1, 64, True).rotate(
            list(rng.uniform(0, 360, 3))
        ).translate(list(rng.uniform(-0.6, 0.6, 3)))
    mesh = isotropic(to_mesh(solid), target, 35)
    return bend(rng, mesh, 0.05) if chance(rng, 0.4) else mesh


def _mask(rng, target: int) -> Mesh:
    """Cut a body open, tear holes, fray the border, and perhaps give it a thickness."""
    is_thick = chance(rng, 0.45)
    fine = int(target * (1.0 if is_thick else 1.6))
    mesh, _ = smooth_body(rng, fine, 56)
    size = np.ptp(mesh.vertices, axis=0).max()
    edge = mean_edge(mesh)
    middle = mesh.vertices[mesh.corner_vertex.reshape(-1, 3)].mean(1)
    cut = middle @ random_rotation(rng)[0]
    cut = (cut - np.median(cut)) / size + 0.03 * rng.uniform(0, 2) * octaves(rng, middle / size, 0.4, 3)
    keep = cut > rng.uniform(-0.2, 0.05)
    if chance(rng, 0.5):
        keep &= Noise(rng)(middle * (rng.uniform(3, 10) / size)) < rng.uniform(0.25, 0.7)
    mesh = without_pinches(largest_island(select_faces(mesh, keep)))
    if chance(rng, 0.5):
        mesh = without_pinches(isotropic(mesh, int(mesh.n_faces * 0.9), 180, 4))
    elif chance(rng, 0.5):
        # Frayed: single faces bitten off the border.
        for _ in range(rng.integers(1, 4)):
            start, _ = border_edges(mesh)
            rim = np.zeros(len(mesh.vertices), bool)
            rim[start] = True
            touching = rim[mesh.corner_vertex.reshape(-1, 3)].any(1)
            mesh = without_pinches(
                largest_island(select_faces(mesh, ~touching | (rng.random(len(touching)) < 0.75)))
            )
    if is_thick:
        mesh = thickened(mesh, edge * log_uniform(rng, 1, 4))
    if chance(rng, 0.75):
        mesh = with_relief(rng, mesh, int(rng.integers(1, 4)), 4.0)
    return mesh


def _cloth(rng, target: int) -> Mesh:
    """Fold a flat cutout without thickness."""
    figure = outline(rng)
    thin = Manifold.extrude(figure, 0.1)
    mesh = isotropic(to_mesh(thin), int(2.8 * target), 30)
    top = np.isclose(mesh.vertices[:, 2], mesh.vertices[:, 2].max(), atol=1e-6)
    mesh = largest_island(select_faces(mesh, top[mesh.corner_vertex.reshape(-1, 3)].all(1)))
    mesh = with_relief(rng, mesh, int(rng.integers(1, 5)), 5.0)
    mesh = _rolled(rng, mesh)
    return decimated(mesh, int(mesh.n_faces * 0.6), 0.3) if chance(rng, 0.3) else mesh


def make_shell(rng, target: int) -> Mesh:
    """Make one of the shapes of this file."""
    return [_leaf, _bowl, _mask, _cloth][rng.choice(4, p=[0.25, 0.2, 0.38, 0.17])](rng, target)
