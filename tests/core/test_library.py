# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions for scripts: what goes in and out, settings by keywords, penalties of one's own."""

import inspect
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from checks import assert_same_bits
from framelet import core
from framelet.core import (
    PRESETS,
    DenoiseSettings,
    FilterBank,
    FirmThreshold,
    FrameletError,
    FrameTransform,
    HardThreshold,
    MeshError,
    Region,
    RegionError,
    SettingError,
    SoftThreshold,
    SurfaceMesh,
    compare,
    denoise,
    split_bregman,
)
from framelet.core.arguments import as_identifier, as_settings
from framelet.core.frames import BANKS
from framelet.core.methods.proximal import norms
from meshes import faces_of, mixed_sheet, noisy, quad_torus, triangle_torus

surface = SurfaceMesh.from_faces
KINDS = ("BANDS", "VECTOR", "SCALAR")


@pytest.mark.parametrize("make", [triangle_torus, quad_torus, mixed_sheet])
def test_arrays_and_a_mesh_are_the_same_run(make, rng):
    mesh = noisy(make(), rng)
    faces = faces_of(mesh)
    expected = denoise(SurfaceMesh.from_faces(mesh.vertices, faces))
    for given, more in (
        (faces, {}),
        (np.concatenate(faces), {"offsets": np.cumsum([0, *map(len, faces)])}),
    ):
        found = denoise(mesh.vertices, given, **more)
        assert isinstance(found, np.ndarray)
        assert_same_bits(found, expected.vertices)
        full = denoise(mesh.vertices.tolist(), given, full_output=True, dtype=np.float64, **more)
        assert full.report.n_vertices == mesh.n_vertices and full.vertices.dtype == np.float64
    assert_same_bits(denoise(mesh, full_output=False), denoise(mesh).vertices)
    other = denoise(mesh, "tri-2" if make is triangle_torus else "positions")
    assert_same_bits(denoise(mesh.vertices, faces, other.report.settings), other.vertices)


def test_settings_by_name_preset_and_object_are_the_same_run(rng):
    mesh = noisy(quad_torus(), rng)
    settings = PRESETS["QUAD_2"].settings.with_changes(levels=2)
    expected = denoise(mesh, settings).vertices
    for result in (
        denoise(mesh, preset="quad-2", levels=2),
        denoise(mesh, "QUAD_2", levels=2),
        denoise(mesh, settings=settings),
        denoise(mesh, settings.with_changes(levels=1), levels=2),
        denoise(mesh, method="positions", frame="linear-spline", lambda_=0.2, levels=2),
        denoise(mesh, method="positions", frame=BANKS["LINEAR_SPLINE"], lambda_=0.2, levels=2),
    ):
        assert_same_bits(result.vertices, expected)


def test_presets_that_the_docstring_names_exist(rng):
    (line,) = [line for line in denoise.__doc__.splitlines() if "in any case: one of" in line]
    names = re.findall('"([^"]+)"', line)
    assert len(names) > 2
    for name in names:
        assert as_settings(None, name, {}) == PRESETS[as_identifier(name)].settings


def test_a_bank_of_ones_own_denoises(rng):
    mesh = noisy(quad_torus(), rng)
    known = BANKS["B_SPLINE_1"]
    bank = FilterBank("MINE", known.lattice, known.offsets, known.masks)
    found = denoise(mesh, method="POSITIONS", frame=bank, max_bytes=10**9)
    assert_same_bits(found.vertices, denoise(mesh, method="POSITIONS", frame="B_SPLINE_1").vertices)
    tuned = denoise(mesh, method="POSITIONS", frame=bank, tuning="NOISE")
    assert tuned.report.noise is not None and tuned.report.settings.tuning == "NOISE"


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda V, F: denoise(V), MeshError, "There are no faces; give vertices and faces"),
        (lambda V, F: denoise(core.SurfaceMesh.from_faces(V, F), F), MeshError, "faces of its own"),
        (lambda V, F: denoise(V, F, strenght=1), SettingError, "no setting strenght; choose from method,"),
        (lambda V, F: denoise(V, F, levels=2), SettingError, "levels is 2, but the method AUTO does not"),
        (
            lambda V, F: denoise(V, F, preset="nice"),
            SettingError,
            "The preset is 'NICE'; choose one of AUTO,",
        ),
        (lambda V, F: denoise(V, F, preset="auto", settings=DenoiseSettings()), SettingError, "one of them"),
        (lambda V, F: denoise(V, F, method="magic"), SettingError, "Engine is 'MAGIC'; choose one of"),
        (lambda V, F: denoise(V[:-1], F), MeshError, "names vertex"),
        (lambda V, F: denoise(V, F, movable=[True]), RegionError, "mask of movable vertices"),
        (lambda V, F: denoise(V, [0, 1, 2], offsets=[0, 2]), MeshError, "offsets must begin with 0"),
        (lambda V, F: denoise(V, F, offsets=[0, 3]), MeshError, "beside offsets they must be a flat list"),
        (lambda V, F: core.equalize(core.SurfaceMesh.from_faces(V, F), []), SettingError, "no gains"),
    ],
)
def test_errors_are_of_types_that_can_be_caught(call, kind, message):
    mesh = triangle_torus()
    with pytest.raises(kind, match=message) as error:
        call(mesh.vertices, np.array(faces_of(mesh)))
    assert isinstance(error.value, FrameletError) and isinstance(error.value, ValueError)


def test_weights_and_masks_are_anything_like_an_array(rng):
    mesh = noisy(triangle_torus(), rng)
    some = rng.random(mesh.n_vertices) < 0.5
    expected = denoise(mesh, "TRI_2", movable=some).vertices
    assert_same_bits(denoise(mesh, "TRI_2", movable=some.tolist()).vertices, expected)
    for weights in (some, some.astype(int), some.tolist(), some.astype(np.float32)):
        assert_same_bits(denoise(mesh, "TRI_2", region=Region(weights=weights)).vertices, expected)
    gains = core.equalize(mesh, [0.5], weights=some.astype(float))
    assert_same_bits(core.equalize(mesh, [0.5], weights=some.astype(int).tolist()), gains)


def test_other_functions_take_arrays_and_meshes_alike(rng):
    mesh = noisy(mixed_sheet(), rng)
    V, F = mesh.vertices, faces_of(mesh)
    mesh = SurfaceMesh.from_faces(V, F)
    assert core.estimate_noise(V, F) == core.estimate_noise(mesh, threads=2)
    assert_same_bits(core.add_noise(V, F, 0.1, 3), core.add_noise(mesh, 0.1, 3))
    assert_same_bits(core.face_normals(V, F), core.face_normals(mesh))
    assert_same_bits(core.vertex_normals(V, F), core.vertex_normals(mesh))
    moved = core.bilateral_filter(V, F, iterations=2)
    assert_same_bits(moved, denoise(mesh, "BILATERAL", iterations=2).vertices)
    by_meshes = core.compare(mesh.with_vertices(moved), mesh)
    assert core.compare(moved, F, V) == core.compare(moved, mesh) == by_meshes
    assert core.compare(mesh.with_vertices(moved), V) == by_meshes


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("mu", [0.5, 1.0, 3.0])
def test_split_bregman_is_the_solver_of_the_paper(kind, mu, rng):
    """On a mesh whose edges have the mean length 1 the units agree, too."""
    mesh = triangle_torus()
    mesh = noisy(mesh.with_vertices(mesh.vertices / core.compare(mesh, mesh).mean_edge_length), rng)
    mesh = mesh.with_vertices(mesh.vertices / core.compare(mesh, mesh).mean_edge_length)
    transform = FrameTransform(mesh)
    found = split_bregman(mesh.vertices, transform, SoftThreshold(0.3, kind), mu=mu, delta=0.1, iterations=7)
    settings = {"shrinkage": kind, "lambda_": 0.3, "mu": mu, "delta": 0.1, "iterations": 7}
    expected = denoise(
        mesh, method="POSITIONS", region=Region(repair_folds=False), dtype=np.float64, **settings
    )
    assert np.abs(found - expected.vertices).max() < 1e-9


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("make", [SoftThreshold, HardThreshold, lambda w, k: FirmThreshold(w, 3.0, k)])
@pytest.mark.parametrize("step", [0.5, 1.0, 2.0])
def test_proximal_operators_are_minima(make, kind, step, rng):
    """Nothing around has a lower g(x) + |x - y|^2 / 2 step, nor has zero or y itself."""
    prox = make(0.6, kind)
    bands = rng.normal(size=(3, 4, 1)) * np.array([0.1, 0.5, 1.0, 2.0])[:, None]
    bands[0] *= 0.1

    def cost(x):
        return prox.value(x) + ((x - bands) ** 2).sum() / (2.0 * step)

    best = prox(bands, step)
    assert (best != bands).any()
    others = [np.zeros_like(bands), bands]
    others += [best + rng.normal(0, size, bands.shape) for size in (1e-3, 0.1, 1.0) for _ in range(50)]
    for share in np.linspace(0, 1, 21):
        others.append(bands * share)
    assert all(cost(best) <= cost(other) + 1e-12 for other in others)


def test_groups_of_bands_are_shrunk_as_one(rng):
    """Cosine and sine of one frequency, as the frame ADAPTIVE has them."""
    bands, groups = rng.normal(size=(3, 5, 2)), np.array([0, 1, 3])
    length = norms(bands, "VECTOR", groups)
    assert length.shape == (3, 2)
    assert length[1] == pytest.approx(np.sqrt((bands[:, 1:3] ** 2).sum(axis=(0, 1))))
    for prox in (SoftThreshold(1.2), HardThreshold(1.2), FirmThreshold(1.2, 3.0)):
        left = bands - prox.removed(bands, 1.0, groups)
        ratio = left / bands
        assert np.ptp(ratio[:, 1:3], axis=(0, 1)) == pytest.approx(0.0, abs=1e-12)


def test_the_objective_goes_down_and_the_callback_stops(rng):
    mesh = noisy(quad_torus(), rng)
    transform = FrameTransform(mesh, levels=2)
    for penalty in (SoftThreshold(0.1), SoftThreshold(0.1, "bands"), FirmThreshold(0.05, 1.0)):
        seen = []
        clean = split_bregman(
            mesh.vertices,
            transform,
            penalty,
            iterations=40,
            callback=lambda *now, seen=seen: seen.append(now),
        )
        iterations, iterates, objectives = zip(*seen, strict=True)
        assert iterations == tuple(range(2, 41))
        assert_same_bits(iterates[-1], clean)
        assert objectives[-1] < objectives[0]
        start = sum(
            penalty.value(chunk)
            for level, chunks in zip(transform.levels, transform.analyze(mesh.vertices).chunks, strict=True)
            for chunk in chunks
        )
        assert objectives[-1] < start
    stopped = split_bregman(mesh.vertices, transform, penalty, iterations=40, callback=lambda k, *_: k == 5)
    assert_same_bits(stopped, iterates[3])


def test_an_operator_of_ones_own_is_the_built_in_one(rng):
    mesh = noisy(triangle_torus(), rng)
    transform = FrameTransform(mesh)
    soft, seen = SoftThreshold(0.05, "SCALAR"), []

    def prox(bands, step):
        return np.sign(bands) * np.maximum(np.abs(bands) - 0.05 * step, 0.0)

    for penalty in (None, soft.value):
        found = split_bregman(
            mesh.vertices, transform, prox, penalty=penalty, mu=2.0, callback=lambda *now: seen.append(now[2])
        )
        expected = split_bregman(mesh.vertices, transform, soft, mu=2.0)
        assert np.abs(found - expected).max() < 1e-12
    assert np.isnan(seen[:9]).all() and np.isfinite(seen[9:]).all()


def test_numbers_that_no_solver_takes_are_refused():
    mesh = triangle_torus()
    transform = FrameTransform(mesh)
    for options, sentence in (
        ({"mu": 0.0}, "mu is 0; it must be"),
        ({"mu": "a"}, "mu is 'a'; it must be a number"),
        ({"delta": 2.0}, "delta is 2; it must be between 0 and 1"),
        ({"iterations": 0}, "The number of iterations is 0; it must be"),
        ({"iterations": 2.5}, "The number of iterations is 2.5; it must be a whole number"),
        ({"tolerance": None}, "The tolerance is None; it must be a number"),
        ({"callback": 3}, "The callback is 3; give a function"),
    ):
        with pytest.raises(SettingError, match=sentence):
            split_bregman(mesh.vertices, transform, SoftThreshold(0.1), **options)
    with pytest.raises(MeshError, match=r"the transform needs \(192, 3\)"):
        split_bregman(mesh.vertices[1:], transform, SoftThreshold(0.1))
    with pytest.raises(SettingError, match="The weight is -1"):
        SoftThreshold(-1)
    with pytest.raises(SettingError, match="The shrinkage is 'NONE'"):
        HardThreshold(1, "none")
    with pytest.raises(SettingError, match="larger than the weight over mu"):
        split_bregman(mesh.vertices, transform, FirmThreshold(2.0, 1.0))


def test_the_package_is_typed():
    assert (Path(core.__path__[0]).parent / "py.typed").exists()


def ragged(positions):
    return [[0.0, 1.0], *positions[1:].tolist()]


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (
            lambda V, F: denoise(ragged(V), F),
            MeshError,
            r"The positions are no array; expected shape \(N, 3\)",
        ),
        (
            lambda V, F: denoise(np.ma.masked_less(V, 0), F),
            MeshError,
            r"The positions have \d+ masked values",
        ),
        (lambda V, F: denoise(V, np.ma.masked_equal(F, 3)), MeshError, r"The faces have \d+ masked values"),
        (
            lambda V, F: denoise(V, F, settings={"strength": 0.1}),
            SettingError,
            "The settings are {'strength'",
        ),
        (lambda V, F: denoise(V, F, preset=V), SettingError, "The preset is array"),
        (lambda V, F: denoise(V, F, method=V), SettingError, "Engine is array"),
        (lambda V, F: denoise(V, F, region=5), RegionError, "The region is 5; give a Region"),
        (
            lambda V, F: denoise(V, F, max_bytes="1 GB"),
            SettingError,
            "a run may take is '1 GB'; it must be a number",
        ),
        (
            lambda V, F: core.estimate_noise(V, F, threads=2.0),
            SettingError,
            "threads is 2.0; it must be a whole",
        ),
        (
            lambda V, F: core.estimate_noise(V, F, threads=-1),
            SettingError,
            "threads is -1; it must be a finite",
        ),
        (lambda V, F: core.equalize(surface(V, F), 0.5), SettingError, "There are no gains"),
        (lambda V, F: core.equalize(surface(V, F), ["1"]), SettingError, "The gain of level 1 is '1'"),
        (lambda V, F: core.equalize(surface(V, F), [10**400]), SettingError, "level 1 is a huge number"),
        (
            lambda V, F: core.equalize(surface(V, F), [1], weights=["1"] * len(V)),
            SettingError,
            "The weights are <U1; expected real numbers",
        ),
        (lambda V, F: core.equalize(surface(V, F), [1], frame=5), core.FrameError, "The frame is 5; choose"),
        (lambda V, F: core.add_noise(V, F, "0.1"), SettingError, "The noise level is '0.1'"),
        (lambda V, F: core.add_noise(V, F, 0.1, -1), SettingError, "The seed is -1"),
        (lambda V, F: core.add_noise(V, F, 0.1, None), SettingError, "The seed is None"),
        (lambda V, F: core.add_noise(V, F, 1e308 * 9), SettingError, "The noise level is inf"),
        (lambda V, F: core.add_noise(V, F, 1e308), SettingError, "with it there are no numbers"),
        (lambda V, F: core.compare(V * np.nan, F, V), MeshError, "not finite points"),
        (lambda V, F: core.compare(V.astype(str), F, V), MeshError, "The positions are <U32; expected real"),
        (lambda V, F: surface(V, F).with_vertices(V * 1j), MeshError, "The positions are complex128"),
    ],
)
def test_what_is_of_the_wrong_kind_is_refused_in_words(call, kind, message):
    mesh = triangle_torus()
    with pytest.raises(kind, match=message):
        call(mesh.vertices, faces_of(mesh))


@pytest.mark.parametrize("dtype", [int, bool, complex, object, np.float16, "nonsense", 5])
@pytest.mark.parametrize("method", ["AUTO", "POSITIONS", "BILATERAL"])
def test_other_precisions_are_refused(dtype, method):
    """Whole numbers moved all vertices by a fifth of an edge to where no noise had been, without a word."""
    mesh = triangle_torus()
    with pytest.raises(SettingError, match="choose float32 or float64"):
        denoise(mesh, method=method, dtype=dtype)
    with pytest.raises(SettingError, match="choose float32 or float64"):
        core.equalize(mesh, [0.5], dtype=dtype)


def test_a_matrix_is_an_array(rng):
    """Its rows are matrices again, of which the corners were taken."""
    mesh = noisy(triangle_torus(), rng)
    faces = np.array(faces_of(mesh))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)
        found = denoise(np.matrix(mesh.vertices), np.matrix(faces))
    assert_same_bits(found, denoise(mesh.vertices, faces))
    assert type(found) is np.ndarray


def test_meshes_too_large_to_square_are_not_compared():
    mesh = triangle_torus()
    for pair in ((mesh, mesh.vertices * 1e200), (mesh.with_vertices(mesh.vertices * 1e200), mesh)):
        with pytest.raises(MeshError, match="too large to measure its edges; scale both down"):
            core.compare(*pair)
    point = mesh.with_vertices(np.full(mesh.vertices.shape, 1e200))
    assert core.compare(point, mesh).max_distance == pytest.approx(1e200 * 3**0.5)


def test_a_result_is_no_mesh_to_compare(rng):
    """Its positions are: the result itself is refused in words, on either side."""
    mesh = noisy(triangle_torus(), rng)
    result = denoise(mesh, preset="tri-1")
    assert compare(result.vertices, mesh).rms_distance > 0
    for given in ((result, mesh), (mesh, result)):
        with pytest.raises(MeshError, match="expected real numbers"):
            compare(*given)


MESH_FUNCTIONS = {
    "add_noise": (0.1, 3),
    "analyze": ("adaptive",),
    "bilateral_filter": (),
    "compare": None,  # the positions of another mesh
    "connect": (),
    "denoise": (),
    "equalize": ([0.5],),
    "estimate_noise": (),
    "face_normals": (),
    "FrameTransform": ("auto",),
    "make_stencil": (),
    "make_transform": ("Adaptive",),
    "noise_field": None,
    "prepare": (),
    "vertex_normals": (),
}
"""All public functions of a mesh, and what follows it."""


def arrays_of(result):
    """Return all numbers of a result in one list."""
    if isinstance(result, FrameTransform):
        result = [result.frame, *result.measures()]
    if isinstance(result, np.ndarray):
        return [result]
    if isinstance(result, core.DenoiseResult):
        return [result.vertices]
    if isinstance(result, core.FrameCoefficients | list | tuple):
        return [array for item in result for array in arrays_of(item)]
    if isinstance(result, core.Prepared):
        return arrays_of([result.surface.corner_vertex, result.noisy, result.connectivity.ring])
    if hasattr(result, "__dict__") and not isinstance(result, str):
        return arrays_of([value for key, value in vars(result).items() if key != "transform"])
    return [np.array(result if isinstance(result, int | float | str) else 0)]


@pytest.mark.parametrize("name", MESH_FUNCTIONS)
def test_every_function_takes_vertices_and_faces_or_a_mesh(name, rng):
    """Faces as lists, by name and as a flat list with offsets, too."""
    mesh = noisy(mixed_sheet(), rng)
    V, F = mesh.vertices, faces_of(mesh)
    mesh = SurfaceMesh.from_faces(V, F)
    call, rest = getattr(core, name), MESH_FUNCTIONS[name]
    rest = (V + 0.1,) if rest is None else rest
    flat, offsets = np.concatenate(F), np.cumsum([0, *map(len, F)])
    expected = arrays_of(call(mesh, *rest))
    assert expected and any(array.size > 1 or array.dtype.kind == "f" for array in expected)
    for found in (
        call(V, F, *rest),
        call(V.tolist(), F, *rest),
        call(V, flat, *rest, offsets=offsets),
        *([call(V, *rest, faces=F)] if name != "compare" and name != "denoise" else []),
    ):
        for one, other in zip(arrays_of(found), expected, strict=True):
            np.testing.assert_array_equal(one, other)
    for wrong in ((V,), (mesh, F) if name != "compare" else (mesh,)):
        with pytest.raises(FrameletError):
            call(*wrong, **({} if len(wrong) == 1 else {"offsets": offsets}))
    assert [*inspect.signature(call).parameters][:2] in (["vertices", "faces"], ["mesh", "faces"])


def test_every_public_function_is_one_of_a_mesh_or_needs_none():
    others = {"split_bregman", "synthesize", "adjoint"}  # of a transform or coefficients
    functions = {name for name in core.__all__ if inspect.isroutine(getattr(core, name))}
    assert functions == (set(MESH_FUNCTIONS) | others) - {"FrameTransform"}
    for name in functions:
        names = set(inspect.signature(getattr(core, name)).parameters)
        assert not names & {"rule", "blocks", "n_threads", "n_levels"}, name


def test_old_calls_with_a_mesh_go_on(rng):
    mesh = noisy(triangle_torus(), rng)
    assert_same_bits(core.add_noise(mesh, 0.2, 1), core.add_noise(mesh, sigma=0.2, seed=1))
    stencil = core.make_stencil(mesh, core.connect(mesh), "STRAIGHT", bank=BANKS["BOX_SPLINE_111"])
    np.testing.assert_array_equal(stencil.slots, core.make_stencil(mesh).slots)
    assert core.make_transform(mesh).frame == FrameTransform(mesh).frame == "BOX_SPLINE_111"
    assert core.compare(mesh.vertices, mesh).rms_distance == 0.0


@pytest.mark.parametrize("call", [FrameTransform, core.make_transform, core.analyze, core.equalize])
def test_a_frame_that_the_stencil_replaces_is_refused(call):
    mesh = triangle_torus()
    more = {"gains": [0.5]} if call is core.equalize else {}
    with pytest.raises(SettingError, match="frame is 'BOX_SPLINE_111', but has no effect with stencil="):
        call(mesh, frame="box-spline-111", stencil="adaptive", **more)
    call(mesh, frame="Pairwise", stencil="Adaptive", **more)


@pytest.mark.parametrize(
    ("values", "make", "frame"),
    [
        ({"method": "positions"}, triangle_torus, "BOX_SPLINE_111"),
        ({"method": "positions"}, quad_torus, "LINEAR_SPLINE"),
        ({"method": "positions"}, mixed_sheet, "ADAPTIVE"),
        ({"method": "positions", "stencil": "adaptive"}, triangle_torus, "ADAPTIVE"),
        ({"preset": "tri-2", "stencil": "adaptive"}, triangle_torus, "ADAPTIVE"),
        ({"method": "positions", "frame": "pairwise"}, triangle_torus, "PAIRWISE"),
        ({"method": "positions", "frame": "pairwise", "stencil": "adaptive"}, triangle_torus, "PAIRWISE"),
        ({"method": "positions", "frame": BANKS["B_SPLINE_1"]}, quad_torus, "B_SPLINE_1"),
        ({"method": "bilateral"}, triangle_torus, ""),
        ({}, triangle_torus, ""),
    ],
)
def test_the_report_names_the_frame_that_ran(values, make, frame, rng):
    assert denoise(noisy(make(), rng), **values).report.frame == frame


def test_a_stop_while_preparing_is_a_public_exception_and_no_error():
    with pytest.raises(core.Stopped) as caught:
        core.prepare(triangle_torus(), should_stop=lambda: True)
    assert not isinstance(caught.value, FrameletError)
    assert denoise(triangle_torus(), should_stop=lambda: True).report.is_stopped
