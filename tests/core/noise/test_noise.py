# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise model: Gaussian, along the normals, in mean edge lengths."""

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, lengths, read_only
from framelet.core import SurfaceMesh, add_noise
from framelet.core.mesh.geometry import vertex_normals
from framelet.core.noise import PAPER_SIGMA
from meshes import flipped, mixed_sheet, triangle_grid, triangle_torus


@pytest.mark.parametrize("sigma", [0.2, 1.5])
def test_statistics(sigma):
    mesh = read_only(triangle_torus(60, 80))
    offset = add_noise(mesh, sigma, seed=3) - mesh.vertices
    along = (offset * vertex_normals(mesh)).sum(axis=1) / edge_length(mesh)
    tangential = offset - along[:, None] * edge_length(mesh) * vertex_normals(mesh)
    assert lengths(tangential).max() < 1e-14
    assert np.std(along) == pytest.approx(sigma, rel=0.05)
    assert abs(along.mean()) < 4 * sigma / np.sqrt(mesh.n_vertices)
    assert np.mean(np.abs(along) < sigma) == pytest.approx(0.6827, abs=0.03)  # Gaussian, not uniform
    neighbors = along[mesh.edges]
    assert abs(np.corrcoef(neighbors.T)[0, 1]) < 0.05  # white


def test_the_model_word_by_word():
    mesh = flipped(triangle_torus())
    draws = np.random.default_rng(7).normal(0.0, PAPER_SIGMA * edge_length(mesh), mesh.n_vertices)
    expected = mesh.vertices + draws[:, None] * vertex_normals(mesh)
    assert np.abs(add_noise(mesh, seed=7) - expected).max() < 1e-14
    assert PAPER_SIGMA == 0.2


def test_seeds():
    mesh = triangle_torus()
    assert_same_bits(add_noise(mesh, seed=1), add_noise(mesh, seed=1))
    assert lengths(add_noise(mesh, seed=1) - add_noise(mesh, seed=2)).max() > 0.01


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_dtype_stays_and_loose_vertices_too(dtype):
    mesh = mixed_sheet()
    mesh = read_only(mesh.with_vertices(mesh.vertices.astype(dtype)))
    result = add_noise(mesh, 0.3)
    assert result.dtype == dtype
    assert_same_bits(result[42:], mesh.vertices[42:])
    assert (result[:42] != mesh.vertices[:42]).any(axis=1).all()
    assert_same_bits(add_noise(mesh, 0.0), mesh.vertices + dtype(0))


def test_noise_grows_with_the_mesh():
    mesh = triangle_torus()
    large = mesh.with_vertices(mesh.vertices * 1e6)
    assert np.abs(add_noise(large) / 1e6 - add_noise(mesh)).max() < 1e-9


@pytest.mark.parametrize("sigma", [-0.1, np.nan, np.inf])
def test_wrong_levels_are_refused(sigma):
    with pytest.raises(
        ValueError, match=rf"The noise level is {sigma:g}; it must be a finite number, at least 0"
    ):
        add_noise(triangle_grid(), sigma)


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
        add_noise(mesh)
