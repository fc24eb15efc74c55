# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of independent implementations of the paper's algorithms, to the printed digits.

Those of meshes made in code are of `paper_twin`, loops that share no code with the package.

Noise is a fifth of the clean mesh's mean edge length e along the vertex normals, where a normal is the
normalized sum of the cross products of the faces: of two edges, or of the diagonals of a quad. lambda is in
units of e.
"""

import numpy as np
import pytest
from checks import AS_SOLVED, edge_length
from framelet.core import DenoiseSettings, compare, denoise
from known_shapes import part, stairs
from mesh_files import read_mesh
from meshes import faces_of, flipped, triangle_torus
from paper_twin import denoised

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
MADE = {
    "torus": lambda: flipped(triangle_torus(16, 22)),  # valences from 3 to 14
    "part": lambda: part(2, 4),
    "stairs": lambda: stairs(2, 4),
}
MADE_NOISY = {"torus": 30.7537, "part": 18.9143, "stairs": 12.4615}
MADE_FIGURES = [
    ("torus", "MEAN", "BANDS", (0.5, 1, 0.0, 10), (28.7098, 0.64164, 0.66202)),
    ("torus", "MEAN", "BANDS", (0.5, 1, 0.1, 5), (22.7987, 0.43261, 0.45642)),
    ("torus", "MEAN", "VECTOR", (0.2, 1, 0.0, 10), (25.6467, 0.46626, 0.47971)),
    ("torus", "STRAIGHT", "VECTOR", (0.3, 1, 0.0, 10), (21.5111, 0.32827, 0.34504)),
    ("torus", "STRAIGHT", "VECTOR", (0.5, 20, 0.0, 13), (20.7101, 0.27586, 0.29424)),
    ("part", "MEAN", "BANDS", (0.2, 1, 0.0, 10), (10.2986, 0.16707, 0.16480)),
    ("part", "STRAIGHT", "VECTOR", (0.3, 1, 0.0, 10), (7.5091, 0.32921, 0.37096)),
    ("part", "STRAIGHT", "VECTOR", (0.3, 1, 0.1, 5), (7.3528, 0.22855, 0.26814)),
    ("stairs", "MEAN", "SCALAR", (0.2, 1, 0.0, 10), (5.3464, 0.28324, 0.32941)),
    ("stairs", "MEAN", "SCALAR", (0.3, 1, 0.1, 5), (8.6953, 0.30639, 0.33651)),
    ("stairs", "MEAN", "VECTOR", (0.2, 1, 0.0, 10), (3.7992, 0.19838, 0.26035)),
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
            known[file] = clean, with_noise(clean)
        return known[file]

    return case


def with_noise(clean):
    """Return the mesh with the noise of the figures."""
    faces = clean.corner_vertex.reshape(clean.n_faces, -1)
    points = clean.vertices[faces]
    # Of a triangle this is the product of two edges, of a quad that of the diagonals.
    cross = np.cross(points[:, 2] - points[:, 0], points[:, -1] - points[:, 1])
    normals = np.zeros_like(clean.vertices)
    for corner in range(faces.shape[1]):
        np.add.at(normals, faces[:, corner], cross)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offset = np.random.default_rng(0).normal(0, 0.2 * edge(clean), clean.n_vertices)
    return clean.with_vertices(clean.vertices + offset[:, None] * normals)


def edge(mesh):
    """Return the mean edge length over face-edge incidences, where all faces have one size."""
    points = mesh.vertices[mesh.corner_vertex.reshape(mesh.n_faces, -1)]
    return np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2).mean()


def solved(clean, noisy, stencil, shrinkage, numbers):
    """Return the positions that the package finds."""
    lambda_, mu, delta, iterations = numbers
    settings = DenoiseSettings(
        method="POSITIONS",
        frame="LINEAR_SPLINE" if len(faces_of(clean)[0]) == 4 else "BOX_SPLINE_111",
        stencil=stencil,
        shrinkage=shrinkage,
        lambda_=lambda_ * edge(clean) / edge(noisy),
        mu=mu,
        delta=delta,
        iterations=iterations,
    )
    return denoise(noisy, settings, dtype=np.float64, region=AS_SOLVED).vertices


def assert_figures(positions, clean, noisy, expected):
    """Fail unless angle, distance to the clean mesh and distance moved have the printed digits."""
    result = clean.with_vertices(positions)
    comparison = compare(result, clean)
    e = edge(clean)
    assert comparison.mean_angle == pytest.approx(expected[0], abs=ANGLE * 1.01)
    assert comparison.rms_distance / e == pytest.approx(expected[1], abs=LENGTH * 1.01)
    assert compare(result, noisy).rms_distance / e == pytest.approx(expected[2], abs=LENGTH * 1.01)


@pytest.mark.parametrize(("file", "stencil", "shrinkage", "numbers", "expected"), FIGURES)
def test_figures(cases, file, stencil, shrinkage, numbers, expected):
    clean, noisy = cases(file[0])
    assert_figures(solved(clean, noisy, stencil, shrinkage, numbers), clean, noisy, expected)


@pytest.mark.parametrize(("name", "stencil", "shrinkage", "numbers", "expected"), MADE_FIGURES)
def test_figures_of_meshes_made_in_code(name, stencil, shrinkage, numbers, expected):
    clean = MADE[name]()
    noisy = with_noise(clean)
    assert_figures(solved(clean, noisy, stencil, shrinkage, numbers), clean, noisy, expected)


@pytest.mark.parametrize(("name", "stencil", "shrinkage", "numbers", "expected"), MADE_FIGURES)
def test_the_twin_gives_the_figures(name, stencil, shrinkage, numbers, expected):
    clean = MADE[name]()
    noisy = with_noise(clean)
    lambda_ = numbers[0] * edge(clean)
    found = denoised(noisy.vertices, clean, stencil, shrinkage, lambda_, *numbers[1:])
    assert_figures(found, clean, noisy, expected)


@pytest.mark.parametrize("name", MADE)
def test_the_noisy_meshes_made_in_code_are_those_of_the_figures(name):
    clean = MADE[name]()
    assert compare(with_noise(clean), clean).mean_angle == pytest.approx(MADE_NOISY[name], abs=ANGLE * 1.01)


@pytest.mark.parametrize("file", [FANDISK, BUNNY, QUAD_FANDISK, BOTIJO])
def test_the_noisy_meshes_are_those_of_the_figures(cases, file):
    clean, noisy = cases(file[0])
    assert compare(noisy, clean).mean_angle == pytest.approx(file[1], abs=ANGLE * 1.01)


def test_the_float32_solver_gives_the_same_figures():
    clean = MADE["part"]()
    noisy = with_noise(clean)
    settings = DenoiseSettings(method="POSITIONS", lambda_=0.3 * edge(clean) / edge(noisy))
    result = clean.with_vertices(denoise(noisy, settings, region=AS_SOLVED).vertices)
    assert compare(result, clean).mean_angle == pytest.approx(7.5091, abs=1e-3)


@pytest.mark.parametrize("name", MADE)
def test_the_edge_length_of_the_figures(name):
    """The short formula above against a loop over faces."""
    assert edge(MADE[name]()) == pytest.approx(edge_length(MADE[name]()))
