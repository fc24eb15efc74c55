# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prepared meshes: the same bits as without, and never used for another mesh or other stencils."""

from dataclasses import fields, replace

import numpy as np
import pytest
from checks import assert_same_bits, lengths, preset_settings, read_only
from framelet.core import PRESETS, PreparationCache, Region, SurfaceMesh, denoise, prepare
from framelet.core import prepared as module
from framelet.core.mesh.locality import reorder
from framelet.core.preparation_cache import bytes_of
from framelet.core.settings import used_settings
from meshes import MESHES, faces_of, flipped, mixed_sheet, noisy, triangle_grid, triangle_torus, union

POSITIONS = ("TRI_1", "TRI_2")
OTHERS = ("AUTO", "BILATERAL")


def settings_of(preset, **changes):
    return preset_settings(preset, **changes)


def with_array(mesh, name, array):
    """Return a mesh with another array, which need not fit the others."""
    return SurfaceMesh.trusted(
        **{item.name: getattr(mesh, item.name) for item in fields(mesh)} | {name: array}
    )


@pytest.mark.parametrize("preset", [*POSITIONS, *OTHERS])
@pytest.mark.parametrize("mesh", [flipped(triangle_torus()), triangle_grid(), mixed_sheet()])
def test_runs_on_a_prepared_mesh_have_the_same_bits(preset, mesh, rng):
    mesh = read_only(noisy(mesh, rng))
    settings = settings_of(preset, iterations=4)
    prepared = prepare(mesh, settings)
    movable = rng.random(mesh.n_vertices) < 0.7
    for changes in (
        {},
        {"lambda_": 0.1, "mu": 3.0, "delta": 0.2},
        {"iterations": 7, "tolerance": 1e-6, "threads": 2},
        {"strength": 0.8, "noise": "WIDE", "passes": 1, "sigma_s": 0.1},
        {},
    ):
        changed = settings.with_changes(**used_settings({"method": settings.method} | changes))
        for some in (None, movable):
            alone = denoise(mesh, changed, movable=some)
            again = denoise(mesh, changed, movable=some, prepared=prepared)
            assert_same_bits(alone.vertices, again.vertices)
            assert replace(alone.report, seconds=0.0) == replace(again.report, seconds=0.0)


def test_a_copy_of_the_mesh_fits(rng):
    mesh = noisy(triangle_torus(), rng)
    prepared = prepare(mesh)
    assert prepared.fits(read_only(mesh), PRESETS["AUTO"].settings)
    denoise(read_only(mesh), prepared=prepared)


@pytest.mark.parametrize("name", [item.name for item in fields(SurfaceMesh)])
def test_one_other_number_anywhere_does_not_fit(name, rng):
    mesh = noisy(triangle_grid(4, 4), rng)
    settings = settings_of("TRI_2")
    cache = PreparationCache()
    prepared = cache.prepare(mesh, settings)
    for place in range(getattr(mesh, name).size):
        array = getattr(mesh, name).copy()
        array.flat[place] += 1
        other = with_array(mesh, name, array)
        assert not prepared.fits(other, settings)
        assert prepared.has_topology_of(other) == (name == "vertices")
    longer = np.concatenate((getattr(mesh, name), getattr(mesh, name)[-1:]))
    assert not prepared.fits(with_array(mesh, name, longer), settings)
    assert prepared.fits(read_only(mesh), settings)
    assert cache.prepare(read_only(mesh), settings) is prepared


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2", "BILATERAL"])
def test_an_edit_in_place_is_seen(preset, rng):
    """The arrays of the caller may be written to, by himself or through a view, after they were prepared."""
    settings, cache = settings_of(preset), PreparationCache()
    torus = noisy(triangle_torus(), rng)
    mesh = SurfaceMesh.from_faces(torus.vertices, faces_of(torus))
    prepared = prepare(mesh, settings)
    denoise(mesh, settings, prepared=cache)
    mesh.vertices[:] += rng.normal(0.0, 0.1, mesh.vertices.shape)
    assert_same_bits(denoise(mesh, settings, prepared=cache).vertices, denoise(mesh, settings).vertices)
    assert not prepared.fits(mesh, settings)
    faces = mesh.corner_vertex.reshape(-1, 3)
    edges = mesh.corner_edge.reshape(-1, 3)
    faces[:], edges[:] = faces[:, ::-1].copy(), edges[:, [1, 0, 2]]  # every face turned over
    again = SurfaceMesh(**{item.name: getattr(mesh, item.name) for item in fields(mesh)})
    assert_same_bits(denoise(mesh, settings, prepared=cache).vertices, denoise(again, settings).vertices)


def test_only_arrays_that_can_be_written_to_are_copied(rng):
    mesh = noisy(triangle_torus(), rng)
    kept = prepare(mesh).surface
    assert not np.shares_memory(kept.vertices, mesh.vertices)
    with pytest.raises(ValueError, match="read-only"):
        kept.vertices[0] = 0.0
    frozen = read_only(mesh)
    assert prepare(frozen).surface.vertices is frozen.vertices
    view = mesh.with_vertices(mesh.vertices[:])
    view.vertices.flags.writeable = False  # but not what it is a view of
    assert not np.shares_memory(prepare(view).surface.vertices, mesh.vertices)
    once = prepare(mesh, is_kept=False)
    assert once.surface.vertices is mesh.vertices and mesh.vertices.flags.writeable


@pytest.mark.parametrize("name", [item.name for item in fields(SurfaceMesh)])
def test_any_other_array_does_not_fit(name, rng):
    mesh = noisy(triangle_torus(), rng)
    prepared = prepare(mesh)
    array = getattr(mesh, name).copy()
    array.flat[7] = array.flat[7] + 1
    other = with_array(mesh, name, array)
    assert not prepared.fits(other, PRESETS["AUTO"].settings)
    with pytest.raises(ValueError, match="prepared for another mesh or other stencils"):
        denoise(other, prepared=prepared)


@pytest.mark.parametrize(
    "changes",
    [
        {"frame": "ADAPTIVE"},
        {"stencil": "MEAN"},
        {"levels": 2},
        {"boundary": "FIXED"},
        {"shrinkage": "BANDS"},
    ],
)
def test_other_stencils_do_not_fit(changes, rng):
    mesh = noisy(triangle_torus(), rng)
    prepared = prepare(mesh, settings_of("TRI_2"))
    assert prepared.fits(mesh, settings_of("TRI_2", lambda_=9.0, mu=3.0))
    assert not prepared.fits(mesh, settings_of("TRI_2", **changes))
    assert not prepared.fits(mesh, PRESETS["AUTO"].settings)
    assert not prepared.fits(mesh, settings_of("TRI_2"), np.float64)
    with pytest.raises(ValueError, match="prepared for another mesh or other stencils"):
        denoise(mesh, settings_of("TRI_2", **changes), prepared=prepared)


@pytest.mark.parametrize("preset", [*POSITIONS, *OTHERS])
@pytest.mark.parametrize("levels", [1, 2])
@pytest.mark.parametrize("frame", ["AUTO", "ADAPTIVE"])
def test_renumbering_inside_does_not_change_the_result(preset, levels, frame, rng, monkeypatch):
    """The work is done in another numbering, but ties are broken by the numbers of the caller."""
    if preset in OTHERS and (frame, levels) != ("AUTO", 1):
        pytest.skip("the frame does not matter")
    # On a soup of faces the methods on normals decide by a hair, and so by rounding.
    meshes = [flipped(triangle_torus()), triangle_torus(), mixed_sheet()]
    for mesh in [*meshes, MESHES["soup"]()] if preset in POSITIONS else meshes:
        for surface in (mesh, noisy(mesh, rng)):
            changes = {"levels": levels, "iterations": 3}
            if preset in POSITIONS:
                changes["frame"] = frame
            settings = settings_of(preset, **changes)
            try:
                plain = denoise(surface, settings)
            except ValueError as error:
                assert "too small" in str(error)
                continue
            with monkeypatch.context() as patch:
                patch.setattr(module, "is_scattered", lambda _: True)
                found = denoise(surface, settings, movable=np.ones(surface.n_vertices, bool))
                prepared = prepare(surface, settings)
            assert prepared.reordering is not None
            difference = lengths(found.vertices.astype(np.float64) - plain.vertices).max()
            # Sums over faces and vertices run in another order.
            assert difference <= 1e-4 * plain.report.mean_edge_length
            assert found.report.flipped_faces == plain.report.flipped_faces
            assert found.report.n_moved == pytest.approx(plain.report.n_moved, abs=2)
            assert found.report.mean_edge_length == pytest.approx(plain.report.mean_edge_length, rel=1e-12)


def test_the_cache_keeps_and_drops(rng, monkeypatch):
    cache = PreparationCache()
    settings = settings_of("TRI_2", iterations=2)
    one, two = noisy(triangle_torus(), rng), noisy(flipped(triangle_torus()), rng)
    first = cache.prepare(one, settings)
    assert cache.prepare(read_only(one), settings.with_changes(lambda_=0.1)) is first
    second = cache.prepare(two, settings)
    assert len(cache) == 2
    assert cache.prepare(one, settings) is first
    # Other positions or other stencils: the neighborhoods are used again, the stencils are not.
    moved = one.with_vertices(one.vertices * 1.5 + rng.normal(0, 0.1, one.vertices.shape))
    third = cache.prepare(moved, settings)
    assert third is not first
    assert third.connectivity is first.connectivity
    assert third.transform is not first.transform
    assert len(cache) == 2
    assert_same_bits(denoise(moved, settings, prepared=cache).vertices, denoise(moved, settings).vertices)
    fourth = cache.prepare(moved, settings.with_changes(stencil="MEAN"))
    assert fourth.connectivity is first.connectivity
    assert cache.prepare(two, settings) is second
    cache.forget()
    assert len(cache) == 0
    assert cache.prepare(two, settings) is not second
    # With room for one, the older one goes; what is too large alone is not kept.
    small = PreparationCache(max_bytes=int(1.5 * bytes_of(first)))
    small.prepare(one, settings)
    small.prepare(two, settings)
    assert len(small) == 1
    none = PreparationCache(max_bytes=1000)
    result = denoise(one, settings, prepared=none)
    assert len(none) == 0
    assert_same_bits(result.vertices, denoise(one, settings).vertices)


def test_a_renumbered_mesh_keeps_its_numbers_for_other_positions(rng, monkeypatch):
    monkeypatch.setattr(module, "is_scattered", lambda _: True)
    cache = PreparationCache()
    settings = settings_of("TRI_2", iterations=3)
    mesh = noisy(flipped(triangle_torus()), rng)
    mesh = reorder(mesh, rng.permutation(mesh.n_vertices)).surface
    first = cache.prepare(mesh, settings)
    moved = mesh.with_vertices(mesh.vertices + rng.normal(0, 0.01, mesh.vertices.shape))
    second = cache.prepare(moved, settings)
    assert second.connectivity is first.connectivity
    expected = denoise(moved, settings).vertices
    assert lengths(denoise(moved, settings, prepared=cache).vertices - expected).max() < 1e-5


def test_bytes_of_counts_each_array_once(rng):
    mesh = noisy(triangle_torus(), rng)
    whole = sum(getattr(mesh, item.name).nbytes for item in fields(SurfaceMesh))
    assert bytes_of(mesh) == bytes_of((mesh, mesh.vertices[3:], [mesh])) == whole
    settings = settings_of("TRI_2")
    prepared = prepare(mesh, settings)
    denoise(mesh, settings, prepared=prepared)
    assert bytes_of(prepared) > whole + prepared.transform.levels[0].stencil.slots.nbytes


def test_faces_of_the_prepared_mesh_are_those_of_the_caller(rng, monkeypatch):
    monkeypatch.setattr(module, "is_scattered", lambda _: True)
    mesh = noisy(mixed_sheet(), rng)
    prepared = prepare(mesh)
    assert prepared.surface.vertices.tobytes() == mesh.vertices.tobytes()
    assert sorted(map(len, faces_of(prepared.ordered))) == sorted(map(len, faces_of(mesh)))


def test_what_is_known_of_the_faces_is_kept_and_counted(rng):
    mesh = noisy(triangle_torus(), rng)
    settings = settings_of("TRI_2")
    prepared = prepare(mesh, settings)
    before = bytes_of(prepared)
    denoise(mesh, settings, prepared=prepared)
    faces = prepared.faces
    assert bytes_of(prepared) >= before + faces.areas.nbytes
    denoise(mesh, settings, prepared=prepared)
    assert prepared.faces.areas is faces.areas


def test_what_is_known_of_the_faces_is_not_used_for_welded_meshes(rng):
    sheet = noisy(triangle_grid(), rng)
    settings = settings_of("TRI_2")
    cache = PreparationCache()
    for distance in (None, 0.0, None):
        region = Region(weld_distance=distance)
        doubled = union(sheet, sheet)
        alone = denoise(doubled, settings, region=region)
        again = denoise(doubled, settings, region=region, prepared=cache)
        assert_same_bits(alone.vertices, again.vertices)
        assert replace(alone.report, seconds=0.0) == replace(again.report, seconds=0.0)
