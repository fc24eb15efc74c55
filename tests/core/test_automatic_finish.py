# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What may follow recipes: further passes, and which of them is chosen."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import PRESETS, compare, connect
from framelet.core.automatic import choose
from framelet.core.automatic import problem as problem_module
from framelet.core.automatic import run_choice as run_choice_module
from framelet.core.automatic.finish import BROAD, FINE, FINISHES, N_PASSES, Finish
from framelet.core.automatic.problem import NormalProblem
from framelet.core.automatic.recipes import RECIPES
from framelet.core.automatic.rehearsal import Rehearsal
from framelet.core.automatic.run_choice import Choice, finished, run_choice
from framelet.core.automatic.score import risk_of
from framelet.core.automatic.trial import Trial
from framelet.core.denoising.constraints import find_constraints
from kinds import ALONE, KIND, KINDS
from meshes import noisy, triangle_grid, triangle_torus
from twins import newell

AUTO = PRESETS["AUTO"].settings
LOW_PASS = next(recipe for recipe in RECIPES if recipe.is_low_pass)


def problem_of(mesh, sigma=0.1):
    return NormalProblem(mesh.vertices.T.copy(), mesh, connect(mesh), sigma, ALONE)


def free(mesh, movable=None):
    movable = np.ones(mesh.n_vertices, bool) if movable is None else movable
    return find_constraints(mesh, connect(mesh), AUTO, movable, np.dtype(float))


@KIND
def test_normals_at_vertices_are_sums_of_areas(kind, rng):
    mesh = noisy(KINDS[kind](), rng)
    expected = np.zeros((mesh.n_vertices, 3))
    for start, stop in zip(mesh.face_offset[:-1], mesh.face_offset[1:], strict=True):
        face = mesh.corner_vertex[start:stop]
        for v in face.tolist():
            expected[v] += newell(mesh.vertices[face])
    length = np.linalg.norm(expected, axis=1, keepdims=True)
    expected = np.divide(expected, length, out=np.zeros_like(expected), where=length > 1e-12)
    assert np.abs(problem_of(mesh).vertex_normals(mesh.vertices.T) - expected.T).max() < 1e-9


def test_ways_to_finish_share_their_passes(rng, monkeypatch):
    """Each is what it would be alone, and halves are halves."""
    mesh = noisy(triangle_torus(8, 10), rng)
    points, made, passes = mesh.vertices.T.copy(), [], []
    again = NormalProblem.pass_again
    monkeypatch.setattr(NormalProblem, "pass_again", lambda *given: passes.append(given[2]) or again(*given))
    problem = problem_of(mesh)
    together = list(finished(problem, points, FINISHES, after_pass=lambda: made.append(0)))
    assert passes == [BROAD, FINE, FINE] and len(made) == len(passes) == N_PASSES
    results = dict(zip(FINISHES, together, strict=True))
    for finish, result in results.items():
        (alone,) = finished(problem_of(mesh), points, [finish])
        assert np.abs(result - alone).max() < 1e-12
    assert_same_bits(results[Finish()], points)
    whole, half = (results[Finish("refined" if s == 1 else "half refined", (BROAD,), s)] for s in (1.0, 0.5))
    assert np.abs(half - 0.5 * (points + whole)).max() < 1e-12
    assert len({result.tobytes() for finish, result in results.items() if finish.passes}) == sum(
        len(finish.passes) > 0 for finish in FINISHES
    )


def test_ways_to_finish_have_names_of_their_own():
    labels = [finish.label for finish in FINISHES]
    assert len(set(labels)) == len(labels) and labels[0] == "" and FINISHES[0] == Finish()
    assert {finish.passes for finish in FINISHES} == {(), (BROAD,), (FINE,), (BROAD, FINE)}
    assert {finish.held for finish in FINISHES if finish.is_quick} == {0.0, 0.5, 1.0}
    assert Choice(RECIPES[:1]).label == RECIPES[0].label
    chosen = Choice(RECIPES[:2], Finish("in place", held=1.0))
    assert chosen.label == f"{RECIPES[0].label} and {RECIPES[1].label} (in place)"


@KIND
@pytest.mark.parametrize("boundary", ["FREE", "ALONG", "FIXED"])
def test_finished_runs_of_every_kind_of_mesh(kind, boundary, rng):
    """Vertices that may not move stay, and every number is one."""
    mesh = noisy(KINDS[kind](), rng, 0.05)
    movable = rng.random(mesh.n_vertices) < 0.7
    connectivity = connect(mesh)
    held = find_constraints(
        mesh, connectivity, AUTO.with_changes(boundary=boundary), movable, np.dtype(np.float32)
    )
    still = ~movable | (connectivity.is_boundary if boundary == "FIXED" else False)
    points = mesh.vertices.T.astype(np.float32)
    for finish in (FINISHES[2], FINISHES[7], FINISHES[-1]):
        problem = NormalProblem(points.copy(), mesh, connectivity, 0.1, ALONE)
        found = run_choice(problem, Choice((LOW_PASS, RECIPES[0]), finish), held)
        assert found.dtype == np.float32 and np.isfinite(found).all()
        assert_same_bits(found[:, still], points[:, still])


@pytest.mark.parametrize("finish", FINISHES, ids=lambda finish: finish.label or "plain")
def test_a_finished_run_moves_what_it_may(finish, rng):
    mesh = noisy(triangle_torus(8, 10), rng, 0.05)
    movable = rng.random(mesh.n_vertices) < 0.7
    for recipes in (RECIPES[:1], (LOW_PASS, RECIPES[0])):
        found = run_choice(problem_of(mesh), Choice(recipes, finish), free(mesh, movable))
        assert_same_bits(found[:, ~movable], mesh.vertices.T[:, ~movable])
        assert (found != mesh.vertices.T).any()


@KIND
def test_runs_that_save_memory_give_the_same(kind, rng, monkeypatch):
    """Large meshes keep less for later, and make it again."""
    mesh = noisy(KINDS[kind](), rng, 0.05)
    choices = [Choice(RECIPES[:1]), Choice(RECIPES[:1], FINISHES[2]), Choice(RECIPES[3:4], FINISHES[-1])]
    plain = [run_choice(problem_of(mesh), choice, free(mesh)) for choice in choices]
    for module in (problem_module, run_choice_module):
        monkeypatch.setattr(module, "MANY_ITEMS", 0)
    for choice, expected in zip(choices, plain, strict=True):
        problem = problem_of(mesh)
        assert_same_bits(run_choice(problem, choice, free(mesh)), expected)
        assert problem.is_frugal


def test_a_further_pass_brings_a_ridge_nearer(rng):
    """From a pilot with the right planes, and with noise that it has to see through."""
    grid = triangle_grid(24, 24)
    folded = grid.vertices.copy()
    over = folded[:, 0] > 12
    folded[over, 2] = folded[over, 0] - 12  # a ridge: two planes at 135 degrees
    clean = grid.with_vertices(folded)
    mesh = noisy(clean, rng, 0.1)
    problem = problem_of(mesh)
    first = problem.run(RECIPES[0], is_unfolded=False)
    rough = first + 0.02 * rng.normal(size=first.shape)
    better = problem.pass_again(rough, FINE)
    angles = [compare(clean.with_vertices(x.T), clean).mean_angle for x in (rough, better)]
    assert angles[1] < 0.5 * angles[0]


@pytest.mark.parametrize("wanted", [0, 2, len(FINISHES) - 1])
def test_the_rehearsal_decides_how_to_finish(wanted, rng, monkeypatch):
    mesh = noisy(triangle_torus(10, 12), rng)
    angles = np.full(len(FINISHES), 1e9)
    angles[[finish.passed == FINISHES[wanted].passed for finish in FINISHES]] = 1.0
    angles[wanted] = 1e-2
    monkeypatch.setattr(Rehearsal, "angles_finished", lambda *_: angles)
    found = choose.choose_recipes(mesh.vertices.T.copy(), mesh, 0.1, ALONE)
    assert found.finish == FINISHES[wanted]


def test_angles_of_finished_rehearsals_begin_with_the_plain_one(rng):
    mesh = noisy(triangle_torus(8, 10), rng, 0.05)
    tried = Trial(mesh.vertices.T.copy(), mesh, 0.1, RECIPES[:2], ALONE)
    rehearsal = Rehearsal(tried, mesh.vertices.T.copy(), is_impulsive=False)
    rehearsal.run([0, 1], lambda: None)
    ticks = []
    angles = rehearsal.angles_finished((0, 1), FINISHES, lambda: ticks.append(0))
    assert angles[0] == pytest.approx(rehearsal.angle((0, 1)), rel=1e-9)
    assert len(ticks) == N_PASSES * tried.n_draws and len(set(angles.tolist())) == len(FINISHES)


def test_what_follows_probes_is_kept_for_them(rng):
    """The divergence of what is not finished at all is that of the recipe."""
    mesh = noisy(triangle_torus(8, 10), rng, 0.05)
    tried = Trial(mesh.vertices.T.copy(), mesh, 0.1, RECIPES[:2], ALONE)
    tried.run(lambda: None)
    found = tried.divergences(np.arange(2), lambda: None)
    assert len(tried.probes) == tried.n_probes
    for index in range(2):
        seen = [tried.follows(probe, probe.results[index], tried.results[index]) for probe in tried.probes]
        assert np.mean(seen) == pytest.approx(found[index], rel=1e-9)


def test_the_risk_is_that_of_stein():
    height = np.array([1.0, -2.0, 0.0])
    assert risk_of(height, 0.25) == pytest.approx(5 / 3 - 1 + 0.5)
    assert risk_of(np.zeros(3), 1.0) == 1.0  # what moves nothing keeps the noise
