# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bilateral filtering and its neighborhoods against loops."""

from math import ceil, exp

import numpy as np
import pytest
from checks import AS_SOLVED, edge_length, lengths, random_rotation
from framelet.core import DenoiseSettings, compare, denoise
from framelet.core.blocks import Blocks
from framelet.core.limits.constraints import find_constraints
from framelet.core.mesh.connectivity import connect
from framelet.core.methods.bilateral import bilateral_filter, vertices_within
from framelet.core.methods.problem import Problem
from meshes import MESHES, faces_of, flipped, mixed_sheet, noisy, soup, triangle_torus, union
from twins import newell
from twins import vertices_within as within


def slow_bilateral(mesh, sigma_c, sigma_s, iterations):
    """Return vertices after bilateral filtering, vertex by vertex; sigma_s 0 stands for the measured one."""
    edge = edge_length(mesh)
    points = mesh.vertices / edge
    near = [within(mesh, v, max(1, ceil(2 * sigma_c))) for v in range(mesh.n_vertices)]
    for _ in range(iterations):
        normals = np.zeros_like(points)
        for face in faces_of(mesh):
            for v in face:
                normals[v] += newell(points[face])
        size = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.divide(normals, size, out=np.zeros_like(normals), where=size > 0)
        arms = [[points[q] - points[v] for q in near[v]] for v in range(len(points))]
        arms = [[arm for arm in own if np.linalg.norm(arm) <= 2 * sigma_c] for own in arms]
        if sigma_s == 0:
            sigma_s = np.std([normals[v] @ arm for v, own in enumerate(arms) for arm in own])
        moved = points.copy()
        for v, own in enumerate(arms):
            total = heights = 0.0
            for arm in own:
                h = normals[v] @ arm
                weight = exp(-(arm @ arm) / (2 * sigma_c**2)) * exp(-(h**2) / (2 * sigma_s**2))
                total += weight
                heights += weight * h
            if total > 0:
                moved[v] = points[v] + normals[v] * heights / total
        points = moved
    return points * edge


@pytest.mark.parametrize(("sigma_c", "sigma_s"), [(1.0, 0.0), (0.4, 0.2), (1.6, 0.5)])
@pytest.mark.parametrize("name", ["small torus", "mixed sheet", "prism", "bow tie"])
def test_matches_the_loop_twin(name, sigma_c, sigma_s, rng):
    mesh = flipped(triangle_torus(6, 9)) if name == "small torus" else MESHES[name]()
    mesh = noisy(mesh, rng)
    settings = DenoiseSettings(
        method="BILATERAL", sigma_c=sigma_c, sigma_s=sigma_s, iterations=3, boundary="FREE"
    )
    result = denoise(mesh, settings, dtype=np.float64, region=AS_SOLVED).vertices
    expected = slow_bilateral(mesh, sigma_c, sigma_s, 3)
    loose = connect(mesh).is_loose
    assert lengths(result - expected)[~loose].max() < 1e-10
    assert lengths(result - mesh.vertices).max() > 1e-3


def test_blocks_do_not_change_the_result(rng):
    mesh = noisy(mixed_sheet(), rng)
    connectivity = connect(mesh)
    settings = DenoiseSettings(method="BILATERAL", sigma_s=0.4)
    points = np.ascontiguousarray(mesh.vertices.T)
    constraints = find_constraints(mesh, connectivity, settings, None, points.dtype)
    results = []
    for n_threads, block_size in ((1, 1000), (2, 7), (1, 45)):
        with Blocks(n_threads, block_size) as blocks:
            problem = Problem(points, points, mesh, connectivity, 1.0, settings, constraints, blocks)
            results.append(bilateral_filter(problem).points)
    assert np.array_equal(results[0], results[1])
    assert np.array_equal(results[0], results[2])


@pytest.mark.parametrize("n_edges", [1, 2, 4])
def test_neighborhoods_match_the_loop_twin(n_edges):
    mesh = union(mixed_sheet(), flipped(triangle_torus(5, 6)), soup(3), soup(4, shortest=1))
    center, member = vertices_within(connect(mesh), 0, mesh.n_vertices, n_edges)
    for v in range(mesh.n_vertices):
        assert member[center == v].tolist() == within(mesh, v, n_edges)
    middle = vertices_within(connect(mesh), 10, 50, n_edges)
    wanted = (center >= 10) & (center < 50)
    assert np.array_equal(middle[0], center[wanted])
    assert np.array_equal(middle[1], member[wanted])


def test_an_empty_range_has_no_neighborhood():
    center, member = vertices_within(connect(triangle_torus()), 5, 5, 2)
    assert not len(center)
    assert not len(member)


def test_noise_goes_down(rng):
    clean = triangle_torus(24, 48)
    noise = clean.with_vertices(
        clean.vertices + rng.normal(0, 0.05, clean.vertices.shape) @ random_rotation(rng)
    )
    result = clean.with_vertices(denoise(noise, DenoiseSettings(method="BILATERAL", iterations=5)).vertices)
    assert compare(result, clean).mean_angle < 0.6 * compare(noise, clean).mean_angle


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("sigma_s", [5e-324, 1.5e-164, 1e-20])
def test_heights_next_to_zero_let_nothing_move(sigma_s, dtype, rng):
    """Their squares are no numbers any more."""
    mesh = noisy(triangle_torus(), rng)
    result = denoise(mesh, DenoiseSettings(method="BILATERAL", sigma_s=sigma_s), dtype=dtype)
    assert lengths(result.vertices - mesh.vertices).max() < 1e-6
