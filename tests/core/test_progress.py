# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run tells while it works, how it is stopped, and what it reports."""

import threading

import numpy as np
import pytest
from checks import TRIANGLE_PRESETS, edge_length, lengths, preset_settings
from framelet.core import PRESETS, connect, denoise
from meshes import (
    MESHES,
    faces_of,
    flipped,
    klein_bottle,
    mixed_sheet,
    noisy,
    triangle_grid,
    triangle_torus,
    turned_over,
)
from twins import signed_volume

PRESET = pytest.mark.parametrize("preset", TRIANGLE_PRESETS)


def settings_of(preset, **changes):
    return preset_settings(preset, **changes)


@PRESET
def test_fractions_rise_to_one(preset, rng):
    mesh = noisy(mixed_sheet(), rng)
    seen = []
    denoise(mesh, settings_of(preset, iterations=6), callback=lambda *given: bool(seen.append(given)))
    fractions = [fraction for fraction, _ in seen]
    assert len(fractions) >= 5
    assert fractions[0] > 0
    assert fractions == sorted(set(fractions))
    assert fractions[-1] == 1.0
    assert all(isinstance(change, float) and change > 0 for _, change in seen)


@PRESET
@pytest.mark.parametrize(
    "limits", [{}, {"boundary": "FIXED"}, {"boundary": "ALONG"}, {"boundary": "FREE"}, {"some": True}]
)
def test_reported_change_is_the_motion_of_the_iteration(preset, limits, rng):
    """Also where vertices are held: what is pulled but does not move must not count."""
    mesh = noisy(triangle_grid(), rng)
    movable = np.arange(mesh.n_vertices) % 4 == 0 if "some" in limits else None
    changes = {key: value for key, value in limits.items() if key != "some"}

    def solve(iterations, callback=None):
        settings = settings_of(preset, iterations=iterations, **changes)
        return denoise(mesh, settings, movable=movable, callback=callback, dtype=np.float64)

    seen = []
    last = solve(5, lambda _, change: bool(seen.append(change)))
    moved = last.vertices - solve(4).vertices
    rms = np.sqrt(np.mean(lengths(moved) ** 2)) / last.report.mean_edge_length
    assert seen[-1] == pytest.approx(rms, rel=1e-6)


@PRESET
def test_tolerance_is_met_where_most_vertices_are_held(preset, rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    movable = np.arange(mesh.n_vertices) == 5
    report = denoise(mesh, settings_of(preset, iterations=400, tolerance=1e-5), movable=movable).report
    assert report.iterations < 400


@PRESET
def test_tolerance_stops_early(preset, rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    full = denoise(mesh, settings_of(preset, iterations=40)).report
    seen = []
    early = denoise(
        mesh,
        settings_of(preset, iterations=40, tolerance=0.02),
        callback=lambda *given: bool(seen.append(given)),
    ).report
    assert full.iterations == 40
    assert early.iterations < 40
    assert not early.is_stopped
    assert seen[-1][1] < 0.02 <= min(change for _, change in seen[:-1])


@PRESET
def test_true_stops_and_gives_what_was_reached(preset, rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    calls = []
    stopped = denoise(
        mesh,
        settings_of(preset, iterations=9),
        callback=lambda *given: len(calls.append(given) or calls) == 3,
    )
    assert len(calls) == 3
    assert stopped.report.is_stopped
    assert stopped.report.iterations < 9
    same = denoise(mesh, settings_of(preset, iterations=stopped.report.iterations))
    assert not same.report.is_stopped
    assert np.array_equal(stopped.vertices, same.vertices)


@PRESET
def test_an_error_of_the_callback_comes_out_and_no_thread_stays(preset, rng):
    mesh = noisy(triangle_torus(), rng)
    before = threading.active_count()

    def callback(fraction, change):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        denoise(mesh, settings_of(preset, threads=3), callback=callback)
    assert threading.active_count() == before


@PRESET
def test_report_counts(preset, rng):
    mesh = noisy(mixed_sheet(), rng)
    result = denoise(mesh, settings_of(preset))
    report = result.report
    moved = lengths(result.vertices - mesh.vertices)
    assert (report.n_vertices, report.n_faces) == (mesh.n_vertices, mesh.n_faces)
    assert report.n_moved == np.count_nonzero(moved)
    assert report.displacement_max == pytest.approx(moved.max())
    assert report.displacement_rms == pytest.approx(np.sqrt((moved**2).mean()))
    assert report.mean_edge_length == pytest.approx(edge_length(mesh))
    assert (report.boundary_vertices, report.non_manifold_vertices, report.loose_vertices) == (22, 0, 3)
    assert report.volume_change is None
    assert report.seconds > 0


def test_volume_change(rng):
    mesh = noisy(flipped(triangle_torus()), rng)
    result = denoise(mesh, PRESETS["TRI_2"].settings)
    before, after = signed_volume(mesh), signed_volume(mesh.with_vertices(result.vertices))
    assert result.report.volume_change == pytest.approx((after - before) / before)
    assert abs(after) < abs(before)


def test_volume_change_of_an_inside_out_surface_has_the_same_sign(rng):
    """A loss is a loss, whichever way the normals point."""
    mesh = noisy(flipped(triangle_torus()), rng)
    inside_out = mesh.with_vertices(mesh.vertices * [1, 1, -1])
    settings = PRESETS["TRI_2"].settings
    change = denoise(mesh, settings).report.volume_change
    assert denoise(inside_out, settings).report.volume_change == pytest.approx(change, rel=1e-3)


def test_the_volume_is_that_of_faces_that_agree():
    mesh = noisy(MESHES["irregular torus"](), np.random.default_rng(0))
    settings = PRESETS["TRI_2"].settings
    change = denoise(mesh, settings).report.volume_change
    turned = denoise(turned_over(mesh, seed=4), settings)
    assert turned.report.volume_change == pytest.approx(change, rel=1e-3)


def test_no_volume_change_is_claimed_of_a_surface_of_one_side():
    bottle = klein_bottle()
    assert (connect(bottle).edge_face_count == 2).all()
    assert denoise(bottle, PRESETS["QUAD_2"].settings).report.volume_change is None


def test_flipped_faces_are_counted():
    """A spike folded over itself is pulled back, which turns its faces around."""
    mesh = triangle_grid(9, 9)
    vertices = mesh.vertices.copy()
    vertices[40] += [1.6, 0.3, 0.0]
    result = denoise(mesh.with_vertices(vertices), settings_of("TRI_2", lambda_=3.0, iterations=60))
    turned = 0
    for face in faces_of(mesh):
        before, after = (np.cross(p[1] - p[0], p[2] - p[0]) for p in (vertices[face], result.vertices[face]))
        turned += before @ after < 0
    assert result.report.flipped_faces == turned >= 1
