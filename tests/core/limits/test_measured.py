# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a mesh is measured by itself: what lies outside of it says nothing about its noise."""

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, lengths, wild_mesh
from framelet.core import PRESETS, DenoiseSettings, Region, connect, denoise
from framelet.core.blocks import Blocks
from framelet.core.learned.engine import FaceEngine
from framelet.core.learned.islands import LEAST_ISLAND
from framelet.core.mesh.geometry import face_normals, vertex_normals
from framelet.core.mesh.surface_mesh import SurfaceMesh
from framelet.core.noise.estimate import estimate_noise
from meshes import faces_of, triangle_grid, triangle_torus
from region_cases import rings_from

SETTINGS = {
    "AUTO": PRESETS["AUTO"].settings,
    "FREE_FORM": PRESETS["FREE_FORM"].settings,
    "BILATERAL": PRESETS["BILATERAL"].settings,
    "FROM_NOISE": DenoiseSettings(method="POSITIONS", tuning="NOISE"),
}


class Halves:
    """A torus with different noise in its halves; one of them may move, and is cut out besides."""

    def __init__(self, own, other, rng):
        clean = triangle_torus(48, 128)
        self.clean, self.movable = clean, clean.vertices[:, 0] > 0.0
        sigma = np.where(self.movable, own, other) * edge_length(clean)
        height = sigma * rng.normal(0, 1, clean.n_vertices)
        self.mesh = clean.with_vertices(clean.vertices + height[:, None] * vertex_normals(clean))
        faces = np.array(faces_of(clean))
        faces = faces[self.movable[faces].all(axis=1)]
        number = np.cumsum(self.movable) - 1
        self.part = SurfaceMesh.from_faces(self.mesh.vertices[self.movable], number[faces])
        self.inside = rings_from(self.mesh, ~self.movable) >= 6

    def angle(self, vertices):
        """Return the mean angle, in degrees, of faces inside of the half to what they are on the torus."""
        own = self.inside[np.array(faces_of(self.clean))].all(axis=1)
        true, found = face_normals(self.clean), face_normals(self.clean.with_vertices(vertices))
        return np.degrees(np.arccos(np.clip((true * found).sum(axis=1), -1, 1)))[own].mean()

    def results(self, settings, **given):
        """Return what comes of a run on the half as a group, and of one on the half that was cut out."""
        as_group = denoise(self.mesh, settings, **(given or {"movable": self.movable}))
        alone = denoise(self.part, settings)
        vertices = self.mesh.vertices.copy()
        vertices[self.movable] = alone.vertices
        return as_group, alone.report, vertices


@pytest.mark.parametrize("other", [0.0, 0.03])
@pytest.mark.parametrize("name", SETTINGS)
def test_a_noisy_half_is_cleaned_as_if_it_were_cut_out(name, other, rng):
    """The rms difference was up to 0.4 edges, and the angle 29 degrees instead of 1.4."""
    halves = Halves(0.3, other, rng)
    found, _, alone = halves.results(SETTINGS[name])
    away = lengths(found.vertices - alone)[halves.inside] / edge_length(halves.clean)
    assert np.sqrt((away**2).mean()) < 0.015
    assert halves.angle(found.vertices) < 1.05 * halves.angle(alone) + 0.05


@pytest.mark.parametrize("name", ["BILATERAL", "FROM_NOISE"])
def test_a_clean_half_is_not_smoothed_for_the_noise_of_the_other(name, rng):
    halves = Halves(0.1, 0.5, rng)
    found, _, alone = halves.results(SETTINGS[name])
    away = lengths(found.vertices - alone)[halves.inside] / edge_length(halves.clean)
    assert np.sqrt((away**2).mean()) < 0.03


@pytest.mark.parametrize(("name", "tolerance"), [("AUTO", 0.02), ("FROM_NOISE", 0.05)])
def test_the_noise_that_is_told_is_that_of_the_half(name, tolerance, rng):
    halves = Halves(0.3, 0.0, rng)
    weights = np.where(halves.movable, 1.0, 0.0)
    found, alone, _ = halves.results(SETTINGS[name], region=Region(weights=weights))
    assert found.report.noise.sigma_edges == pytest.approx(alone.noise.sigma_edges, rel=tolerance)


@pytest.mark.parametrize("name", SETTINGS)
def test_that_all_may_move_is_no_part(name, rng):
    mesh = Halves(0.3, 0.1, rng).part
    everywhere = np.ones(mesh.n_vertices, bool)
    whole = denoise(mesh, SETTINGS[name])
    assert_same_bits(denoise(mesh, SETTINGS[name], movable=everywhere).vertices, whole.vertices)
    by_weights = denoise(mesh, SETTINGS[name], region=Region(weights=everywhere.astype(float)))
    assert_same_bits(by_weights.vertices, whole.vertices)


def test_few_vertices_are_measured_with_those_around(rng):
    """On each of two islands; an island where nothing may move is not grown."""
    one, two = triangle_torus(24, 64), triangle_grid(30, 40)
    faces = [*faces_of(one), *(one.n_vertices + np.array(faces_of(two)))]
    mesh = wild_mesh(np.concatenate((one.vertices, two.vertices + np.array([20, 0, 0]))), faces)
    engine = FaceEngine(mesh, connect(mesh), Blocks(1))
    movable = np.zeros(mesh.n_vertices, bool)
    movable[one.n_vertices + 600] = True
    found = engine.measured(movable)
    assert LEAST_ISLAND <= np.count_nonzero(found.faces) < 1.5 * LEAST_ISLAND
    assert not found.faces[: one.n_faces].any()
    assert not found.vertices[: one.n_vertices].any()
    ring = rings_from(mesh, movable)
    assert ring[found.vertices].max() < 14
    movable[: one.n_vertices // 2] = True
    more = engine.measured(movable)
    expected = movable[np.array(faces_of(one))].any(axis=1)
    assert more.faces[: one.n_faces].tolist() == expected.tolist()
    assert more.faces[one.n_faces :].tolist() == found.faces[one.n_faces :].tolist()


@pytest.mark.parametrize("name", SETTINGS)
def test_a_loose_vertex_alone_says_nothing(name, rng):
    half = Halves(0.3, 0.3, rng).part
    mesh = wild_mesh(np.concatenate((half.vertices, [[9.0, 9.0, 9.0]])), faces_of(half))
    movable = np.zeros(mesh.n_vertices, bool)
    movable[-1] = True
    assert_same_bits(denoise(mesh, SETTINGS[name], movable=movable).vertices, mesh.vertices)
    assert estimate_noise(mesh, where=movable).sigma == 0.0
