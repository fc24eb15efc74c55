# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of recipes on one mesh: their progress, what they share, and where nothing can be tried."""

from itertools import combinations

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import PRESETS, SurfaceMesh, connect, denoise
from framelet.core.automatic import choose, patches
from framelet.core.automatic import filter as engine
from framelet.core.automatic.finish import FINISHES, Finish
from framelet.core.automatic.problem import NormalProblem
from framelet.core.automatic.recipes import RECIPES
from framelet.core.automatic.rehearsal import Rehearsal
from framelet.core.automatic.run_choice import Choice, n_ticks, run_choice
from framelet.core.automatic.trial import Trial
from framelet.core.blocks import Blocks
from framelet.core.denoising.constraints import find_constraints
from framelet.core.surface.geometry import vertex_normals
from kinds import ALONE, KIND, KINDS
from meshes import noisy, triangle_grid, triangle_torus

AUTO = PRESETS["AUTO"].settings
PAIRS = list(combinations(RECIPES, 2))
SHARED = [
    pair
    for pair in PAIRS
    if pair[0].n_averages == pair[1].n_averages and pair[0].threshold == pair[1].threshold
]
"""Pairs of recipes with one pilot; where there is none it is the rest that is shared."""


def problem_of(mesh, dtype=float):
    return NormalProblem(mesh.vertices.T.astype(dtype), mesh, connect(mesh), 0.1, ALONE)


def free(mesh, movable=None, dtype=float):
    movable = np.ones(mesh.n_vertices, bool) if movable is None else movable
    return find_constraints(mesh, connect(mesh), AUTO, movable, np.dtype(dtype))


CHOICES = [
    *(Choice((recipe,)) for recipe in RECIPES),
    *map(Choice, [*SHARED, *PAIRS[::17]]),
    *(Choice(recipes, finish) for recipes in (RECIPES[:1], RECIPES[-2:]) for finish in FINISHES),
]


@pytest.mark.parametrize("choice", CHOICES, ids=lambda choice: choice.label)
def test_ticks_are_counted_before_the_run(choice, rng):
    mesh, ticks = noisy(triangle_torus(4, 5), rng), []
    run_choice(problem_of(mesh), choice, free(mesh), ticks.append)
    assert len(ticks) == n_ticks(choice) and min(ticks) >= 0


def test_some_pairs_share_a_pilot():
    assert any(first.range_sigmas and second.range_sigmas for first, second in SHARED)


@pytest.mark.parametrize("recipes", [SHARED[0], (RECIPES[-1],), (RECIPES[0], RECIPES[-1])])
@pytest.mark.parametrize("finish", [Finish(), FINISHES[-1]])
def test_progress_ends_at_one_whatever_is_chosen(recipes, finish, rng, monkeypatch):
    seen = []
    monkeypatch.setattr(
        engine, "choose_recipes", lambda *given, **_: given[-1](1.0) or Choice(recipes, finish)
    )
    result = denoise(noisy(triangle_torus(), rng), AUTO, callback=lambda *given: bool(seen.append(given)))
    fractions = [fraction for fraction, _ in seen]
    words = f" ({finish.label})" if finish.label else ""
    assert result.report.recipe == " and ".join(recipe.label for recipe in recipes) + words
    assert fractions == sorted(fractions) and fractions[-1] == pytest.approx(1.0, abs=1e-9)


def test_the_mean_of_two_runs(rng):
    """Which of them runs first does not matter, nor what else was run on the problem."""
    mesh = noisy(triangle_torus(6, 8), rng)
    movable = rng.random(mesh.n_vertices) < 0.5
    for pair in (*SHARED, PAIRS[0], PAIRS[-1]):
        found = run_choice(problem_of(mesh), Choice(pair), free(mesh, movable))
        again = run_choice(problem_of(mesh), Choice(pair[::-1]), free(mesh, movable))
        assert_same_bits(found[:, ~movable], mesh.vertices.T[:, ~movable])
        assert np.abs(found - again).max() < 1e-12


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.label)
def test_runs_leave_what_others_start_from_alone(recipe, rng):
    mesh = noisy(triangle_torus(6, 8), rng)
    problem = problem_of(mesh)
    start = problem.start(recipe.n_averages)
    given = [x.copy() for x in (problem.noisy, start.points, start.normals, start.sample)]
    first = problem.run(recipe, free(mesh, rng.random(mesh.n_vertices) < 0.5)).copy()
    for before, after in zip(given, (problem.noisy, start.points, start.normals, start.sample), strict=True):
        assert_same_bits(before, after)
    assert (problem.run(recipe, free(mesh)) != first).any()


@KIND
@pytest.mark.parametrize(("sigma", "dtype"), [(1e-3, np.float64), (0.3, np.float32), (30.0, np.float32)])
def test_every_kind_of_mesh_gets_a_recipe(kind, sigma, dtype, rng):
    """Also where the noise is far stronger or weaker than any that is measured."""
    mesh, ticks = noisy(KINDS[kind](), rng), []
    points = mesh.vertices.T.astype(dtype)
    given = points.copy()
    choice = choose.choose_recipes(points, mesh, sigma, ALONE, ticks.append)
    assert 1 <= len(choice.recipes) <= 2 and set(choice.recipes) <= set(RECIPES)
    assert choice.finish in FINISHES
    assert sum(ticks) == pytest.approx(1.0, abs=1e-9)
    assert_same_bits(points, given)
    problem = NormalProblem(points, mesh, connect(mesh), sigma, ALONE)
    found = run_choice(problem, choice, free(mesh, dtype=dtype))
    assert found.dtype == dtype and np.isfinite(found).all()


def test_the_choice_does_not_depend_on_threads(rng, monkeypatch):
    """On a whole small mesh, and on patches, where low-passes and the rehearsed surface are on threads."""
    mesh = noisy(triangle_torus(20, 24), rng)
    points = mesh.vertices.T.astype(np.float32)
    for whole in (patches.WHOLE, 100):
        monkeypatch.setattr(patches, "WHOLE", whole)
        monkeypatch.setattr(patches, "FACES_IN_PATCH", 60)
        with Blocks(2, 100) as several:
            chosen = [choose.choose_recipes(points, mesh, 0.1, blocks) for blocks in (ALONE, several)]
        assert chosen[0] == chosen[1]


@pytest.mark.parametrize("wanted", [0, 5])
def test_the_rehearsal_has_the_last_word(wanted, rng, monkeypatch):
    """Where risks and roughness are alike, the smallest angle wins; angles of 0 leave the choice to them."""
    mesh = noisy(triangle_torus(10, 12), rng)
    points = mesh.vertices.T.copy()
    monkeypatch.setattr(choose, "HOPELESS", 1e9)
    monkeypatch.setattr(choose, "N_PAIRED", len(RECIPES))
    monkeypatch.setattr(Rehearsal, "angle", lambda _, choice: 1e-2 if choice == (wanted,) else 1e6)
    assert choose.choose_recipes(points, mesh, 0.1, ALONE).recipes == (RECIPES[wanted],)
    monkeypatch.setattr(Rehearsal, "angle", lambda *_: 0.0)
    level = choose.choose_recipes(points, mesh, 0.1, ALONE)
    monkeypatch.setattr(Rehearsal, "angle", lambda *_: 7.0)
    assert choose.choose_recipes(points, mesh, 0.1, ALONE) == level


def test_hopeless_recipes_are_not_run_again(rng, monkeypatch):
    """Those that move vertices much farther than the noise did, or than most recipes do."""
    mesh = noisy(triangle_torus(10, 12), rng)
    points, probed = mesh.vertices.T.copy(), []
    divergences = Trial.divergences

    def spy(trial, wanted, tick):
        spread = np.mean(trial.heights**2, axis=1)
        assert np.array_equal(wanted, np.flatnonzero(spread <= 1.5 * max(1.0, np.median(spread))))
        probed.append(len(wanted))
        return divergences(trial, wanted, tick)

    monkeypatch.setattr(Trial, "divergences", spy)
    # Measured far too weak, all move vertices too far, and most are tried all the same.
    for sigma in (0.1, 0.001):
        choose.choose_recipes(points, mesh, sigma, ALONE)
    assert len(RECIPES) / 2 <= min(probed) and max(probed) <= len(RECIPES)


def test_pairs_for_the_first_choice_are_good_alone(rng, monkeypatch):
    mesh, seen = noisy(triangle_torus(10, 12), rng), []
    first = Trial.ground_mean_of
    monkeypatch.setattr(Trial, "ground_mean_of", lambda *given: seen.append(given[1]) or first(*given))
    monkeypatch.setattr(choose, "NEARLY_BEST", 1.0)
    choose.choose_recipes(mesh.vertices.T.copy(), mesh, 0.1, ALONE)
    assert [len(choice) for choice in seen] == [1]


@pytest.mark.parametrize(("factor", "strength"), [(0.4, 1.0), (1.0, 1.5), (2.0, 1.0)])
def test_impulsive_noise_is_measured_by_what_recipes_take_away(factor, strength, rng):
    """Where it was measured too weak or too strong; other noise is taken as it is given."""
    mesh = triangle_torus(24, 30)
    points = mesh.vertices.T.copy()
    truth = 0.2 * np.sqrt(0.5)
    amount = 0.2 * rng.normal(size=mesh.n_vertices) * (rng.random(mesh.n_vertices) < 0.5)
    spoiled = points + amount * vertex_normals(mesh).T
    given = factor * strength * truth
    choice = choose.choose_recipes(spoiled, mesh, given, ALONE, strength=strength, is_impulsive=True)
    assert (choice.sigma or given) / truth / strength == pytest.approx(1.0, abs=0.25)
    assert choose.choose_recipes(spoiled, mesh, given, ALONE, strength=strength).sigma is None


def test_recipes_that_move_nothing_do_not_measure_the_noise_as_nothing():
    """All vertices of a flat sheet lie where every recipe would have them."""
    mesh = triangle_grid(6, 6)
    choice = choose.choose_recipes(mesh.vertices.T.copy(), mesh, 0.1, ALONE, is_impulsive=True)
    assert choice.sigma == pytest.approx(0.1 / choose.LARGEST_CORRECTION**choose.MEASURINGS)
    problem = NormalProblem(mesh.vertices.T.copy(), mesh, connect(mesh), choice.sigma, ALONE)
    assert np.isfinite(run_choice(problem, choice, free(mesh))).all()


def test_the_run_reckons_with_the_noise_that_was_found(rng, monkeypatch):
    mesh, seen = noisy(triangle_torus(), rng), []
    begin = NormalProblem.__init__
    monkeypatch.setattr(
        NormalProblem, "__init__", lambda self, *given: seen.append(given[3]) or begin(self, *given)
    )
    monkeypatch.setattr(engine, "choose_recipes", lambda *_, **__: Choice(RECIPES[-1:], sigma=0.123))
    denoise(mesh, AUTO)
    assert seen == [0.123]


def test_whether_noise_is_impulsive_is_passed_on(rng, monkeypatch):
    mesh, seen = triangle_torus(30, 40), []
    is_hit = rng.random(mesh.n_vertices) < 0.5
    far = noisy(mesh, rng, 0.2).vertices
    spiky = mesh.with_vertices(np.where(is_hit[:, None], far, mesh.vertices))
    monkeypatch.setattr(
        engine, "choose_recipes", lambda *_, **named: seen.append(named) or Choice(RECIPES[:1])
    )
    report = denoise(spiky, AUTO).report
    assert [named["is_impulsive"] for named in seen] == [report.noise.is_impulsive] == [True]


def test_where_no_face_has_an_area_there_is_nothing_to_try():
    mesh, ticks = SurfaceMesh.from_faces(np.arange(12.0).reshape(4, 3), [(0, 1, 2), (1, 2, 3)]), []
    choice = choose.choose_recipes(mesh.vertices.T.copy(), mesh, 0.1, ALONE, ticks.append)
    assert choice == Choice(RECIPES[:1]) and ticks == [1.0]


def test_large_meshes_take_one_quick_recipe(rng, monkeypatch):
    mesh, seen = noisy(triangle_torus(), rng), []
    begin = Trial.__init__
    monkeypatch.setattr(Trial, "__init__", lambda *given: seen.append(given[4]) or begin(*given))
    monkeypatch.setattr(choose, "PAIRED_UP_TO", mesh.n_faces - 1)
    choice = choose.choose_recipes(mesh.vertices.T.copy(), mesh, 0.1, ALONE)
    assert len(choice.recipes) == 1 and choice.finish.is_quick
    assert seen == [[recipe for recipe in RECIPES if not recipe.n_rounds and not recipe.is_refined]]
    assert len(seen[0]) < len(RECIPES)
