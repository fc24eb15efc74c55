# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moving, turning, scaling and renumbering a mesh commute with denoising it."""

import numpy as np
import pytest
from checks import TRIANGLE_PRESETS, lengths, random_rotation, wild_mesh
from framelet.core import PRESETS, DenoiseSettings, denoise
from meshes import (
    faces_of,
    flipped,
    loose_edges_of,
    mixed_sheet,
    noisy,
    pyramid,
    triangle_grid,
    triangle_torus,
    turned_over,
    union,
)

ROUNDING = 1e-9
"""Mean edge lengths by which results may differ in float64 after ten iterations."""

FLOAT32 = 2e-5
"""The same for a float32 solver on a mesh some ten edges wide."""

PRESET = pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
AXIS_FREE = pytest.mark.parametrize("preset", ["TRI_2", "BILATERAL"])


@pytest.fixture(params=["closed", "open", "mixed", "turned over"])
def mesh(request, rng):
    """Irregular noisy meshes without ties: closed, open, of all kinds of faces, and of both orientations."""
    made = {
        "closed": lambda: flipped(triangle_torus()),
        "open": lambda: flipped(triangle_grid()),
        "mixed": lambda: union(mixed_sheet(), pyramid(9), flipped(triangle_torus(6, 7))),
        "turned over": lambda: turned_over(flipped(triangle_torus(6, 9))),
    }[request.param]()
    return noisy(made, rng)


def solved(mesh, preset, dtype=np.float64):
    result = denoise(mesh, PRESETS[preset].settings, dtype=dtype)
    assert result.report.displacement_rms > 0.01 * result.report.mean_edge_length
    return result.vertices


def assert_same(result, expected, mesh, tolerance, slack=0.0):
    edge = lengths(mesh.vertices[mesh.edges[:, 0]].astype(float) - mesh.vertices[mesh.edges[:, 1]]).mean()
    assert lengths(result.astype(np.float64) - expected).max() < tolerance * edge + slack


@AXIS_FREE
def test_rotation(preset, mesh, rng):
    rotation = random_rotation(rng)
    turned = mesh.with_vertices(mesh.vertices @ rotation)
    assert_same(solved(turned, preset), solved(mesh, preset) @ rotation, mesh, ROUNDING)


@pytest.mark.parametrize("axes", [[1, 2, 0], [2, 0, 1], [1, 0, 2]])
@PRESET
def test_permuted_and_mirrored_axes(preset, axes, mesh):
    """BANDS and SCALAR depend on the axes, but not on their order or direction."""
    signs = np.array([1.0, -1.0, 1.0])
    turned = mesh.with_vertices((mesh.vertices * signs)[:, axes])
    assert_same(solved(turned, preset), (solved(mesh, preset) * signs)[:, axes], mesh, ROUNDING)


@PRESET
def test_translation(preset, mesh):
    shift = np.array([3.25, -7.5, 1.0])
    assert_same(
        solved(mesh.with_vertices(mesh.vertices + shift), preset),
        solved(mesh, preset) + shift,
        mesh,
        ROUNDING,
    )


@PRESET
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_translation_far_away(preset, dtype, mesh):
    """At 1e7 float64 positions keep 2e-9; the solver must not lose more, whatever its precision."""
    shift = np.array([1e7, -1e7, 1e7])
    far = mesh.with_vertices(mesh.vertices + shift)
    near = mesh.with_vertices(far.vertices - shift)  # with the digits that survive
    result = solved(far, preset, dtype) - shift
    assert_same(result, solved(near, preset, dtype), mesh, FLOAT32 if dtype == np.float32 else 1e-7)


@PRESET
def test_translation_of_quantized_float32(preset, mesh):
    """Far away float32 positions are coarse; the result is that of the coarse mesh, rounded once more."""
    shift = np.float32(4096.0)
    far = mesh.with_vertices((mesh.vertices + shift).astype(np.float32))
    near = mesh.with_vertices((far.vertices - shift).astype(np.float64))
    spacing = float(np.spacing(np.float32(2 * shift)))
    result = denoise(far, PRESETS[preset].settings).vertices
    assert result.dtype == np.float32
    assert_same(result.astype(np.float64) - shift, solved(near, preset), mesh, FLOAT32, slack=2 * spacing)


@PRESET
@pytest.mark.parametrize("scale", [1e-6, 1e6, -3.0])
def test_scaling(preset, scale, mesh):
    turned = mesh.with_vertices(mesh.vertices * scale)
    assert_same(solved(turned, preset) / scale, solved(mesh, preset), mesh, ROUNDING)


@PRESET
def test_renumbering(preset, mesh, rng):
    """Vertex numbers, the order of faces and the corner a face starts with mean nothing."""
    new = rng.permutation(mesh.n_vertices)
    faces = [np.roll(new[face], rng.integers(5)) for face in faces_of(mesh)]
    faces = [faces[k] for k in rng.permutation(len(faces))]
    vertices = np.empty_like(mesh.vertices)
    vertices[new] = mesh.vertices
    other = wild_mesh(vertices, faces, new[loose_edges_of(mesh)])
    assert_same(solved(other, preset)[new], solved(mesh, preset), mesh, ROUNDING)


@AXIS_FREE
def test_turning_all_faces_over(preset, mesh):
    faces = [face[::-1] for face in faces_of(mesh)]
    other = wild_mesh(mesh.vertices, faces, loose_edges_of(mesh))
    assert_same(solved(other, preset), solved(mesh, preset), mesh, ROUNDING)


@AXIS_FREE
def test_a_symmetric_mesh_stays_symmetric_when_turned(preset, rng):
    """On a symmetric mesh angles tie; rounding must not decide them differently after a rotation."""
    mesh = union(triangle_torus(), pyramid(8, closed=True))
    rotation = random_rotation(rng)
    turned = mesh.with_vertices(mesh.vertices @ rotation)
    settings = PRESETS[preset].settings
    result, expected = denoise(turned, settings), denoise(mesh, settings)
    assert_same(result.vertices, expected.vertices @ rotation, mesh, FLOAT32 * 10)


@PRESET
def test_float32_solver_agrees_with_float64(preset, mesh):
    assert_same(solved(mesh, preset, np.float32), solved(mesh, preset), mesh, 1e-4)


@pytest.mark.parametrize("shrinkage", ["BANDS", "SCALAR"])
def test_some_shrinkages_do_depend_on_the_axes(shrinkage, mesh, rng):
    """So that the tests of rotation above mean something."""
    rotation = random_rotation(rng)
    settings = DenoiseSettings(method="POSITIONS", frame="BOX_SPLINE_111", shrinkage=shrinkage)
    turned = denoise(mesh.with_vertices(mesh.vertices @ rotation), settings).vertices
    assert lengths(turned - denoise(mesh, settings).vertices @ rotation).max() > 1e-3
