# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Split Bregman over several levels against matrices, and what every frame and level must do."""

import dense_twin
import numpy as np
import pytest
from checks import AS_SOLVED, assert_same_bits, edge_length, lengths, preset_settings, read_only
from framelet.core import (
    BANKS,
    DenoiseSettings,
    connect,
    denoise,
    make_stencil,
    make_transform,
    prepare,
)
from framelet.core.equalizer import Equalizer
from meshes import flipped, mixed_sheet, noisy, prism, pyramid, quad_torus, triangle_torus, union
from stars import star
from twins import split_bregman

SAME = 1e-10

BUILD = {
    "LINEAR_SPLINE": lambda: quad_torus(4, 5),
    "BOX_SPLINE_111": lambda: flipped(triangle_torus(4, 6)),
    "B_SPLINE_3": lambda: quad_torus(4, 5),
    "ADAPTIVE": lambda: union(flipped(triangle_torus(4, 6)), prism(5), pyramid(4)),
}


def groups_of(frame, mesh, transform):
    """Return, for each level, a function from sites to the bands that VECTOR shrinks together."""
    every = [level.n_high for level in transform.levels]
    if frame != "ADAPTIVE":
        return [lambda site, n=n: [[band] for band in range(n)] for n in every]
    valence = connect(mesh).valence
    found = [
        [
            np.abs(transform.analyze(np.eye(mesh.n_vertices)[:, [v] * 3]).details(level)[:, v]).max() > 0
            for v in range(mesh.n_vertices)
        ]
        for level in range(len(every))
    ]

    def harmonics(site, level):
        """Ring against center; not frequency 1; from 2 on cosine and sine together, or the last alone."""
        k = int(valence[site]) if found[level][site] else 0
        first_free = 3 if k > 2 else 1
        return [[0], *([band, band + 1][: k - band] for band in range(first_free, k, 2))] if k else []

    return [lambda site, level=level: harmonics(site, level) for level in range(len(every))]


@pytest.mark.parametrize("n_levels", [1, 2])
@pytest.mark.parametrize(
    ("frame", "changes"),
    [
        ("LINEAR_SPLINE", {"shrinkage": "SCALAR", "stencil": "MEAN", "delta": 0.1}),
        ("LINEAR_SPLINE", {"shrinkage": "VECTOR", "mu": 4.0}),
        ("BOX_SPLINE_111", {"shrinkage": "BANDS", "stencil": "MEAN", "lambda_": 0.5}),
        ("BOX_SPLINE_111", {"shrinkage": "VECTOR", "delta": 0.2}),
        ("B_SPLINE_3", {"shrinkage": "VECTOR"}),
        ("ADAPTIVE", {"shrinkage": "VECTOR", "stencil": "ADAPTIVE"}),
        ("ADAPTIVE", {"shrinkage": "VECTOR", "stencil": "ADAPTIVE", "mu": 0.5, "delta": 0.3}),
    ],
)
def test_matches_the_matrices(frame, changes, n_levels, rng):
    """All bands, whether they reach the surface or not; with V, which is the adjoint where that is exact."""
    mesh = read_only(noisy(BUILD[frame](), rng))
    settings = DenoiseSettings(
        method="POSITIONS", frame=frame, levels=n_levels, boundary="FREE", iterations=5, **changes
    )
    edge = edge_length(mesh)
    scaled = mesh.with_vertices(mesh.vertices / edge)
    transform = make_transform(scaled, frame, settings.stencil, n_levels, boundary="FREE")
    dense = dense_twin.DenseFrame(transform, mesh.n_vertices)
    assert np.abs(dense.synthesis @ dense.analysis - np.eye(mesh.n_vertices)).max() < 1e-12
    groups = groups_of(frame, mesh, transform)
    if settings.shrinkage == "BANDS":
        groups = [lambda site, n=level.n_high: [list(range(n))] for level in transform.levels]
    hold = np.flatnonzero(connect(mesh).is_loose)
    expected = edge * dense_twin.split_bregman(scaled.vertices, dense, settings, groups, hold)
    result = denoise(mesh, settings, dtype=np.float64, region=AS_SOLVED)
    assert lengths(result.vertices - expected).max() < SAME * edge
    assert lengths(expected - mesh.vertices).max() > 0.01 * edge


@pytest.mark.parametrize("n_levels", [1, 2])
def test_the_dense_adjoint_is_the_inverse_in_the_measures(n_levels, rng):
    """W* = m^-1 W' m' as matrices equals `synthesize`, so that (4.6) is solved in closed form."""
    mesh = noisy(BUILD["ADAPTIVE"](), rng)
    transform = make_transform(mesh, "ADAPTIVE", levels=n_levels)
    dense = dense_twin.DenseFrame(transform, mesh.n_vertices)
    measures = transform.measures()
    weights = [measures[-1]]
    for (n_high, _), measure in zip(dense.shapes[1:], measures[1:], strict=True):
        weights += [measure] * n_high
    expected = (dense.analysis.T * np.concatenate(weights)) / measures[0][:, None]
    is_real = np.abs(dense.analysis).max(axis=1) > 0  # bands that a vertex does not have are zero
    assert np.abs(expected - dense.synthesis)[:, is_real].max() < 1e-12


@pytest.mark.parametrize("preset", ["QUAD_1", "QUAD_2"])
@pytest.mark.parametrize("iterations", [2, 6])
@pytest.mark.parametrize("kind", ["torus", "stars", "mixed"])
def test_quad_presets_are_the_literal_iteration(kind, iterations, preset, rng):
    """(5.10) word by word with the full E and all bands; the second iteration is the first that changes S."""
    build = {
        "torus": quad_torus,
        "stars": lambda: union(star(5, 2, 4)[0], star(3, 2, 4)[0]),
        "mixed": mixed_sheet,
    }
    mesh = read_only(noisy(build[kind](), rng))
    settings = preset_settings(preset, iterations=iterations, boundary="FREE")
    bank, edge, connectivity = BANKS["LINEAR_SPLINE"], edge_length(mesh), connect(mesh)
    stencil = make_stencil(mesh, connectivity, settings.stencil, "FREE", bank=bank)
    hold = np.flatnonzero(connectivity.is_loose)
    expected = edge * split_bregman(mesh.vertices / edge, stencil.data_matrix, bank, settings, hold)
    result = denoise(mesh, settings, dtype=np.float64, region=AS_SOLVED).vertices
    assert lengths(result - expected).max() < SAME * edge
    assert lengths(result - mesh.vertices).max() > 0.01 * edge


FRAMES = ["BOX_SPLINE_111_CANONICAL", "LINEAR_SPLINE", "B_SPLINE_3", "B_SPLINE_4", "ADAPTIVE", "PAIRWISE"]
FRAME = pytest.mark.parametrize("frame", FRAMES)


def sheet(rng):
    return noisy(union(flipped(triangle_torus(7, 9)), quad_torus(6, 7), mixed_sheet()), rng)


@FRAME
def test_more_levels_remove_coarser_noise(frame, rng):
    mesh = sheet(rng)
    results = [
        denoise(mesh, DenoiseSettings(method="POSITIONS", frame=frame, levels=n), region=AS_SOLVED).vertices
        for n in (1, 2, 3)
    ]
    edge = edge_length(mesh)
    for one, two in ((0, 1), (1, 2)):
        assert lengths(results[one] - results[two]).max() > 0.02 * edge
    moved = [np.sqrt((lengths(result - mesh.vertices) ** 2).mean()) for result in results]
    assert moved[1] > moved[0]


@FRAME
def test_float32_agrees_with_float64(frame, rng):
    mesh = sheet(rng)
    single = mesh.with_vertices(mesh.vertices.astype(np.float32))
    settings = DenoiseSettings(method="POSITIONS", frame=frame, levels=2)
    fast = denoise(single, settings)
    assert fast.vertices.dtype == np.float32
    exact = denoise(single.with_vertices(single.vertices.astype(np.float64)), settings, dtype=np.float64)
    assert lengths(fast.vertices - exact.vertices).max() < 1e-4 * exact.report.mean_edge_length


def in_blocks(size, mesh, settings, dtype=np.float32):
    """Return the positions after a run whose blocks have so many vertices."""
    prepared = prepare(mesh, settings, dtype=dtype, block_size=size)
    return denoise(mesh, settings, dtype=dtype, prepared=prepared).vertices


@pytest.mark.parametrize("frame", ["BOX_SPLINE_111", "B_SPLINE_3", "ADAPTIVE", "PAIRWISE"])
def test_threads_do_not_change_a_bit(frame, rng):
    """Blocks of fifty vertices, and small chunks, so that there are many of each."""
    mesh = sheet(rng)
    settings = DenoiseSettings(method="POSITIONS", frame=frame, levels=2, iterations=3, delta=0.1)
    for run in (
        lambda threads: in_blocks(50, mesh, settings.with_changes(threads=threads)),
        lambda threads: Equalizer(mesh, 2, frame=frame, threads=threads, block_size=50).equalized([0.5, 1.5]),
    ):
        results = [run(threads) for threads in (1, 2, 4)]
        assert_same_bits(results[0], results[1])
        assert_same_bits(results[0], results[2])


@pytest.mark.parametrize("frame", ["ADAPTIVE", "PAIRWISE", "B_SPLINE_3"])
def test_chunks_do_not_change_a_result(frame, rng):
    mesh = sheet(rng)
    settings = DenoiseSettings(method="POSITIONS", frame=frame, levels=2, iterations=4)
    plain = denoise(mesh, settings, dtype=np.float64).vertices
    assert lengths(in_blocks(15, mesh, settings, np.float64) - plain).max() < 1e-12


@FRAME
def test_edited_bands_come_back(frame, rng):
    """`details` and `with_details` are inverse to each other, and synthesis is linear in them."""
    mesh = sheet(rng)
    transform = make_transform(mesh, frame, levels=2)
    found = transform.analyze(mesh.vertices)
    details = [found.details(0), found.details(1)]
    again = found.with_details(details, found.low)
    assert_same_bits(transform.synthesize(again), transform.synthesize(found))
    details[1] = 3.0 * details[1]
    edited = transform.synthesize(found.with_details(details, found.low))
    expected = transform.synthesize(found.scaled([1.0, 3.0]))
    assert lengths(edited - expected).max() < 1e-12
    assert lengths(edited - mesh.vertices).max() > 0.01
    assert [level.n_sites for level in transform.levels] == [bands.shape[1] for bands in details]
    assert transform.levels[1].n_sites == mesh.n_vertices
