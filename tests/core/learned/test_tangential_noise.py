# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise along the surface goes where a mesh is regular and has it, and vertices slide nowhere else."""

from itertools import pairwise

import numpy as np
import pytest
from checks import AS_SOLVED, lengths
from framelet.core import DenoiseSettings, compare, connect, denoise, vertex_normals
from framelet.core.blocks import Blocks
from framelet.core.learned.engine import FaceEngine
from framelet.core.learned.symmetric import solved
from framelet.core.learned.tangential_noise import tangential_step
from framelet.core.mesh.surface_mesh import SurfaceMesh
from known_shapes import edge_of, lifted, sphere, white
from learned_twins import low_pass, polygons_of, ring_matrix, slow_offsets
from meshes import noisy, quad_torus, triangle_grid, triangle_torus, union
from twins import newell

AUTO = DenoiseSettings(method="AUTO", threads=1)


def slid(mesh, before, after):
    """Return the root mean square of steps along the surface, in mean edges."""
    step, normals = after - before, vertex_normals(mesh)
    step = step - normals * (step * normals).sum(axis=1, keepdims=True)
    return np.sqrt((step**2).sum(axis=1).mean()) / edge_of(mesh)


def slow_step(clean, mesh, after):
    """Return the step of a regular mesh with noise in all directions, by its definition, vertex by vertex."""
    change = (low_pass(ring_matrix(mesh), 3) - np.eye(mesh.n_vertices)) @ after
    faces = polygons_of(mesh)
    result = np.zeros_like(after)
    for v in range(mesh.n_vertices):
        normals = [newell(after[face]) for face in faces if v in face]
        normals = [normal / np.linalg.norm(normal) for normal in normals]
        spread = np.mean([np.outer(normal, normal) for normal in normals], axis=0) / 0.07
        result[v] = np.linalg.inv(np.eye(3) + spread @ spread) @ change[v]
    return result


def step_of(mesh, after, unit):
    engine = FaceEngine(mesh, connect(mesh), Blocks(1))
    points = [np.ascontiguousarray(x.T, np.float32) for x in (mesh.vertices, after)]
    return tangential_step(*points, np.float32(unit), engine)


@pytest.mark.parametrize("build", [triangle_torus, quad_torus])
def test_the_step_is_a_low_pass_along_the_surface(build, rng):
    clean = build(24, 36)
    mesh = noisy(clean, rng, 0.12)
    normals = vertex_normals(clean)
    noise = ((mesh.vertices - clean.vertices) * normals).sum(axis=1, keepdims=True)
    after = mesh.vertices - noise * normals
    step = step_of(mesh, after, np.full(mesh.n_vertices, edge_of(clean)))
    assert np.abs(step.T - slow_step(clean, mesh, after)).max() < 1e-3 * edge_of(clean)


def test_which_energies_are_noise(rng):
    """Energy along the surface over that along the normals: too little, noise, the mesh itself."""
    clean = triangle_torus(24, 36)
    mesh = noisy(clean, rng, 0.12)
    after = mesh.vertices - slow_offsets(mesh, clean.vertices)[:, None] * vertex_normals(clean)
    unit = np.full(mesh.n_vertices, edge_of(clean))
    whole = np.abs(step_of(mesh, after, unit)).max()
    for strength, expected in ((0.5, 0), (1, whole), (2, 0)):
        # Of stronger noise along the normals the share along the surface is smaller.
        points = after + (mesh.vertices - after) / strength
        step = step_of(mesh.with_vertices(points), after, unit)
        assert (0 if step is None else np.abs(step).max()) == pytest.approx(expected, rel=1e-5)
    # In units four times as long the noise is faint.
    assert step_of(mesh, after, 4 * unit) is None


def test_matrices_are_solved(rng):
    factor = rng.normal(size=(500, 3, 3))
    matrix = np.eye(3) + factor @ factor.transpose(0, 2, 1)
    right = rng.normal(size=(500, 3))
    rows, columns = np.triu_indices(3)
    found = solved(np.float32(matrix[:, rows, columns].T), np.float32(right.T))
    assert pytest.approx(np.linalg.solve(matrix, right[:, :, None])[:, :, 0], abs=1e-4) == found.T


@pytest.mark.parametrize("build", [triangle_torus, quad_torus])
def test_isotropic_noise_on_a_regular_mesh_goes_in_all_directions(build, rng):
    clean = build(40, 80)
    mesh = noisy(clean, rng, 0.15)
    before = compare(mesh, clean)
    after = compare(mesh.with_vertices(denoise(mesh, AUTO).vertices), clean)
    # What lies along the normals alone is a third of the energy.
    assert after.rms_distance < 0.5 * before.rms_distance
    one = compare(mesh.with_vertices(denoise(mesh, AUTO.with_changes(passes=1)).vertices), clean)
    assert one.rms_distance > 0.75 * before.rms_distance


def test_vertices_do_not_slide_where_noise_is_along_the_normals(rng):
    clean = triangle_torus(40, 80)
    for sigma in (0.05, 0.15, 0.5):
        mesh = lifted(clean, sigma * white(clean, rng))
        assert slid(clean, mesh.vertices, denoise(mesh, AUTO).vertices) < 0.25 * sigma


def test_vertices_of_an_irregular_mesh_do_not_slide(rng):
    """Half of the vertices of the sphere have four, five or eight neighbors."""
    mesh = noisy(sphere(), rng, 0.15)
    assert slid(sphere(), mesh.vertices, denoise(mesh, AUTO).vertices) < 0.05


def test_range_images_keep_their_grid(rng):
    """On slopes rows of pixels stand far apart: that is no noise."""
    grid = triangle_grid(50, 50)
    x, y = grid.vertices[:, :2].T
    heights = 9 * np.abs(np.sin(x / 7)) + 4 * np.cos(y / 9) + 0.1 * rng.normal(size=len(x))
    mesh = SurfaceMesh.from_faces(np.stack((x, y, heights), axis=1), grid.corner_vertex.reshape(-1, 3))
    step = (denoise(mesh, AUTO).vertices - mesh.vertices)[:, :2]
    assert np.sqrt((step**2).sum(axis=1).mean()) < 0.1


def test_each_island_by_itself(rng):
    first, second = triangle_torus(24, 48), quad_torus(24, 48)
    one, two = noisy(first, rng, 0.15), lifted(second, 0.15 * white(second, rng))
    both = union(one, two)
    step = denoise(both, AUTO).vertices - both.vertices
    n = first.n_vertices
    assert slid(first, one.vertices, one.vertices + step[:n]) > 0.12
    assert slid(second, two.vertices, two.vertices + step[n:]) < 0.05


def test_what_may_not_move_stays_and_strength_has_no_jumps(rng):
    clean = triangle_torus(30, 50)
    mesh = noisy(clean, rng, 0.15)
    is_movable = mesh.vertices[:, 0] > 0
    found = denoise(mesh, AUTO, movable=is_movable, region=AS_SOLVED).vertices
    assert np.array_equal(found[~is_movable], mesh.vertices[~is_movable])
    strengths = np.linspace(0, 1.5, 16)
    results = [denoise(mesh, AUTO.with_changes(strength=s)).vertices for s in strengths.tolist()]
    steps = [np.sqrt((lengths(b - a) ** 2).mean()) / edge_of(mesh) for a, b in pairwise(results)]
    assert max(steps) < 0.1
