# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is clean and stays bit for bit: planes and smooth places, but nothing that is noisy."""

import numpy as np
import pytest
import region_cases
from checks import random_rotation
from framelet.core import SurfaceMesh, connect, denoise
from framelet.core.learned import clean_parts
from framelet.core.learned.engine import FaceEngine
from framelet.core.learned.scales import find_scales
from kinds import ALONE
from learned_twins import slow_flat_vertices, slow_hardly_moved, slow_scales
from meshes import (
    MESHES,
    faces_of,
    flipped,
    noisy,
    prism,
    quad_grid,
    triangle_grid,
    triangle_torus,
    union,
)


def still_of(mesh):
    """Return which vertices of a mesh keep all bits."""
    return (denoise(mesh).vertices == mesh.vertices).all(axis=1)


def described(mesh):
    engine = FaceEngine(mesh, connect(mesh), ALONE)
    points = np.ascontiguousarray(mesh.vertices.T, np.float32)
    return engine, points, find_scales(points, engine.graph, engine.rings)


def bumpy_in_places(mesh, share, rng):
    """Return a flat mesh with some of its vertices lifted, also two alike; on binary fractions."""
    points = np.round(mesh.vertices * 64) / 64
    is_lifted = rng.random(mesh.n_vertices) < share
    points[:, 2] += np.where(is_lifted, rng.integers(1, 40, mesh.n_vertices) / 64, 0)
    return mesh.with_vertices(points)


SHEETS = {
    "two sheets": lambda: union(triangle_grid(), quad_grid()),
    "sheet of 512": lambda: triangle_grid(17, 17),
    "sheet of 1800": lambda: triangle_grid(31, 31),
    "quads and triangles": lambda: union(quad_grid(11, 13), triangle_grid(13, 11)),
}


@pytest.mark.parametrize("share", [0.0, 0.05, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("name", ["triangle grid", "quad grid", "mixed sheet", *SHEETS])
def test_flat_vertices(name, share, rng):
    """Against a flood fill from face to face: few that are coplanar by chance, some, and many."""
    mesh = bumpy_in_places((MESHES | SHEETS)[name](), share, rng)
    engine, points, scales = described(mesh)
    means = engine.rings.outward(engine.rings.mean(engine.rings.inward(np.eye(mesh.n_vertices))))
    found = clean_parts.flat_vertices(points, scales, engine.graph)
    assert found.tolist() == slow_flat_vertices(mesh, slow_scales(mesh, means)).tolist()
    assert share > 0 or found.mean() > 0.7


def flat_with(clean, *parts):
    """Return the flat vertices of a grid where all but those in some parts are lifted at random."""
    points = clean.vertices.copy()
    points[:, 2] = np.random.default_rng(7).integers(1, 4000, clean.n_vertices) / 1024
    for part in parts:
        points[part, 2] = 0
    engine, points, scales = described(clean.with_vertices(points))
    return set(np.flatnonzero(clean_parts.flat_vertices(points, scales, engine.graph)).tolist())


def strip(columns, row, n_triangles):
    """Return the vertices of the first triangles below a row of a grid, which lie side by side."""
    k = np.arange(n_triangles + 2)
    return ((row + (k + 1) % 2) * columns + k // 2 + 1).tolist()


@pytest.mark.parametrize(("rows", "columns", "needed"), [(6, 11, 2), (16, 16, 9), (28, 28, 30), (41, 41, 30)])
def test_thirty_triangles_in_one_plane_are_flat_or_two_percent_of_all(rows, columns, needed):
    """And at least two. Fewer are a coincidence, and parts that do not touch are not counted together."""
    clean = triangle_grid(rows, columns)
    few, others, enough = (
        strip(columns, 1, needed - 1),
        strip(columns, 4, needed - 1),
        strip(columns, 1, needed),
    )
    assert flat_with(clean, few, others) == set()
    assert flat_with(clean, enough, others) == set(enough)


def test_two_triangles_are_flat_where_more_than_half_of_all_are():
    clean, pair, one = triangle_grid(16, 16), strip(16, 11, 2), strip(16, 13, 1)
    half, more = (np.arange(16 * rows).tolist() for rows in (8, 9))  # 210 and 240 of 450 triangles
    assert flat_with(clean, half, pair, one) == set(half)
    assert flat_with(clean, more, pair, one) == set(more) | set(pair)


def test_polygons_count_as_their_triangles():
    """Bent ones count once: a single flat quad suffices among 30, and of some 225 it takes three."""
    for rows, columns, needed in ((6, 7, 1), (16, 16, 3)):
        clean = quad_grid(rows, columns)
        few, enough = (strip(columns, 1, 2 * n) if n else [] for n in (needed - 1, needed))
        assert flat_with(clean, few) == set()
        assert flat_with(clean, enough) == set(enough)


def test_a_spike_beside_a_face_without_area_is_not_flat():
    """On a flat sheet where a vertex lies on the edge of another face, and a face without area between."""
    sheet, spike = triangle_grid(16, 16), 120
    faces = [list(face) for face in faces_of(sheet)]
    first = next(face for face in faces if spike in face)
    turned = np.roll(first, -first.index(spike)).tolist()
    a, b = turned[1:]
    across = next(f for f, face in enumerate(faces) if {a, b} < set(face) and spike not in face)
    (c,) = set(faces[across]) - {a, b}
    middle = sheet.n_vertices
    faces[across] = [middle, a, c]
    faces += [[b, middle, c], [b, a, middle]]
    points = np.concatenate((sheet.vertices, sheet.vertices[[a, b]].mean(axis=0)[None]))
    points[spike, 2] += 1
    mesh = SurfaceMesh.from_faces(points, faces)
    assert connect(mesh).is_non_manifold.sum() == 0
    engine, points, scales = described(mesh)
    is_flat = clean_parts.flat_vertices(points, scales, engine.graph)
    assert not is_flat[spike] and is_flat.sum() > 250
    assert not still_of(mesh)[spike]


@pytest.mark.parametrize("strength", [0.003, 0.012, 0.02, 0.05, 0.2])
@pytest.mark.parametrize("share", [0.0, 0.15, 0.6, 1.0])
@pytest.mark.usefixtures("exact")
def test_what_a_pass_hardly_moved(share, strength, rng):
    """Against a loop: what is calm in clean places; without noise all but what sticks out."""
    mesh = triangle_torus(14, 20)
    engine = described(mesh)[0]
    is_clean = mesh.vertices[:, 0] < np.quantile(mesh.vertices[:, 0], share)
    is_free = rng.random(mesh.n_vertices) < 0.9
    offsets = strength * rng.normal(size=mesh.n_vertices) * rng.choice([0.2, 1], mesh.n_vertices)
    offsets[rng.permutation(mesh.n_vertices)[:3]] = 0.5
    offsets = offsets.astype(np.float32)
    means = engine.rings.outward(engine.rings.mean(engine.rings.inward(np.eye(mesh.n_vertices))))
    found = clean_parts.hardly_moved(offsets, is_clean, is_free, engine.rings)
    assert found.tolist() == slow_hardly_moved(offsets.astype(float), is_clean, is_free, means).tolist()
    assert not found[offsets == 0.5].any()
    assert share == 0 or strength > 0.02 or found[is_clean].mean() > 0.5
    assert strength < 0.2 or not found.any()


def test_nothing_that_was_still_moves_where_nothing_is_free():
    engine = described(triangle_torus())[0]
    nothing = np.zeros(192, np.float32)
    for is_clean in (np.zeros(192, bool), np.ones(192, bool)):
        found = clean_parts.hardly_moved(nothing, is_clean, ~is_clean & is_clean, engine.rings)
        assert found.tolist() == is_clean.tolist()


@pytest.mark.parametrize("sigma", [0.0, 0.02, 0.1])
def test_places_are_clean_where_polynomials_fit(sigma, rng):
    """Everywhere, on one half, and nowhere; the same whether all two-rings are looked at or some."""
    clean = triangle_torus(60, 120)
    is_noisy = clean.vertices[:, 0] > 0
    for part in (is_noisy, np.ones_like(is_noisy)):
        mesh = clean.with_vertices(np.where(part[:, None], noisy(clean, rng, sigma).vertices, clean.vertices))
        engine, points, scales = described(mesh)
        found = clean_parts.clean_places(points, mesh, connect(mesh), scales.unit, engine.rings, ALONE)
        far = np.abs(clean.vertices[:, 0]) > 0.8
        assert found.all() if sigma == 0 else not found[part & far].any() and found[~part & far].all()


def half_rough(build=triangle_grid):
    """Return a sheet that is flat for x up to 4 and rough above."""
    mesh = build(17, 17)
    points = mesh.vertices.copy()
    heights = 0.2 * np.random.default_rng(5).normal(size=len(points))
    points[:, 2] = np.where(points[:, 0] > 4, heights, 0)
    return mesh.with_vertices(points)


def box(size=8):
    """Return a closed cube whose flat sides are cut into triangles."""
    return region_cases.box(size)[0]


FLAT = {
    "half a sheet": half_rough,
    "half an irregular sheet": lambda: half_rough(lambda *sizes: flipped(triangle_grid(*sizes), seed=1)),
    "quads": lambda: half_rough(quad_grid),
    "sheets beside others": lambda: union(half_rough(), noisy(triangle_torus(), np.random.default_rng(0))),
}


@pytest.mark.parametrize("name", FLAT)
def test_flat_parts_are_still_beside_noise(name, rng):
    """However they lie; vertices whose faces are all bent are still by chance only."""
    mesh = FLAT[name]()
    is_flat = (mesh.vertices[:, 0] < 3.5) & (np.abs(mesh.vertices[:, 2]) == 0)
    is_bent = (mesh.vertices[:, 0] > 5.5) & (mesh.vertices[:, 0] < 19)
    mesh = mesh.with_vertices(mesh.vertices @ random_rotation(rng))
    still = still_of(mesh)
    assert is_flat.sum() > 20 and still[is_flat].all()
    assert is_bent.sum() > 100 and still[is_bent].mean() < 0.06


@pytest.mark.parametrize(
    "build", [box, lambda: prism(24), triangle_grid, quad_grid], ids=["cube", "prism", "triangles", "quads"]
)
def test_cubes_prisms_and_sheets_are_still_as_a_whole(build, rng):
    mesh = build()
    assert still_of(mesh.with_vertices(mesh.vertices @ random_rotation(rng) * 3.0)).all()


def test_clean_surfaces_are_still_and_noisy_ones_are_not(rng):
    clean = triangle_torus(40, 60)
    assert still_of(clean).all()
    for sigma in (0.02, 0.1, 0.5):
        assert not still_of(noisy(clean, rng, sigma)).any()


def test_a_spike_on_a_clean_surface_is_not_still():
    clean = triangle_torus(40, 60)
    points = clean.vertices.copy()
    points[1234] *= 1.3
    still = still_of(clean.with_vertices(points))
    assert not still[1234] and still.mean() > 0.95


def test_the_clean_half_of_a_surface_is_still(rng):
    clean = triangle_torus(60, 120)
    is_noisy = clean.vertices[:, 0] > 0
    mesh = clean.with_vertices(np.where(is_noisy[:, None], noisy(clean, rng, 0.2).vertices, clean.vertices))
    still, far = still_of(mesh), np.abs(clean.vertices[:, 0]) > 0.6
    assert still[~is_noisy & far].mean() > 0.95
    assert still[is_noisy & far].mean() < 0.05
