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
from meshes import faces_of, noisy, quad_grid, quad_torus, triangle_grid, triangle_torus, union
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
    return 2 / 3 * result


def turned(mesh, share):
    """Return a closed triangle mesh with a share of its edges, far apart, turned within their quads."""
    faces = [list(face) for face in faces_of(mesh)]
    at = {(face[k], face[k - 2]): f for f, face in enumerate(faces) for k in range(3)}
    is_used = np.zeros(len(faces), bool)
    for a, b in mesh.edges[:: round(1 / share)].tolist():
        one, two = at[a, b], at[b, a]
        if not is_used[[one, two]].any():
            c, d = (next(v for v in faces[f] if v not in (a, b)) for f in (one, two))
            faces[one], faces[two] = [a, d, c], [d, b, c]
            is_used[[one, two]] = True
    return SurfaceMesh.from_faces(mesh.vertices, faces)


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
    assert after.rms_distance < 0.6 * before.rms_distance
    one = compare(mesh.with_vertices(denoise(mesh, AUTO.with_changes(passes=1)).vertices), clean)
    assert one.rms_distance > 0.75 * before.rms_distance


def test_vertices_do_not_slide_where_noise_is_along_the_normals(rng):
    clean = triangle_torus(40, 80)
    for sigma in (0.05, 0.15, 0.5):
        mesh = lifted(clean, sigma * white(clean, rng))
        assert slid(clean, mesh.vertices, denoise(mesh, AUTO).vertices) < 0.25 * sigma


@pytest.mark.parametrize("build", [sphere, lambda: turned(triangle_torus(40, 60), 0.03)])
def test_vertices_of_an_irregular_mesh_do_not_slide(build, rng):
    """Of half of the sphere, and of a fifth of the torus, that have not six neighbors."""
    clean = build()
    mesh = noisy(clean, rng, 0.15)
    assert slid(clean, mesh.vertices, denoise(mesh, AUTO).vertices) < 0.05


@pytest.mark.parametrize("build", [triangle_grid, quad_grid])
@pytest.mark.parametrize("jitter", [0.1, 0.2])
def test_wherever_vertices_of_a_lattice_were_placed_the_result_is_nearer(build, jitter, rng):
    """Also where they stand as unevenly as if that were noise."""
    flat = build(40, 40)
    points = flat.vertices + jitter * rng.normal(size=flat.vertices.shape)
    points[:, 2] = 4 * np.sin(points[:, 0] / 11) * np.cos(points[:, 1] / 9)
    clean = flat.with_vertices(points)
    shares = []
    for sigma in np.array([0.5, 0.8, 1.0, 1.2, 1.6]) * jitter:
        mesh = lifted(clean, sigma * white(clean, rng))
        after = compare(mesh.with_vertices(denoise(mesh, AUTO).vertices), clean)
        shares.append(after.rms_distance / compare(mesh, clean).rms_distance)
    assert max(shares) < 0.9 and sum(share < 0.4 for share in shares) >= 2


def test_corners_of_a_border_are_not_rounded(rng):
    flat = quad_grid(30, 30)
    corners = np.flatnonzero(connect(flat).valence == 2)
    inward = -np.sign(flat.vertices[corners] - flat.vertices.mean(axis=0))[:, :2]
    ways = []
    for _ in range(4):
        mesh = noisy(flat, rng, 0.15)
        ways.append((((denoise(mesh, AUTO).vertices - mesh.vertices)[corners, :2]) * inward).sum(axis=1))
    assert len(corners) == 4 and abs(np.mean(ways)) < 0.15


def test_uneven_noise_is_seen_by_what_is_around(rng):
    clean = triangle_torus(40, 80)
    level = np.where(clean.vertices[:, 0] > 0, 0.1, 0.4)[:, None] * edge_of(clean)
    mesh = clean.with_vertices(clean.vertices + level * rng.normal(size=clean.vertices.shape))
    assert slid(clean, mesh.vertices, denoise(mesh, AUTO).vertices) > 0.15


def test_noise_of_a_few_vertices_that_may_move_is_that_of_these(rng):
    """The rest, which keeps its noise, takes no part."""
    clean = triangle_torus(40, 60)
    near = lengths(clean.vertices - clean.vertices[0]) < 4 * edge_of(clean)
    for mesh, slides in ((noisy(clean, rng, 0.15), True), (lifted(clean, 0.15 * white(clean, rng)), False)):
        found = denoise(mesh, AUTO, movable=near, region=AS_SOLVED)
        assert 20 < near.sum() < 100 and (found.report.noise.along > 0) == slides


def test_what_is_clean_does_not_slide(rng):
    """Half of a torus, bit for bit, while the other half does."""
    clean = triangle_torus(60, 80)
    is_noisy = clean.vertices[:, 0] > 0
    step = 0.15 * edge_of(clean) * rng.normal(size=clean.vertices.shape) * is_noisy[:, None]
    mesh = clean.with_vertices(clean.vertices + step)
    result = denoise(mesh, AUTO)
    stayed = (result.vertices == mesh.vertices).all(axis=1)
    assert result.report.noise.along > 0.05 and stayed[~is_noisy].mean() > 0.5


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
    assert slid(first, one.vertices, one.vertices + step[:n]) > 0.08
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
    assert max(steps) < 0.07
    half, whole = (slid(clean, mesh.vertices, results[k]) for k in (5, 10))
    assert half == pytest.approx(whole / 2, rel=0.3)
