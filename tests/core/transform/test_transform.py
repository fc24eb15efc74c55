# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Perfect reconstruction on every mesh, and conserved energy where the mesh is regular."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from checks import TRIANGLE_BANKS, assert_same_bits, edge_length, lengths, read_only
from framelet.core import BANKS, analyze, connect, make_stencil, make_transform, synthesize
from framelet.core import transform as transform_room
from framelet.core.blocks import Blocks
from framelet.core.frames.valence_masks import FAMILIES
from framelet.core.mesh.geometry import mean_edge_length
from mesh_files import mesh_files, read_mesh
from meshes import MESHES, flipped, noisy, quad_torus, triangle_grid, triangle_torus, union

PERFECT = 1e-12
"""Error of reconstruction in float64, relative to the largest coordinate."""

PERFECT_32 = 1e-5
"""The same in float32, in mean edge lengths."""

BANK = pytest.mark.parametrize("bank", TRIANGLE_BANKS)
RULE = pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
BOUNDARY = pytest.mark.parametrize("boundary", ["ALONG", "FIXED", "FREE"])


def bands_of(transform, vertices):
    """Return the coefficients of a transform of one level as (B, N, 3)."""
    coefficients = transform.analyze(vertices)
    return np.concatenate((coefficients.low[None], coefficients.details(0)))


def assert_perfect(mesh, bank, rule, boundary, connectivity=None, n_levels=1, slack=1.0, single=True):
    options = {"boundary": boundary, "connectivity": connectivity}
    vertices = mesh.vertices.astype(np.float64)
    transform = make_transform(mesh, bank, rule, n_levels, **options)
    error = np.abs(transform.synthesize(transform.analyze(vertices)) - vertices).max()
    assert error <= PERFECT * np.abs(vertices).max()
    if mesh.n_vertices > 20000 or not single:
        return  # once more in float32 would take as long again
    edge = mean_edge_length(mesh)
    center = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    scaled = ((vertices - center) / (edge or 1.0)).astype(np.float32)
    transform = make_transform(mesh.with_vertices(scaled), bank, rule, n_levels, **options, dtype=np.float32)
    again = transform.synthesize(transform.analyze(scaled))
    assert again.dtype == np.float32
    # Coordinates of many edge lengths are themselves no finer than their float32 spacing.
    quantum = np.spacing(np.abs(scaled).max())
    assert np.abs(again.astype(np.float64) - scaled).max() <= slack * max(PERFECT_32, 4 * quantum)


@BANK
@RULE
@BOUNDARY
@pytest.mark.parametrize("name", MESHES)
def test_perfect_reconstruction(name, bank, rule, boundary, rng):
    assert_perfect(read_only(noisy(MESHES[name](), rng)), bank, rule, boundary)


@pytest.mark.parametrize("kind", ["tri", "quad", "mixed", "nonmanifold", "scan", "bad"])
def test_perfect_reconstruction_of_files(shared_meshes, kind):
    """Three combinations of rule, border and bank on small meshes; one on larger ones, of which some."""
    every = [
        (bank, r, b)
        for r in ("MEAN", "STRAIGHT")
        for b in ("ALONG", "FIXED", "FREE")
        for bank in TRIANGLE_BANKS
    ]
    paths = mesh_files(shared_meshes, kind)
    assert paths
    n_checked = 0
    for number, path in enumerate(paths):
        mesh = read_mesh(path)
        if not mesh.n_faces or not np.isfinite(mesh.vertices).all():
            continue
        if mesh.n_vertices > 20000 and number % 3:
            continue
        connectivity = connect(mesh)
        turn = [every[(5 * number + 7 * k) % len(every)] for k in range(3 if mesh.n_vertices < 4000 else 1)]
        for bank, rule, boundary in turn:
            try:
                assert_perfect(mesh, bank, rule, boundary, connectivity)
            except ValueError as error:
                assert mesh.n_vertices < 10 and "too small" in str(error), path.name
                continue
            n_checked += 1
    assert n_checked >= len(paths) // 2


@pytest.mark.parametrize("frame", [*BANKS, *FAMILIES])
@pytest.mark.parametrize("n_levels", [1, 3])
def test_perfect_reconstruction_of_every_frame_and_level(frame, n_levels, rng):
    """Every rule and border, also where the lattice of the frame is not that of the faces.

    The first two of three levels are those of a transform with two.

    In one mesh: closed and open, irregular, mixed, reversed and non-manifold parts, loose edges and vertices.
    Sums of up to 49 taps and three levels round more often: float32 gets four times the room.
    """
    parts = (flipped(triangle_torus(6, 8)), MESHES["turned-over sheet"](), quad_torus(6, 7))
    parts += (MESHES["three pages"](), MESHES["soup"](), MESHES["single triangle"]())
    mesh = read_only(noisy(union(*parts), rng))
    connectivity = connect(mesh)
    assert connectivity.is_loose.any() and connectivity.is_non_manifold.any()
    for rule in ("MEAN", "STRAIGHT", "ADAPTIVE") if frame == "ADAPTIVE" else ("MEAN", "STRAIGHT"):
        for boundary in ("ALONG", "FREE") if rule == "MEAN" else ("FIXED", "FREE"):
            options = {"n_levels": n_levels, "slack": 4.0, "single": (rule, boundary) == ("STRAIGHT", "FREE")}
            assert_perfect(mesh, frame, rule, boundary, connectivity, **options)


@pytest.mark.parametrize("frame", FAMILIES)
@pytest.mark.parametrize("n_levels", [1, 2, 3])
def test_frames_that_fit_the_valence_are_tight_on_every_mesh(frame, n_levels, rng):
    """The adjoint with respect to the measures is the inverse: W*W = I, and energy is conserved."""
    for name, build in MESHES.items():
        mesh = read_only(noisy(build(), rng))
        try:
            transform = make_transform(mesh, frame, "ADAPTIVE", n_levels)
        except ValueError as error:
            assert n_levels > 1 and "too small" in str(error), name
            continue
        coefficients = transform.analyze(mesh.vertices)
        error = np.abs(transform.weighted_adjoint(coefficients) - mesh.vertices).max()
        assert error < PERFECT * np.abs(mesh.vertices).max(), name
        measures = transform.measures()
        assert min(measure.min() for measure in measures) > 0, name
        energy = (measures[-1] * (coefficients.low**2).sum(axis=1)).sum()
        for level in range(n_levels):
            energy += (measures[level + 1] * (coefficients.details(level) ** 2).sum(axis=(0, 2))).sum()
        assert energy == pytest.approx((measures[0] * (mesh.vertices**2).sum(axis=1)).sum(), rel=1e-12), name


@pytest.mark.parametrize("frame", [*BANKS, *FAMILIES])
@pytest.mark.parametrize("n_levels", [1, 2])
def test_the_adjoint_is_the_transposed_matrix(frame, n_levels, rng):
    """<W x, c> = <x, W' c> for arbitrary coefficients c."""
    transform = make_transform(noisy(MESHES["mixed sheet"](), rng), frame, "STRAIGHT", n_levels)
    x = rng.normal(size=(45, 3))
    found = transform.analyze(x)
    details = [rng.normal(size=found.details(level).shape) for level in range(n_levels)]
    other = found.with_details(details, rng.normal(size=found.low.shape))
    # Bands that a vertex does not have are zero in `details`, so that what stands there does not count.
    left = [(found.low * other.low).sum()]
    left += [(found.details(level) * details[level]).sum() for level in range(n_levels)]
    assert sum(left) == pytest.approx((x * transform.adjoint(other)).sum(), rel=1e-11, abs=1e-10)
    measures = transform.measures()
    left = [(measures[-1][:, None] * found.low * other.low).sum()]
    for level in range(n_levels):
        weight = measures[level + 1][:, None] if frame in FAMILIES else 1.0
        left.append((weight * found.details(level) * details[level]).sum())
    right = (measures[0][:, None] * x * transform.weighted_adjoint(other)).sum()
    assert sum(left) == pytest.approx(right, rel=1e-11, abs=1e-10)


@pytest.mark.parametrize("frame", ["BOX_SPLINE_111", "B_SPLINE_3", "ADAPTIVE"])
def test_two_threads_may_use_one_transform(frame, rng):
    """Scratch memory belongs to the thread, not to the transform."""
    mesh = noisy(quad_torus(60, 70), rng) if frame == "B_SPLINE_3" else noisy(triangle_torus(60, 70), rng)
    transform = make_transform(mesh, frame, "STRAIGHT", 2)
    positions = [mesh.vertices * scale for scale in (1.0, -3.0, 7.0, 0.5)]
    expected = [transform.analyze(own) for own in positions]

    def work(own):
        for _ in range(10):
            found = transform.analyze(own)
            back = transform.synthesize(found)
        return found, back

    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(work, positions))
    for own, known, (found, back) in zip(positions, expected, results, strict=True):
        assert_same_bits(found.low, known.low)
        for level in range(2):
            assert_same_bits(found.details(level), known.details(level))
        assert np.abs(back - own).max() < PERFECT * np.abs(own).max()


@BANK
@RULE
@pytest.mark.parametrize("sizes", [(5, 6), (12, 16)])
def test_energy_on_a_regular_torus(bank, rule, sizes, rng):
    """Tight: the coefficients of all bands together have the energy of the surface."""
    mesh = triangle_torus(*sizes)
    vertices = rng.normal(size=mesh.vertices.shape)
    coefficients = bands_of(make_transform(mesh, bank, rule), vertices)
    assert (coefficients**2).sum() == pytest.approx((vertices**2).sum(), rel=1e-13)


@BANK
@BOUNDARY
@pytest.mark.parametrize("name", MESHES)
def test_constants_and_linear_functions(name, boundary, bank, rng):
    """A surface at one point has no details, and the transform is linear."""
    mesh = MESHES[name]()
    for rule in ("MEAN", "STRAIGHT"):
        transform = make_transform(mesh, bank, rule, boundary=boundary)
        point = rng.normal(size=3)
        coefficients = bands_of(transform, np.tile(point, (mesh.n_vertices, 1)))
        assert np.abs(coefficients[0] - point).max() < 1e-14
        assert np.abs(coefficients[1:]).max() < 1e-14
        one, two = rng.normal(size=(2, mesh.n_vertices, 3))
        both = bands_of(transform, 2 * one - 3 * two)
        assert np.abs(both - 2 * bands_of(transform, one) + 3 * bands_of(transform, two)).max() < 1e-13


@BANK
def test_analysis_is_masks_times_data_matrix(bank, rng):
    mesh = noisy(union(*(build() for build in MESHES.values())), rng)
    masks = TRIANGLE_BANKS[bank].masks
    expected = np.zeros((len(masks), mesh.n_vertices, 3))
    matrix = make_stencil(mesh, connect(mesh)).data_matrix(mesh.vertices)
    for band, mask in enumerate(masks):
        for tap, weight in enumerate(mask):
            expected[band] += weight * matrix[tap]
    tolerance = 1e-13 * np.abs(mesh.vertices).max()
    assert np.abs(bands_of(make_transform(mesh, bank), mesh.vertices) - expected).max() < tolerance
    with Blocks(2, block_size=13) as blocks:
        blocked = bands_of(transform_room.make_transform(mesh, bank, blocks=blocks), mesh.vertices)
    assert np.abs(blocked - expected).max() < tolerance
    coefficients = analyze(mesh, bank)
    assert np.abs(coefficients.low - expected[0]).max() < tolerance
    assert np.abs(synthesize(coefficients) - mesh.vertices).max() < 10 * tolerance


def test_second_differences_vanish_inside_a_flat_regular_grid():
    mesh = triangle_grid(6, 7)
    coefficients = bands_of(make_transform(mesh), mesh.vertices)
    inside = ~connect(mesh).is_boundary
    assert np.abs(coefficients[1:4, inside]).max() < 1e-14
    assert lengths(coefficients[4:, inside]).min() > 0.1 * edge_length(mesh)  # first differences do not


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"frame": "HAAR"}, "The frame is 'HAAR'; choose one of AUTO, BOX_SPLINE_111, "),
        ({"levels": 0}, "The number of levels is 0; it must be a finite number, at least 1"),
        ({"stencil": "BEST"}, "The stencil is 'BEST'; choose one of MEAN, STRAIGHT"),
        (
            {"levels": 9},
            r"The mesh is too small for \d levels: nothing is \d+ edges apart; use \d levels? or fewer",
        ),
        (
            {"levels": 9, "stencil": "ADAPTIVE"},
            r"The mesh is too small for \d levels: nothing is \d+ edges apart",
        ),
        ({"frame": "LINEAR_SPLINE"}, "LINEAR_SPLINE is a frame for quads, but the mesh has none"),
    ],
)
def test_what_does_not_fit_is_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        make_transform(triangle_grid(), **changes)


def test_cell_centered_frames_need_cells():
    with pytest.raises(
        ValueError, match="B_SPLINE_3 needs quads or pairs of triangles, but the mesh has none"
    ):
        make_transform(MESHES["single triangle"](), "B_SPLINE_3")
