# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The estimate of a mesh's noise: right on made and on shared meshes, and nothing odd anywhere."""

import warnings

import numpy as np
import pytest
from checks import edge_length, random_rotation, read_only
from framelet.core import SurfaceMesh, add_noise, connect, estimate_noise
from framelet.core.mesh.geometry import mean_edge_length, vertex_normals
from framelet.core.noise.estimate import N_PATCHES
from framelet.core.noise.fits import fit_heights
from framelet.core.noise.local_noise import chi_squared_quantile
from framelet.core.noise.patches import find_patches, local_adjacency, spread_sample
from meshes import (
    MESHES,
    faces_of,
    flipped,
    mixed_sheet,
    pyramid,
    quad_grid,
    soup,
    triangle_grid,
    triangle_torus,
)

KINDS = ("normals", "all directions")


def noisy(mesh, sigma, kind="normals", seed=0):
    """Return the mesh with noise of sigma mean edge lengths."""
    if kind == "normals":
        return mesh.with_vertices(add_noise(mesh, sigma, seed))
    offset = np.random.default_rng(seed).normal(0, sigma * mean_edge_length(mesh), mesh.vertices.shape)
    return mesh.with_vertices((mesh.vertices + offset).astype(mesh.vertices.dtype))


def impulsive(mesh, sigma=0.5, share=0.5, seed=0):
    """Return the mesh with a share of its vertices moved along their normals, the others exact."""
    moved = np.random.default_rng(seed + 1).random(mesh.n_vertices) < share
    return mesh.with_vertices(np.where(moved[:, None], add_noise(mesh, sigma, seed), mesh.vertices))


def box(n=24):
    """Return a cube of triangles with n x n squares a side."""
    grid = triangle_grid(n + 1, n + 1)
    points, faces = [], []
    for axis in range(3):
        for side in (0, n):
            place = np.roll(
                np.column_stack((np.abs(grid.vertices[:, :2]), np.full(len(grid.vertices), side))), axis, 1
            )
            faces += (np.array(faces_of(grid))[:, :: 1 if side else -1] + len(points) * len(place)).tolist()
            points.append(place)
    unique, number = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return SurfaceMesh.from_faces(unique, number.reshape(-1)[np.array(faces)])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("sigma", [0.01, 0.1, 0.3, 0.7])
@pytest.mark.parametrize("name", ["triangles", "irregular", "quads", "torus", "box"])
def test_gaussian_noise(name, sigma, kind):
    mesh = {
        "triangles": lambda: triangle_grid(50, 60),
        "irregular": lambda: flipped(triangle_grid(24, 25)),
        "quads": lambda: quad_grid(50, 60),
        "torus": lambda: triangle_torus(48, 150),
        "box": box,
    }[name]()
    found = estimate_noise(noisy(mesh, sigma, kind))
    edge = edge_length(mesh)
    assert found.sigma == pytest.approx(sigma * edge, rel=0.15 if name == "irregular" else 0.1)
    assert found.rms == found.sigma
    assert not found.is_impulsive
    noisy_edge = edge_length(noisy(mesh, sigma, kind))
    assert found.sigma_edges == pytest.approx(found.sigma / noisy_edge, rel=1e-9)
    if kind == "normals":
        assert found.sigma_clean_edges == pytest.approx(found.sigma / edge, rel=0.06)


@pytest.mark.parametrize("share", [0.1, 0.25, 0.5])
@pytest.mark.parametrize("sigma", [0.1, 0.5])
@pytest.mark.parametrize("make", [lambda: triangle_torus(48, 150), box, lambda: quad_grid(50, 60)])
def test_impulsive_noise(make, sigma, share):
    mesh = make()
    found = estimate_noise(impulsive(mesh, sigma, share))
    assert found.is_impulsive
    assert found.rms > found.sigma
    assert found.rms == pytest.approx(sigma * np.sqrt(share) * edge_length(mesh), rel=0.35)


def test_laplacian_noise_is_not_gaussian():
    mesh = triangle_torus(48, 150)
    draws = np.random.default_rng(0).laplace(0, 0.2 * edge_length(mesh), mesh.n_vertices)
    found = estimate_noise(mesh.with_vertices(mesh.vertices + draws[:, None] * vertex_normals(mesh)))
    assert found.is_impulsive
    assert found.rms == pytest.approx(0.2 * np.sqrt(2) * edge_length(mesh), rel=0.1)


def test_noise_within_the_surface_does_not_count(rng):
    mesh = triangle_grid(40, 40)
    inside = mesh.vertices + rng.normal(0, 0.2, mesh.vertices.shape) * [1, 1, 0]
    assert estimate_noise(mesh.with_vertices(inside)).sigma < 1e-9


def test_clean_meshes_have_none():
    for mesh in (triangle_grid(), quad_grid(9, 9), flipped(triangle_grid(24, 25)), mixed_sheet(), box()):
        found = estimate_noise(mesh)
        assert found.sigma_edges < 1e-6
        assert not found.is_impulsive
    found = estimate_noise(triangle_torus(48, 150))
    assert found.sigma_edges < 0.005
    assert not found.is_impulsive


def test_cubic_surfaces_leave_nothing():
    mesh = flipped(triangle_grid(24, 25))
    x, y, _ = mesh.vertices.T / 20
    height = 0.3 * x**3 - 0.2 * x * y**2 + 0.5 * x * y - y**2
    # Heights over the patch's own plane are cubic only where the plane is level: the rest is of higher order.
    for scale, limit in ((1e-3, 1e-9), (1.0, 2e-3)):
        surface = mesh.with_vertices(np.column_stack((mesh.vertices[:, :2], 20 * scale * height)))
        assert estimate_noise(surface).sigma < limit


@pytest.mark.parametrize("make", [box, lambda: quad_grid(30, 30), lambda: flipped(triangle_torus(20, 40))])
def test_moving_turning_scaling_and_renumbering(make, rng):
    mesh = noisy(make(), 0.2)
    found = estimate_noise(mesh)
    turned = estimate_noise(mesh.with_vertices(mesh.vertices @ random_rotation(rng).T + [30.0, -20.0, 10.0]))
    assert turned.sigma == pytest.approx(found.sigma, rel=1e-6)
    for scale in (1e-6, 1e6):
        scaled = estimate_noise(mesh.with_vertices(mesh.vertices * scale))
        assert scaled.sigma == pytest.approx(scale * found.sigma, rel=1e-6)
        assert scaled.sigma_edges == pytest.approx(found.sigma_edges, rel=1e-6)
    order = rng.permutation(mesh.n_vertices)
    vertices = np.empty_like(mesh.vertices)
    vertices[order] = mesh.vertices
    faces = [np.roll(order[face], 1).tolist() for face in faces_of(mesh)]
    renumbered = estimate_noise(
        SurfaceMesh.from_faces(vertices, [faces[k] for k in rng.permutation(len(faces))])
    )
    assert renumbered.sigma == pytest.approx(found.sigma, rel=1e-6)


def test_large_meshes_are_sampled_whatever_their_numbering(rng):
    mesh = noisy(triangle_torus(120, 150), 0.3)
    assert mesh.n_vertices > 2 * N_PATCHES
    found = estimate_noise(mesh)
    assert found.sigma == pytest.approx(0.3 * edge_length(triangle_torus(120, 150)), rel=0.03)
    order = rng.permutation(mesh.n_vertices)
    vertices = np.empty_like(mesh.vertices)
    vertices[order] = mesh.vertices
    renumbered = estimate_noise(SurfaceMesh.from_faces(vertices, order[np.array(faces_of(mesh))]))
    assert renumbered.sigma == pytest.approx(found.sigma, rel=1e-6)


def test_far_away_in_float64():
    mesh = noisy(triangle_torus(30, 60), 0.2)
    far = estimate_noise(mesh.with_vertices(mesh.vertices + 1e7))
    assert far.sigma == pytest.approx(estimate_noise(mesh).sigma, rel=1e-5)


def test_inputs_stay_and_threads_do_not_matter():
    mesh = read_only(noisy(mixed_sheet(), 0.2))
    assert estimate_noise(mesh) == estimate_noise(mesh, connectivity=connect(mesh))
    mesh = noisy(triangle_torus(60, 80), 0.2)
    assert estimate_noise(mesh, threads=3) == estimate_noise(mesh)


def test_fits_and_their_slow_twin(rng):
    mesh = noisy(mixed_sheet(), 0.2, "all directions")
    connectivity = connect(mesh)
    centers = np.flatnonzero(~connectivity.is_loose)
    patches = find_patches(local_adjacency(mesh, connectivity, centers), centers)
    found = fit_heights(mesh.vertices, patches)
    for k in range(len(centers)):
        points = mesh.vertices[patches.items[patches.offset[k] : patches.offset[k + 1]]]
        points = points - points.mean(axis=0)
        w, u, h = (points @ axis for axis in np.linalg.svd(points)[2])
        deviation = np.sqrt((points**2).sum(axis=1).mean())
        terms = [(u / deviation) ** i * (w / deviation) ** j for i in range(4) for j in range(4 - i)]
        lower = [(u / deviation) ** i * (w / deviation) ** j for i in range(3) for j in range(3 - i)]
        hats = [np.stack(t, 1) @ np.linalg.pinv(np.stack(t, 1)) for t in (terms, lower)]
        degrees_of_freedom = len(points) - np.trace(hats[0])
        assert found.degrees_of_freedom[k] == pytest.approx(degrees_of_freedom, abs=1e-5)
        assert found.extent[k] == pytest.approx(min(np.std(u), np.std(w)))
        if degrees_of_freedom < 2:
            continue
        residual, of_lower = h - hats[0] @ h, h - hats[1] @ h
        center = residual[0] / np.sqrt((residual**2).sum() / degrees_of_freedom * (1 - hats[0][0, 0]))
        assert abs(found.studentized[k]) == pytest.approx(abs(center), rel=1e-4, abs=1e-4)
        ratio = ((of_lower**2).sum() - (residual**2).sum()) / (residual**2).sum()
        cubic = (
            found.cubic[k]
            * max(found.cubic_degrees_of_freedom[k], 1)
            / (found.variance[k] * found.degrees_of_freedom[k])
        )
        assert cubic == pytest.approx(ratio, rel=1e-3, abs=1e-5)
        assert (
            0.5 * (residual**2).sum()
            < found.variance[k] * degrees_of_freedom
            <= (residual**2).sum() * (1 + 1e-6)
        )


@pytest.mark.parametrize("name", MESHES)
def test_patches_and_their_slow_twin(name):
    mesh = MESHES[name]()
    connectivity = connect(mesh)
    centers = np.flatnonzero(~connectivity.is_loose)[::3]
    if not len(centers):
        return
    patches = find_patches(local_adjacency(mesh, connectivity, centers), centers)
    near = [set() for _ in range(mesh.n_vertices)]
    for face in faces_of(mesh):
        pairs = zip(face, np.roll(face, 1).tolist(), strict=True)
        if len(face) <= 8:
            pairs = ((a, b) for a in face for b in face)
        for a, b in pairs:
            near[a].add(b)
            near[b].add(a)
    for k, center in enumerate(centers):
        first = near[center] | {center}
        expected = first.union(*(near[v] for v in first))
        patch = patches.items[patches.offset[k] : patches.offset[k + 1]]
        assert patch[0] == center
        assert len(set(patch.tolist())) == len(patch)
        assert set(patch.tolist()) == expected


def test_sample_is_spread(rng):
    points = rng.normal(size=(1000, 3))
    candidates = np.flatnonzero(rng.random(1000) < 0.7)
    sample = spread_sample(points, candidates, 50)
    assert len(np.unique(sample)) == 50
    assert np.isin(sample, candidates).all()
    order = rng.permutation(1000)
    assert set(np.flatnonzero(np.isin(order, sample))) == set(
        spread_sample(points[order], np.flatnonzero(np.isin(order, candidates)), 50)
    )
    assert spread_sample(points, candidates, 2000) is candidates


@pytest.mark.parametrize("degrees_of_freedom", [3, 5, 9, 15])
def test_quantiles_of_chi_squared(degrees_of_freedom, rng):
    draws = (rng.normal(size=(100_000, degrees_of_freedom)) ** 2).mean(axis=1)
    for place in (0.1, 0.25, 0.5, 0.75, 0.9):
        quantile = chi_squared_quantile(np.array([float(degrees_of_freedom)]), place)[0]
        assert quantile == pytest.approx(np.quantile(draws, place), rel=0.03)


@pytest.mark.parametrize("name", MESHES)
def test_tiny_meshes_give_finite_numbers(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for mesh in (MESHES[name](), noisy(MESHES[name](), 0.3, "all directions")):
            found = estimate_noise(mesh)
            assert np.isfinite([found.sigma, found.sigma_edges, found.sigma_clean_edges, found.rms]).all()
            assert 0.0 <= found.sigma <= found.rms
    if mesh.n_vertices < 20:
        assert found.sigma == 0.0


def test_hostile_meshes_give_finite_numbers(rng):
    torus = flipped(triangle_torus())
    vertices = torus.vertices.copy()
    vertices[10] = vertices[11] = vertices[12]
    vertices[50:60] = vertices[50] + np.linspace(0, 1e-12, 10)[:, None]
    vertices[100] += 1e4
    stretched = noisy(triangle_grid(30, 30), 0.2, "all directions")
    stretched = stretched.with_vertices(stretched.vertices * [1e4, 1.0, 1.0])
    line = triangle_grid(9, 9)
    cases = [torus.with_vertices(vertices), stretched, line.with_vertices(line.vertices * [1, 0, 0])]
    cases += [pyramid(5000, closed=True), *(soup(seed, shortest=1) for seed in range(10))]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for mesh in cases:
            found = estimate_noise(mesh)
            assert np.isfinite([found.sigma, found.sigma_edges, found.sigma_clean_edges, found.rms]).all()


@pytest.mark.parametrize(
    ("mesh", "message"),
    [
        (SurfaceMesh.from_faces(np.zeros((0, 3)), []), "The mesh is empty"),
        (SurfaceMesh.from_faces(np.eye(3), []), "has 3 vertices but no faces"),
        (SurfaceMesh.from_faces(np.zeros((3, 3)), [(0, 1, 2)]), "All faces have shrunk to points"),
        (SurfaceMesh.from_faces([(0, 0, 0), (0, np.inf, 0), (1, 0, 0)], [(0, 1, 2)]), "Vertex 1 at"),
    ],
)
def test_meshes_without_a_size_are_refused(mesh, message):
    with pytest.raises(ValueError, match=message):
        estimate_noise(mesh)
