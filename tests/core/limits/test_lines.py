# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Feature lines: found, measured, smoothed along themselves, and sharp afterwards."""

import numpy as np
import pytest
from checks import assert_same_bits, lengths, preset_settings, random_rotation
from framelet.core import PRESETS, Region, denoise
from framelet.core.limits.lines import (
    LARGEST_MOTION,
    LOW_PASS_ROUNDS,
    LOW_PASS_STEPS,
    find_lines,
    line_noise,
    smoothing_of,
)
from meshes import noisy, triangle_torus
from region_cases import METHODS, box, roof

NONE = np.zeros(0, int)


def chain(points, closed=False):
    """Return points in rows and the edges that join them one after the other."""
    number = np.arange(len(points))
    edges = np.stack((number, np.roll(number, -1)), axis=1)
    return np.asarray(points, float).T, edges if closed else edges[:-1]


def circle(n):
    angle = np.arange(n) * (2 * np.pi / n)
    return np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1) * n / 6


def test_ends_and_crossings_stay():
    edges = np.array([[0, 1], [1, 2], [2, 3], [2, 4], [4, 5], [5, 5], [1, 0]])
    lines = find_lines(np.arange(21.0).reshape(3, 7), edges, NONE)
    assert lines.vertices.tolist() == [0, 1, 2, 3, 4, 5]
    assert lines.inner.tolist() == [1, 4]
    assert np.sort(lines.neighbors).tolist() == [[0, 2], [2, 5]]


def test_pinned_vertices_stay():
    points, edges = chain(circle(20), closed=True)
    assert find_lines(points, edges, np.array([3, 7])).inner.tolist() == [
        k for k in range(20) if k not in (3, 7)
    ]


@pytest.mark.parametrize("n", [3, 4, 5, 6, 8, 12, 16, 100])
def test_circles_have_no_corners_but_triangles_and_squares_do(n):
    points, edges = chain(circle(n), closed=True)
    expected = 0 if n > 4 else n
    # A chord around so small a ring turns as far as it may; only from a few vertices on is it a circle.
    n_corners = n - len(find_lines(points, edges, NONE).inner)
    assert n_corners == expected or n < 6


def test_corners_of_a_square_path_stay(rng):
    side = np.arange(10.0)
    square = [(t, 0, 0) for t in side] + [(10, t, 0) for t in side]
    square += [(10 - t, 10, 0) for t in side] + [(0, 10 - t, 0) for t in side]
    points, edges = chain(square, closed=True)
    points = points + rng.normal(0, 0.1, points.shape)
    assert np.setdiff1d(np.arange(40), find_lines(points, edges, NONE).inner).tolist() == [0, 10, 20, 30]


def test_the_lines_of_a_box():
    mesh, edges = box(8)
    lines = find_lines(mesh.vertices.T, edges, NONE)
    at_end = np.isin(mesh.vertices, (0, 8)).sum(axis=1)
    assert lines.vertices.tolist() == np.flatnonzero(at_end >= 2).tolist()
    assert lines.inner.tolist() == np.flatnonzero(at_end == 2).tolist()


@pytest.mark.parametrize("sigma", [0.05, 0.2])
@pytest.mark.parametrize("directions", [1, 2])
def test_the_noise_of_lines_is_measured(sigma, directions, rng):
    points, edges = chain([(t, 5 * np.sin(t / 20), 0) for t in range(400)])
    noise = np.zeros_like(points)
    noise[2 - np.arange(directions)] = rng.normal(0, sigma / np.sqrt(directions), (directions, 400))
    lines = find_lines(points + noise, edges, NONE)
    assert line_noise(points + noise, lines) == pytest.approx(sigma, rel=0.2)
    assert line_noise(points, lines) < 0.002


def test_short_lines_have_noise_too():
    points, edges = chain([(0, 0, 0), (1, 0.1, 0), (2, 0, 0)])
    lines = find_lines(points, edges, NONE)
    assert line_noise(points, lines) == pytest.approx(0.2 / np.sqrt(0.6 * 6))
    assert line_noise(points, find_lines(points, edges[:1], NONE)) == 0.0


def test_matches_a_loop(rng):
    """The low-pass 1 - (1 - A^k)^m with fixed ends, as a matrix; of its motion the part across the line."""
    n = 30
    points, edges = chain([(t, 0, 0) for t in range(n)])
    points = points + rng.normal(0, 0.1, points.shape)
    mean = np.eye(n)
    for k in range(1, n - 1):
        mean[k, k - 1 : k + 2] = 0.25, 0.5, 0.25
    rest = points.T.copy()
    for _ in range(LOW_PASS_ROUNDS):
        rest = rest - np.linalg.matrix_power(mean, LOW_PASS_STEPS) @ rest
    smooth = points.T - rest
    lines = find_lines(points, edges, NONE)
    limit = LARGEST_MOTION * line_noise(points, lines)
    found = smoothing_of(points, lines, 1.0)
    for k, motion in zip(lines.inner, found.T, strict=True):
        along = smooth[k + 1] - smooth[k - 1]
        along /= np.linalg.norm(along)
        expected = -(rest[k] - along * (rest[k] @ along))
        expected *= min(1.0, limit / np.linalg.norm(expected))
        assert np.abs(motion - expected).max() < 1e-12


def test_a_noisy_line_becomes_smoother_and_keeps_its_ends(rng):
    points, edges = chain([(t, 5 * np.sin(t / 10), 0) for t in range(200)])
    noise = rng.normal(0, 0.2, points.shape)
    lines = find_lines(points + noise, edges, NONE)
    assert len(lines.inner) == 198
    left = (noise[:, lines.inner] + smoothing_of(points + noise, lines, 1.0))[1:]
    assert np.sqrt(np.mean(left**2)) < 0.65 * 0.2


@pytest.mark.parametrize("strength", [0.0, 0.01])
def test_strength_bounds_the_motion(strength, rng):
    points, edges = chain(circle(60), closed=True)
    points = points + rng.normal(0, 0.2, points.shape)
    lines = find_lines(points, edges, NONE)
    motion = smoothing_of(points, lines, strength)
    assert lengths(motion.T).max() <= LARGEST_MOTION * strength * line_noise(points, lines) * (1 + 1e-12)


@pytest.mark.parametrize("preset", METHODS)
def test_straight_edges_of_a_clean_box_do_not_move(preset):
    mesh, edges = box(8)
    result = denoise(mesh, PRESETS[preset].settings, region=Region(feature_edges=edges))
    on_line = np.unique(edges)
    assert_same_bits(result.vertices[on_line], mesh.vertices[on_line])
    assert result.report.line_vertices == len(on_line)


@pytest.mark.parametrize("preset", METHODS)
def test_a_noisy_ridge_stays_sharp_and_gets_straight(preset, rng):
    clean, ridge = roof()
    mesh = clean.with_vertices(clean.vertices + rng.normal(0, 0.15, clean.vertices.shape))
    settings = PRESETS[preset].settings
    inner = np.unique(ridge)[5:-5]
    error = {}
    for name, region in (("free", None), ("kept", Region(feature_edges=ridge))):
        result = denoise(mesh, settings, region=region).vertices
        error[name] = result[inner] - clean.vertices[inner]
    before = (mesh.vertices - clean.vertices)[inner]
    across = {name: np.sqrt(np.mean(moved[:, 1:] ** 2)) for name, moved in error.items()}
    assert across["kept"] < 0.7 * np.sqrt(np.mean(before[:, 1:] ** 2))
    # Sharp: the ridge is where it was, while smoothing of positions rounds it off.
    assert abs(error["kept"][:, 2].mean()) < 0.05
    if preset in ("TRI_2", "BILATERAL"):
        assert error["free"][:, 2].mean() < -0.1


@pytest.mark.parametrize("preset", METHODS)
def test_nothing_to_remove_leaves_lines_alone(preset, rng):
    mesh, edges = box(6)
    mesh = noisy(mesh, rng, 0.1)
    settings = preset_settings(preset, lambda_=0.0, strength=0.0)
    if settings.method in ("POSITIONS", "AUTO"):
        result = denoise(mesh, settings, region=Region(feature_edges=edges)).vertices
        assert_same_bits(result, mesh.vertices)


def test_rotation_of_lines(rng):
    mesh, edges = box(6)
    mesh = noisy(mesh, rng, 0.1)
    rotation = random_rotation(rng)
    region = Region(feature_edges=edges)
    settings = PRESETS["TRI_2"].settings
    plain = denoise(mesh, settings, region=region, dtype=np.float64).vertices
    turned = denoise(
        mesh.with_vertices(mesh.vertices @ rotation), settings, region=region, dtype=np.float64
    ).vertices
    assert np.abs(turned - plain @ rotation).max() < 1e-9


def test_movable_and_border_come_first(rng):
    """Vertices of lines that are not selected, or on a fixed border, stay."""
    mesh, ridge = roof()
    mesh = noisy(mesh, rng, 0.1)
    movable = mesh.vertices[:, 0] > 20
    settings = PRESETS["TRI_2"].settings.with_changes(boundary="FIXED")
    result = denoise(mesh, settings, movable=movable, region=Region(feature_edges=ridge)).vertices
    assert_same_bits(result[~movable], mesh.vertices[~movable])
    end = ridge[-1, 1]
    assert_same_bits(result[end : end + 1], mesh.vertices[end : end + 1])
    inner = [k for k in np.unique(ridge) if movable[k] and k != end]
    assert (result[inner] != mesh.vertices[inner]).any(axis=1).all()


def test_a_closed_line_of_three_edges_is_no_problem(rng):
    mesh = noisy(triangle_torus(), rng)
    face = mesh.corner_vertex[:3]
    edges = np.stack((face, np.roll(face, 1)), axis=1)
    assert np.isfinite(denoise(mesh, region=Region(feature_edges=edges)).vertices).all()


def test_edges_of_a_vertex_with_itself_are_no_lines(rng):
    mesh = noisy(triangle_torus(), rng)
    settings = PRESETS["TRI_2"].settings
    result = denoise(mesh, settings, region=Region(feature_edges=np.array([[3, 3], [5, 5]])))
    assert_same_bits(result.vertices, denoise(mesh, settings).vertices)
    assert result.report.line_vertices == 0


def test_lines_of_a_mesh_that_is_clean_already_stay_too(rng):
    """Its report says that nothing was done, and so it is, though the lines themselves are rough."""
    mesh, edges = box(16)
    at_end = np.isin(mesh.vertices, (0, 16)).sum(axis=1) == 2
    vertices = mesh.vertices.copy()
    vertices[at_end] += rng.normal(0, 0.05, (at_end.sum(), 3))
    mesh = mesh.with_vertices(vertices)
    result = denoise(mesh, PRESETS["AUTO"].settings, region=Region(feature_edges=edges))
    assert result.report.noise.is_clean
    assert_same_bits(result.vertices, mesh.vertices)
