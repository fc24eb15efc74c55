# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The page *How AUTO works* names the numbers of the code."""

from pathlib import Path

import numpy as np
from framelet.core.learned import engine, features, islands, net, scales, screened_fit, stillness, unfolding
from framelet.core.methods import learned_shrinkage

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "how_auto_works.md").read_text(encoding="utf-8")
WORDS = " ".join(PAGE.split())


def test_scales():
    names = [f"L_{k}" for k in scales.AVERAGES]
    assert f"itself and {', '.join(names[:-1])} and {names[-1]} of its positions" in WORDS
    assert f"more than {engine.LONG:g} times as long" in WORDS
    assert f"after {scales.LENGTH_AVERAGES} averages" in WORDS
    assert f"around a vertex on {names[scales.LENGTH_SCALE - 1]}" in WORDS
    assert f"at least {scales.LEAST_LENGTH:g} of what it is on the surface itself" in WORDS
    assert f"shrunk to less than {scales.SHRUNK:g} of its area" in WORDS


def test_features():
    """The counts in the rows of each table sum up to what its head says."""
    heads = {"Face": features.N_FACE, "Pair of faces across an edge": features.N_EDGE}
    for name, total in heads.items():
        head = f"| {name}, {total} numbers | |"
        rows = PAGE.split(head)[1].split("\n\n")[0].splitlines()[2:]
        assert sum(int(row.rsplit("|", 2)[1]) for row in rows) == total
    assert f"log(x² + {features.FLOOR:.4f})" in WORDS
    assert f"spread by A^{features.SPREAD_AVERAGES}" in WORDS
    assert f"parts below {islands.LEAST_ISLAND} faces together" in WORDS
    assert f"below a Strength of {learned_shrinkage.WEAKEST}" in WORDS.lower().replace("strength", "Strength")


def test_the_net():
    with np.load(net.WEIGHTS) as file:
        learned = [n for n in file.files if file[n].dtype.kind == "f" and not n.endswith(("_mean", "_scale"))]
        n_numbers = sum(file[name].size for name in learned)
    assert f"{n_numbers:,} numbers. Inputs are standardized and cut off at {net.CLIP:g}." in WORDS
    assert f"the state V (3 x {scales.N_SCALES}) and {net.HIDDEN} scalars" in WORDS
    assert f"with {net.INPUT_HIDDEN} hidden units. Each of {len(net.REPEATS)} layers" in WORDS
    assert f"repeated {', '.join(map(str, net.REPEATS))} times" in WORDS


def test_the_width():
    assert f"above {engine.WIDE_FROM:g} and the strength above {engine.WEAK:g} local edge lengths" in WORDS


def test_the_fit():
    assert f"({screened_fit.NORMAL_PULL} <m_v, v - p_v>² + {screened_fit.TANGENT_PULL} |" in WORDS
    assert f"from {screened_fit.LOWEST} to {screened_fit.HIGHEST}." in WORDS
    assert f"{screened_fit.STEPS} Chebyshev steps, preconditioned by the valence" in WORDS
    assert f"times {screened_fit.NEEDLE**-2:.0f}. " in WORDS
    assert f"more than {screened_fit.OUTLIER:g} times what is usual" in WORDS
    assert f"over {screened_fit.OUTLIER_AVERAGES} averages), are brought" in WORDS
    assert f"at least {100 * screened_fit.LEAST_OUTLIERS:g} % of the vertices" in WORDS
    lean = round(np.degrees(np.arccos(unfolding.LEAN)))
    assert f"more than {lean} degrees" in WORDS
    assert f"doubled area is at most {unfolding.COLLAPSED:.4f} of the squared distances" in WORDS
    rounds, steps = unfolding.ROUNDS, screened_fit.STEPS // 2
    assert f"up to {rounds} times, and {steps} steps follow" in WORDS


def test_what_stays():
    assert f"by more than {learned_shrinkage.FARTHEST:g} local edge lengths stay" in WORDS
    assert f"more than {learned_shrinkage.FARTHEST:g} edges from where it would go" in WORDS
    assert f"to within {stillness.CLEAN} local edge lengths" in WORDS
    assert f"would move by less than {stillness.WIDE} local edge lengths" in WORDS
    cut = f"(rms, each cut off at {stillness.CUT_OFF})"
    assert f"by less than {stillness.HARDLY} local edge lengths {cut}" in WORDS
    assert f"by less than {stillness.NO_NOISE} (rms), or by less than {stillness.HARDLY} (cut off)" in WORDS
    assert f"all stays that moves by less than {stillness.WIDE}." in WORDS
    n_flat, share = stillness.FLAT_FACES, f"{100 * stillness.FLAT_SHARE:g} %"
    assert f"at least {n_flat} triangles that touch along edges and lie in exactly one plane" in WORDS
    assert f"with fewer than {n_flat / stillness.FLAT_SHARE:,.0f} triangles {share} of all suffice" in WORDS
    assert f"at least {n_flat} triangles, or at least {share} of all triangles and two" in WORDS
    assert f"whose height is at most {stillness.LEAST_HEIGHT} times that rounding" in WORDS
    assert f"that rounding, {stillness.ROUNDING:g} units in the last place of the largest coordinate" in WORDS
    # "more than half", "a quarter"
    assert (stillness.MOSTLY_FLAT, stillness.MOSTLY_CLEAN) == (0.5, 0.25)
