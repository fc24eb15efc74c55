# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Trials of recipes and their rehearsal on a surface that is known."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import SurfaceMesh, connect
from framelet.core.automatic import patches, trial
from framelet.core.automatic.problem import NormalProblem
from framelet.core.automatic.recipes import RECIPES
from framelet.core.automatic.rehearsal import Rehearsal
from framelet.core.automatic.trial import Trial
from framelet.core.surface.geometry import vertex_normals
from kinds import ALONE
from meshes import faces_of, noisy, triangle_torus
from twins import newell

QUICK = tuple(recipe for recipe in RECIPES if not recipe.range_sigmas)[:3]
"""Recipes that take little time."""


def trial_of(mesh, sigma=0.1, recipes=QUICK):
    return Trial(mesh.vertices.T.copy(), mesh, sigma, recipes, ALONE)


def rehearsal_of(tried, mesh, **given):
    return Rehearsal(tried, mesh.vertices.T.copy(), **({"is_impulsive": False} | given))


def nothing():
    """Take a tick."""


def test_heights_are_along_the_normals_in_units_of_the_noise(rng):
    mesh = noisy(triangle_torus(8, 10), rng)
    tried, ticks = trial_of(mesh, 0.2), []
    tried.run(lambda: ticks.append(0))
    assert len(ticks) == len(QUICK) and tried.counted.all() and not tried.is_empty
    for result, height in zip(tried.results, tried.heights, strict=True):
        expected = np.einsum("cn,cn->n", result - mesh.vertices.T, tried.directions) / 0.2
        assert np.abs(height - expected).max() < 1e-12
    assert_same_bits(tried.mean_of((1,)), tried.results[1])
    assert np.abs(tried.mean_of((0, 2)) - 0.5 * (tried.results[0] + tried.results[2])).max() < 1e-12


def test_the_divergence_of_a_low_pass_is_the_trace_of_its_matrix(rng):
    """Over vertices, of the part along the normals; seen by one draw of signs, so nearly."""
    mesh = noisy(triangle_torus(30, 40), rng, 0.05)
    tried = trial_of(mesh)
    tried.run(nothing)
    wanted, ticks = np.array([0, 2]), []
    found = tried.divergences(wanted, lambda: ticks.append(0))
    assert found[1] == 0 and len(ticks) == 2 * tried.n_probes
    rings = tried.problem.rings
    one = np.eye(mesh.n_vertices)
    average = 0.5 * one + 0.5 * rings.outward(rings.mean(rings.inward(one)))
    for index in wanted:
        power = np.linalg.matrix_power(average, QUICK[index].n_averages)
        low = one - np.linalg.matrix_power(one - power, 5)
        alike = tried.directions.T @ tried.directions
        assert found[index] == pytest.approx(np.mean(np.diag(low * alike)), abs=0.03)


def test_a_rehearsal_measures_angles_to_the_surface(rng):
    """Against a loop over the faces, for one recipe and for the mean of two."""
    mesh = noisy(triangle_torus(8, 10), rng, 0.05)
    tried = trial_of(mesh)
    rehearsal, ticks = rehearsal_of(tried, mesh), []
    rehearsal.run([0, 2], lambda: ticks.append(0))
    assert len(ticks) == 2 * tried.n_draws == 4  # a small mesh
    clean = [newell(mesh.vertices[face]) for face in faces_of(mesh)]
    for choice in ((0,), (2,), (0, 2)):
        angles = []
        for draw in range(tried.n_draws):
            points = np.mean([rehearsal._runs[draw][1][index] for index in choice], axis=0).T
            for face, normal in zip(faces_of(mesh), clean, strict=True):
                other = newell(points[face])
                cosine = normal @ other / np.linalg.norm(normal) / np.linalg.norm(other)
                angles.append(np.degrees(np.arccos(min(cosine, 1.0))))
        assert rehearsal.angle(choice) == pytest.approx(np.mean(angles), rel=1e-6)


@pytest.mark.parametrize("is_impulsive", [False, True])
def test_the_noise_of_a_rehearsal(is_impulsive, rng):
    """It has the measured strength along the normals, and each draw is another one."""
    mesh = noisy(triangle_torus(40, 50), rng, 0.1)
    tried = trial_of(mesh, 0.1)
    tried.n_draws = 2
    surface = triangle_torus(40, 50)
    rehearsal = Rehearsal(tried, surface.vertices.T.copy(), is_impulsive=is_impulsive)
    moved = [noisy_points - surface.vertices.T for noisy_points in rehearsal._noisy]
    heights = np.array([np.einsum("cn,nc->n", motion, vertex_normals(surface)) for motion in moved])
    # The normals of the vertices are weighted by areas here, and may differ a little.
    assert np.sqrt(np.mean(heights**2, axis=1)) == pytest.approx([0.1, 0.1], rel=0.08)
    assert np.abs(heights.mean(axis=1)).max() < 0.01
    assert abs(np.corrcoef(heights)[0, 1]) < 0.15
    assert np.mean(heights == 0, axis=1) == pytest.approx([0.5, 0.5] if is_impulsive else [0, 0], abs=0.05)
    kurtosis = np.mean(heights**4, axis=1) / np.mean(heights**2, axis=1) ** 2
    assert kurtosis == pytest.approx([5.2, 5.2] if is_impulsive else [2.6, 2.6], rel=0.2)  # of three digits


@pytest.mark.parametrize("is_wide", [True, False])
def test_low_passes_are_tried_on_the_whole_mesh(is_wide, rng, monkeypatch):
    """Where it is not too large: then neither they nor what they are told of the noise know of the rims."""
    mesh = noisy(triangle_torus(40, 50), rng, 0.05)
    monkeypatch.setattr(patches, "WHOLE", 100)
    monkeypatch.setattr(patches, "FACES_IN_PATCH", 60)
    monkeypatch.setattr(trial, "WIDE_UP_TO", mesh.n_faces - (not is_wide))
    tried = trial_of(mesh)
    part = patches.trial_part(mesh.vertices.T, mesh)
    assert tried.surface.n_faces < mesh.n_faces
    tried.run(nothing)
    whole = NormalProblem(mesh.vertices.T.copy(), mesh, connect(mesh), 0.1, ALONE)
    for recipe, result in zip(QUICK, tried.results, strict=True):
        expected = whole.run(recipe, is_unfolded=False)[:, part.vertices]
        assert (np.abs(result - expected).max() < 1e-12) == is_wide
    assert (tried.ground.surface is mesh) == is_wide
    assert (len(tried.ground.noisy.T) == mesh.n_vertices) == is_wide
    found = tried.divergences(np.arange(3), nothing)
    rehearsal = Rehearsal(tried, tried.ground_mean_of((2,)), is_impulsive=False)
    rehearsal.run([2], nothing)
    assert np.isfinite(found).all() and 0 < rehearsal.angle((2,)) < 90
    if is_wide:
        assert np.abs(tried.ground_mean_of((0, 2))[:, part.vertices] - tried.mean_of((0, 2))).max() < 1e-12


def test_only_faces_whose_vertices_all_count_are_looked_at(rng, monkeypatch):
    monkeypatch.setattr(patches, "WHOLE", 100)
    monkeypatch.setattr(patches, "FACES_IN_PATCH", 60)
    mesh = noisy(triangle_torus(40, 50), rng, 0.05)
    tried = trial_of(mesh)
    assert tried.surface.n_faces < mesh.n_faces and not tried.counted.all()
    rehearsal = Rehearsal(tried, tried.ground.noisy, is_impulsive=False)
    expected = [f for f, face in enumerate(faces_of(tried.surface)) if tried.counted[face].all()]
    assert rehearsal._faces.tolist() == expected and 0 < len(expected) < tried.surface.n_faces


def test_small_meshes_get_more_probes_and_draws():
    for size, probes, draws in (((4, 5), 2, 2), ((30, 40), 2, 2), ((60, 70), 1, 1)):
        tried = trial_of(triangle_torus(*size))
        assert (tried.n_probes, tried.n_draws) == (probes, draws)
    assert trial.N_PROBES[1] == trial.N_DRAWS[1]


def test_a_mesh_without_area_cannot_be_tried():
    mesh = SurfaceMesh.from_faces(np.arange(12.0).reshape(4, 3), [(0, 1, 2), (1, 2, 3)])
    assert trial_of(mesh).is_empty
