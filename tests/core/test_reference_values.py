# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of an independent implementation of the paper's algorithms, to the printed digits.

Noise is a fifth of the clean mesh's mean edge length e along the vertex normals, where a normal is the
normalized sum of the cross products of the faces: of two edges, or of the diagonals of a quad. lambda is in
units of e.
"""

import numpy as np
import pytest
from checks import AS_SOLVED, edge_length
from framelet.core import DenoiseSettings, compare, denoise
from mesh_files import read_mesh
from meshes import faces_of

FANDISK = ("tri/fandisk.ply", 20.6022)
BUNNY = ("tri/bunny_closed35k.ply", 21.4751)
QUAD_FANDISK = ("quad/fandisk1742.ply", 13.8364)
BOTIJO = ("quad/botijo10k.ply", 14.0636)
FIGURES = [
    (FANDISK, "MEAN", "BANDS", (0.5, 1, 0.0, 10), (8.1567, 0.22265, 0.26392)),
    (FANDISK, "MEAN", "BANDS", (0.2, 1, 0.0, 10), (10.3314, 0.17548, 0.18400)),
    (FANDISK, "MEAN", "BANDS", (0.5, 1, 0.1, 5), (8.1713, 0.18004, 0.21707)),
    (FANDISK, "MEAN", "VECTOR", (0.2, 1, 0.0, 10), (6.0140, 0.22473, 0.27574)),
    (BUNNY, "MEAN", "BANDS", (0.5, 1, 0.0, 10), (9.9250, 0.22919, 0.25489)),
    (BUNNY, "MEAN", "VECTOR", (0.2, 1, 0.0, 10), (7.0237, 0.25135, 0.29731)),
    (FANDISK, "STRAIGHT", "VECTOR", (0.3, 1, 0.0, 10), (5.1538, 0.20613, 0.26576)),
    (FANDISK, "STRAIGHT", "VECTOR", (0.5, 20, 0.0, 13), (4.9555, 0.18201, 0.24735)),
    (BUNNY, "STRAIGHT", "VECTOR", (0.3, 1, 0.0, 10), (6.6412, 0.22269, 0.27777)),
    (BUNNY, "STRAIGHT", "VECTOR", (0.3, 1, 0.1, 5), (6.5461, 0.16666, 0.22061)),
    (QUAD_FANDISK, "MEAN", "SCALAR", (0.2, 1, 0.0, 10), (6.3404, 0.25873, 0.30816)),
    (QUAD_FANDISK, "MEAN", "SCALAR", (0.1, 1, 0.0, 10), (5.7889, 0.15879, 0.20091)),
    (BOTIJO, "MEAN", "SCALAR", (0.2, 1, 0.0, 10), (5.2015, 0.24708, 0.29889)),
    (BOTIJO, "MEAN", "SCALAR", (0.3, 1, 0.1, 5), (5.6495, 0.20683, 0.26052)),
]
ANGLE = 0.5e-4
LENGTH = 0.5e-5
"""Half a unit in the last printed digit, in degrees and in edge lengths."""


@pytest.fixture(scope="module")
def cases(shared_meshes):
    """Return a function that gives clean and noisy mesh of a file, read once."""
    known = {}

    def case(file):
        if file not in known:
            clean = read_mesh(shared_meshes / file, np.float64)
            faces = clean.corner_vertex.reshape(clean.n_faces, -1)
            points = clean.vertices[faces]
            # Of a triangle this is the product of two edges, of a quad that of the diagonals.
            cross = np.cross(points[:, 2] - points[:, 0], points[:, -1] - points[:, 1])
            normals = np.zeros_like(clean.vertices)
            for corner in range(faces.shape[1]):
                np.add.at(normals, faces[:, corner], cross)
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            offset = np.random.default_rng(0).normal(0, 0.2 * edge(clean), clean.n_vertices)
            known[file] = clean, clean.with_vertices(clean.vertices + offset[:, None] * normals)
        return known[file]

    return case


def edge(mesh):
    """Return the mean edge length over face-edge incidences, where all faces have one size."""
    points = mesh.vertices[mesh.corner_vertex.reshape(mesh.n_faces, -1)]
    return np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2).mean()


@pytest.mark.parametrize(("file", "stencil", "shrinkage", "numbers", "expected"), FIGURES)
def test_figures(cases, file, stencil, shrinkage, numbers, expected):
    clean, noisy = cases(file[0])
    e = edge(clean)
    lambda_, mu, delta, iterations = numbers
    settings = DenoiseSettings(
        frame="LINEAR_SPLINE" if file[0].startswith("quad") else "BOX_SPLINE_111",
        stencil=stencil,
        shrinkage=shrinkage,
        lambda_=lambda_ * e / edge(noisy),
        mu=mu,
        delta=delta,
        iterations=iterations,
    )
    result = clean.with_vertices(denoise(noisy, settings, dtype=np.float64, region=AS_SOLVED).vertices)
    comparison = compare(result, clean)
    assert comparison.mean_angle == pytest.approx(expected[0], abs=ANGLE * 1.01)
    assert comparison.rms_distance / e == pytest.approx(expected[1], abs=LENGTH * 1.01)
    assert compare(result, noisy).rms_distance / e == pytest.approx(expected[2], abs=LENGTH * 1.01)


@pytest.mark.parametrize("file", [FANDISK, BUNNY, QUAD_FANDISK, BOTIJO])
def test_the_noisy_meshes_are_those_of_the_figures(cases, file):
    clean, noisy = cases(file[0])
    assert compare(noisy, clean).mean_angle == pytest.approx(file[1], abs=ANGLE * 1.01)


def test_the_float32_solver_gives_the_same_figures(cases):
    clean, noisy = cases(FANDISK[0])
    settings = DenoiseSettings(lambda_=0.3 * edge(clean) / edge(noisy))
    result = clean.with_vertices(denoise(noisy, settings, region=AS_SOLVED).vertices)
    assert compare(result, clean).mean_angle == pytest.approx(5.1538, abs=1e-3)


def test_the_edge_length_of_the_figures(shared_meshes):
    """The short formula above against a loop over faces."""
    mesh = read_mesh(shared_meshes / "bad" / "tetrahedron.obj", np.float64)
    assert len(faces_of(mesh)) == 4
    assert edge(mesh) == pytest.approx(edge_length(mesh))
