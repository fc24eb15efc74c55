# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing that looks like a mesh may crash, hang or give numbers that are not finite."""

import numpy as np
import pytest
from checks import TRIANGLE_PRESETS, preset_settings, wild_mesh
from framelet.core import PRESETS, MeshError, SurfaceMesh, add_noise, denoise
from framelet.core.blocks import BLOCK_SIZE
from mesh_files import mesh_files, read_mesh
from meshes import MESHES, bow_tie, clean_soup, faces_of, noisy, pyramid, soup, triangle_torus

PRESET = pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
BOUNDARY = pytest.mark.parametrize("boundary", ["FIXED", "ALONG", "FREE"])


def assert_finite(mesh, settings):
    result = denoise(mesh, settings)
    assert np.isfinite(result.vertices).all()
    assert np.isfinite([result.report.displacement_rms, result.report.displacement_max]).all()
    # A smoother that throws a vertex across the room is broken, even where the surface is.
    span = np.ptp(mesh.vertices, axis=0).max()
    assert result.report.displacement_max <= 2 * span


@PRESET
@BOUNDARY
@pytest.mark.parametrize("name", MESHES)
def test_every_mesh_made_in_code(name, preset, boundary, rng):
    assert_finite(noisy(MESHES[name](), rng), preset_settings(preset, boundary=boundary))


@PRESET
@pytest.mark.parametrize("shortest", [1, 3])
def test_polygon_soups(preset, shortest):
    for seed in range(12):
        assert_finite(soup(seed, shortest=shortest), PRESETS[preset].settings)
        assert_finite(clean_soup(seed), PRESETS[preset].settings)


@PRESET
@BOUNDARY
def test_many_fans_and_high_valences(preset, boundary, rng):
    settings = preset_settings(preset, boundary=boundary)
    for mesh in (bow_tie(100), pyramid(150, closed=boundary == "ALONG")):
        assert_finite(noisy(mesh, rng), settings)


@PRESET
def test_a_fan_with_5000_spokes(preset, rng):
    # Bilateral filtering takes all pairs of spokes: 400 of them are 160 000 already.
    spokes = 400 if preset == "BILATERAL" else 5000
    assert_finite(noisy(pyramid(spokes, closed=True), rng), preset_settings(preset, iterations=2))


@PRESET
def test_many_loose_vertices(preset, rng):
    """More than a block of them, so that a block has no neighbors at all."""
    mesh = noisy(MESHES["tetrahedron"](), rng)
    points = np.concatenate((mesh.vertices, rng.normal(size=(3 * BLOCK_SIZE, 3))))
    assert_finite(SurfaceMesh.from_faces(points, faces_of(mesh)), PRESETS[preset].settings)


@PRESET
def test_coincident_vertices_and_needles(preset):
    mesh = MESHES["irregular torus"]()
    vertices = mesh.vertices.copy()
    vertices[10] = vertices[11] = vertices[12]
    vertices[50:60] = vertices[50] + np.linspace(0, 1e-12, 10)[:, None]
    vertices[100] += 1e4
    assert_finite(mesh.with_vertices(vertices), PRESETS[preset].settings)


@PRESET
@pytest.mark.parametrize(
    "changes",
    [
        {"lambda_": 100.0, "mu": 1e-3},
        {"mu": 1e4},
        {"delta": 1.0, "mu": 1e4},
        {"sigma_c": 0.1, "sigma_s": 10.0},
    ],
)
def test_the_ends_of_the_ranges(preset, changes, rng):
    result = denoise(noisy(MESHES["mixed sheet"](), rng), preset_settings(preset, iterations=200, **changes))
    assert np.isfinite(result.vertices).all()


@PRESET
@pytest.mark.parametrize("kind", ["bad", "nonmanifold"])
def test_files_give_finite_vertices_or_one_sentence(shared_meshes, preset, kind):
    paths = mesh_files(shared_meshes, kind)
    assert paths
    refused = set()
    for path in paths:
        mesh = read_mesh(path)
        try:
            result = denoise(mesh, PRESETS[preset].settings)
        except ValueError as error:
            message = str(error)
            assert message[0].isupper(), message
            assert message.endswith("."), message
            assert message.count(". ") == 0, message
            refused.add(path.stem)
            continue
        assert np.isfinite(result.vertices).all(), path.name
        assert result.vertices.dtype == np.float32
    assert refused <= {"all_coincident", "empty", "nan_vertex", "one_edge", "single_vertex", "wire_polyline"}


@PRESET
def test_real_scans_and_mixed_meshes_are_cleaned(shared_meshes, preset):
    for path in mesh_files(shared_meshes, "mixed"):
        mesh = read_mesh(path)
        noise = mesh.with_vertices(add_noise(mesh, 0.2, seed=1))
        result = denoise(noise, PRESETS[preset].settings)
        assert np.isfinite(result.vertices).all()
        assert 0.05 < result.report.displacement_rms / result.report.mean_edge_length < 1.0


def test_huge_and_tiny_meshes_are_cleaned():
    """As long as the squares of lengths are numbers, size does not matter."""
    mesh = noisy(MESHES["tetrahedron"](), np.random.default_rng(0))
    for scale in (1e-100, 1e-30, 1e30, 1e100):
        result = denoise(
            mesh.with_vertices(mesh.vertices * scale), PRESETS["TRI_2"].settings, dtype=np.float64
        )
        assert np.allclose(
            result.vertices / scale,
            denoise(mesh, PRESETS["TRI_2"].settings, dtype=np.float64).vertices,
            rtol=1e-6,
        )


def test_faces_that_name_one_vertex_only():
    mesh = wild_mesh(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 2, 2)], [(0, 1, 2), (3, 3, 3), (1, 1, 2), (0,), ()]
    )
    for preset in TRIANGLE_PRESETS:
        result = denoise(mesh, PRESETS[preset].settings)
        assert np.isfinite(result.vertices).all()
        assert np.allclose(result.vertices[3], mesh.vertices[3], rtol=0, atol=1e-6)


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2", "BILATERAL"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_coordinates_near_the_largest_number_are_refused(preset, dtype):
    """A result that lay farther out was infinite."""
    mesh = noisy(triangle_torus(), np.random.default_rng(0))
    vertices = mesh.vertices.astype(dtype)
    vertices[5] = 0.9 * np.finfo(dtype).max
    with pytest.raises(MeshError, match="hardly larger numbers; scale it down"):
        denoise(mesh.with_vertices(vertices), PRESETS[preset].settings)
