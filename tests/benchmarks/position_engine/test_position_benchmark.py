# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The prototypes of the benchmark of the position engine do what they say, and a quick run has its tables."""

import csv
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from framelet.core import Region, add_noise, connect, denoise, make_transform
from meshes import triangle_torus

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

import position_sources  # noqa: E402, F401
from cases import CaseName, load_case  # noqa: E402
from rounds import Problem, Shrinkage, denoised, norms, taken_away  # noqa: E402
from trials import Trial, Trials  # noqa: E402
from variants import ADAPTIVE, BY_NAME, PLAIN, VARIANTS, Variant  # noqa: E402

GIVEN = [variant for variant in VARIANTS if variant.is_plain and variant.changes.get("tuning") != "NOISE"]


def problem_of(kind):
    """Return a small noisy cube of quads or of triangles."""
    case = load_case(CaseName(f"made/small_cube_{kind}", "normal 0.3", 0))
    return Problem(case.noisy, case.model.connectivity)


def run_with(problem, variant, lambda_, is_quad=False):
    """Return denoised positions in mean edge lengths."""
    settings = variant.settings(is_quad).with_changes(lambda_=lambda_)
    return denoised(problem, variant, settings) / problem.prepared(settings).edge


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("variant", GIVEN, ids=lambda variant: variant.name)
def test_the_plain_engine_is_that_of_the_package(variant, kind):
    problem, is_quad = problem_of(kind), kind == "quad"
    settings = variant.settings(is_quad).with_changes(lambda_=0.4)
    expected = denoise(problem.noisy, settings, region=Region(repair_folds=False)).vertices
    edge = problem.prepared(settings).edge
    assert np.abs(expected - problem.noisy.vertices).max() > 0.2 * edge
    np.testing.assert_allclose(denoised(problem, variant, settings) / edge, expected / edge, atol=1e-5)


@pytest.mark.parametrize("name", ["2 levels", "3 levels"])
def test_levels_without_threshold_do_nothing(name):
    # Not so with Adaptive, whose adjoint depends on the measure that all levels pull back.
    problem, levels = problem_of("tri"), BY_NAME[name]
    one = Variant("", {**levels.changes, "levels": 1})
    falling = run_with(problem, levels._replace(decay=1e-7), 0.4)
    np.testing.assert_allclose(falling, run_with(problem, one, 0.4), atol=1e-4)
    assert np.abs(falling - run_with(problem, levels, 0.4)).max() > 0.1


def test_firm_shrinkage_against_a_loop():
    lengths = np.concatenate((np.linspace(0.0, 3.0, 301), [1e6]))
    for firm in (2.0, 4.0):
        for length, taken in zip(lengths, taken_away(lengths, 0.5, firm), strict=True):
            kept = 0.0
            if length >= 0.5 * firm:
                kept = length
            elif length > 0.5:
                kept = firm / (firm - 1.0) * (length - 0.5)
            assert length - taken == pytest.approx(kept, abs=1e-9)
    np.testing.assert_allclose(
        taken_away(lengths[:-1], 0.5, 1e9), taken_away(lengths[:-1], 0.5, 0.0), atol=1e-6
    )


def test_firm_with_a_wide_ramp_is_soft():
    problem = problem_of("tri")
    soft, wide, narrow = (run_with(problem, PLAIN._replace(firm=firm), 0.4) for firm in (0.0, 1e6, 2.0))
    np.testing.assert_allclose(wide, soft, atol=1e-4)
    assert np.abs(narrow - soft).max() > 0.05


@pytest.mark.parametrize("kind", ["VECTOR", "SCALAR", "BANDS"])
def test_known_coefficients_lower_thresholds(kind, rng):
    mesh = triangle_torus(8, 12)
    frames = ("BOX_SPLINE_111", "ADAPTIVE") if kind == "VECTOR" else ("BOX_SPLINE_111",)
    for frame in frames:
        level = make_transform(mesh, frame, dtype=np.float32).levels[0]
        known = (
            make_transform(mesh, frame, dtype=np.float32)
            .analyze(rng.normal(size=(mesh.n_vertices, 3)))
            .chunks[0]
        )
        for index, chunk in enumerate(known):
            high = rng.normal(size=chunk.shape).astype(np.float32)
            changed = high.copy()
            Shrinkage(level, kind, 0.5, known=known)(index, changed)
            groups = level.group_starts(index)
            threshold = 0.25 / (0.5 + norms(chunk, kind, groups))  # 0.5 / (1 + |known| / 0.5)
            length = norms(high, kind, groups)
            expected = -2.0 * high * np.minimum(1.0, threshold / length)
            expected[:, level.unpenalized(index)] = 0.0
            np.testing.assert_allclose(changed, expected, rtol=1e-4, atol=1e-6)


def test_groups_of_bands_have_one_length(rng):
    bands = rng.normal(size=(3, 5, 4))
    found = norms(bands, "VECTOR", np.array([0, 1, 3]))
    for band, group in enumerate(([0], [1, 2], [1, 2], [3, 4], [3, 4])):
        for site in range(4):
            squares = sum(bands[axis, member, site] ** 2 for axis in range(3) for member in group)
            assert found[0, band, site] == pytest.approx(math.sqrt(squares))


def test_refreshing_matters_where_angles_choose_only():
    twice = BY_NAME["Refreshed, 2 rounds"]
    regular = triangle_torus(16, 24)
    noisy = regular.with_vertices(add_noise(regular, 0.3).astype(np.float32))
    problem = Problem(noisy, connect(noisy))
    np.testing.assert_array_equal(run_with(problem, twice, 0.4), run_with(problem, PLAIN, 0.4))
    # Quads of three at a corner of a cube choose the edges that they divide by length.
    problem = problem_of("quad")
    first = run_with(problem, PLAIN, 0.4, is_quad=True)
    assert np.abs(run_with(problem, twice, 0.4, is_quad=True) - first).max() > 0.01


def test_reweighting_keeps_more():
    problem = problem_of("tri")
    start = run_with(problem, PLAIN, 0.0)
    once, twice = (
        np.linalg.norm(run_with(problem, PLAIN._replace(rounds=n, reweights=True), 0.4) - start)
        for n in (1, 2)
    )
    assert 0.3 * once < twice < 0.95 * once
    with_adaptive = Variant("", ADAPTIVE, rounds=2, reweights=True)
    assert np.isfinite(run_with(problem, with_adaptive, 0.4)).all()


def test_a_common_factor_is_that_of_the_other_models():
    angles = {"quad/a": {1.0: 1.0, 2.0: 8.0}, "quad/b": {1.0: 3.0, 2.0: 2.0}, "quad/c": {1.0: 3.0, 2.0: 2.0}}
    trials = Trials(
        Trial(model, True, "normal 0.1", PLAIN.name, factor, angle, 0.1)
        for model, row in angles.items()
        for factor, angle in row.items()
    )
    common = {model: trials.common(PLAIN.name, model, "normal 0.1").factor for model in angles}
    assert common == {"quad/a": 2.0, "quad/b": 1.0, "quad/c": 1.0}
    assert trials.common_factor(PLAIN.name, angles) == 1.0
    assert trials.best(PLAIN.name, "quad/b", "normal 0.1").factor == 2.0


def run(*words):
    """Run the benchmark in a fresh Python."""
    command = [sys.executable, str(FOLDER / "run.py"), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


def smallest_mean(lines, kind, variant):
    """Return the geometric mean of the angles of a variant over the noises, with the best common λ."""
    means = []
    own = [line for line in lines if line["model"].endswith(kind) and line["variant"] == variant.name]
    is_tuned = variant.changes.get("tuning") == "NOISE"
    for factor in {line["factor"] for line in own}:
        angles = [float(line["angle"]) for line in own if line["factor"] == factor or is_tuned]
        assert len(angles) == 2
        means.append(math.sqrt(angles[0] * angles[1]))
    assert is_tuned or len(means) == 3
    return min(means)


def test_quick_run_and_its_tables(tmp_path):
    result = run("--quick", "--output", tmp_path)
    assert result.returncode == 0, result.stderr
    with (tmp_path / "trials.csv").open(encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    text = (tmp_path / "positions.md").read_text(encoding="utf-8")
    for kind, table in zip(("tri", "quad"), text.split("## ")[1:3], strict=True):
        cells = (line.split("|") for line in table.split("\n") if line.startswith("| "))
        rows = {first.strip(): [cell.strip() for cell in rest] for _, first, *rest in cells}
        plain = smallest_mean(lines, kind, PLAIN)
        for variant in VARIANTS:
            # With one model of a kind, the λ of the others is its own.
            own, row = smallest_mean(lines, kind, variant), rows[variant.name]
            assert float(row[2]) == pytest.approx(own, abs=0.006)
            assert float(row[3]) == pytest.approx(own / plain, abs=0.0006)
            assert row[6] == "-" or float(row[6]) <= float(row[2])
    again = run("--again", tmp_path, "--output", tmp_path / "again")
    assert again.returncode == 0, again.stderr
    assert (tmp_path / "again" / "positions.md").read_text(encoding="utf-8") == text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("made/nothing",), "There is no model 'made/nothing'"),
        (("made/small_cube_tri", "--quick"), "There is a table for each kind of faces"),
    ],
)
def test_models_that_do_not_do(tmp_path, words, said):
    result = run(*words, "--output", tmp_path)
    assert result.returncode == 2
    assert result.stderr.startswith(said)
