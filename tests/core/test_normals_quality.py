# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How well normals are cleaned, and which settings matter."""

from dataclasses import fields
from functools import cache

import numpy as np
import pytest
from checks import AS_SOLVED, assert_same_bits, read_only
from framelet.core import PRESETS, DenoiseSettings, SurfaceMesh, add_noise, blocks, compare, denoise
from framelet.core.choices import METHODS
from framelet.core.normals import pilot
from mesh_files import read_mesh
from meshes import MESHES, noisy, soup, triangle_torus, union

INFO = {item.name: item.metadata["info"] for item in fields(DenoiseSettings)}
CHANGES = {
    "strength": 0.0,
    "frame": "ADAPTIVE",
    "stencil": "MEAN",
    "shrinkage": "BANDS",
    "levels": 2,
    "lambda_": 0.6,
    "mu": 3.0,
    "delta": 0.3,
    "iterations": 4,
    "tolerance": 1.0,
    "boundary": "FIXED",
    "sigma_c": 1.7,
    "sigma_s": 0.2,
    "normal_threshold": 0.5,
    "sharpness": 0.1,
    "sigma_n": 0.6,
    "average_steps": 3,
    "passes": 1,
    "vertex_steps": 5,
}
"""Another value for each setting but the method, but where parameters come from, and but the threads, which
never change a result."""

CUBE_SIDE = 8


@pytest.fixture(autouse=True)
def alone(monkeypatch):
    """One thread unless told, as these meshes are too small for more."""
    monkeypatch.setattr(blocks, "available_cores", lambda: 1)


@cache
def cube(n=CUBE_SIDE):
    """Return a closed cube of n by n squares a side, each cut into two triangles."""
    number, faces = {}, []
    for axis in range(3):
        for side in (0, n):
            for u, w in np.ndindex(n, n):
                square = [(side, u + a, w + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                square = [number.setdefault(tuple(np.roll(place, axis)), len(number)) for place in square]
                a, b, c, d = square if side else square[::-1]
                faces += [(a, b, c), (a, c, d)]
    return read_only(SurfaceMesh.from_faces(np.array(list(number), float), faces))


def solved(mesh, preset):
    return mesh.with_vertices(denoise(mesh, PRESETS[preset].settings, region=AS_SOLVED).vertices)


def off_edges(mesh):
    """Return how far the vertices on edges of the cube are from where they belong, rms."""
    clean = cube().vertices
    on_side = (clean == 0) | (clean == CUBE_SIDE)
    is_edge = on_side.sum(axis=1) >= 2
    apart = ((mesh.vertices - clean) * on_side)[is_edge]
    return np.sqrt((apart**2).sum(axis=1).mean())


@pytest.mark.parametrize("preset", ["FREE_FORM", "PRISMATIC"])
def test_a_clean_cube_is_left_alone(preset):
    """Its edges are jumps of the normals by a right angle, far more than is averaged."""
    mesh = cube()
    assert np.abs(solved(mesh, preset).vertices - mesh.vertices).max() < 2e-3
    sharp = DenoiseSettings(method="NORMALS", sigma_n=0.2, sharpness=0.05)
    assert np.abs(denoise(mesh, sharp).vertices - mesh.vertices).max() < 1e-5


@pytest.mark.parametrize("seed", [0, 1])
def test_a_noisy_cube_gets_its_faces_and_edges_back(seed):
    """The paper's noise, a fifth of an edge length, which TRI_2 takes away at the cost of the edges."""
    clean = cube()
    noise = clean.with_vertices(add_noise(clean, seed=seed))
    prismatic, tri = solved(noise, "PRISMATIC"), solved(noise, "TRI_2")
    assert compare(noise, clean).mean_angle > 18
    assert compare(prismatic, clean).mean_angle < 0.5 * compare(tri, clean).mean_angle
    assert compare(prismatic, clean).mean_angle < 1.6
    assert compare(prismatic, clean).max_angle < 10
    assert compare(prismatic, clean).rms_distance < 0.5 * compare(noise, clean).rms_distance
    assert off_edges(prismatic) < 0.1
    assert off_edges(noise) > 0.15
    assert off_edges(tri) > 0.4


@pytest.mark.parametrize("build", [triangle_torus, MESHES["quad torus"]])
def test_a_smooth_surface_is_smoothed_and_stays_in_place(build):
    clean = build(24, 48) if build is triangle_torus else build(20, 40)
    noise = clean.with_vertices(add_noise(clean, 0.2, seed=1))
    result = compare(solved(noise, "FREE_FORM"), clean)
    assert result.mean_angle < 0.5 * compare(noise, clean).mean_angle
    assert result.rms_distance < 0.7 * compare(noise, clean).rms_distance


@pytest.mark.parametrize(
    ("preset", "file", "noise", "before", "after"),
    [
        ("PRISMATIC", "fandisk", None, 20.6022, 1.85),
        ("PRISMATIC", "fandisk", "fandisk_noisy03", 28.4211, 2.30),
        ("PRISMATIC", "fandisk", "fandisk_noisy07", 48.8669, 5.95),
        ("FREE_FORM", "bunny_closed35k", None, 21.4751, 5.15),
    ],
)
def test_figures_of_files(shared_meshes, preset, file, noise, before, after):
    """Measured: 1.823, 2.279, 5.894 and 5.110 degrees; None stands for the paper's noise with seed 0."""
    folder = shared_meshes / "tri"
    clean = read_mesh(folder / f"{file}.ply", np.float64)
    vertices = read_mesh(folder / f"{noise}.ply", np.float64).vertices if noise else add_noise(clean, seed=0)
    start = clean.with_vertices(vertices)
    first, last = compare(start, clean), compare(solved(start, preset), clean)
    assert first.mean_angle == pytest.approx(before, abs=1e-4)
    assert last.mean_angle <= after
    assert last.rms_distance < 0.5 * first.rms_distance


@pytest.mark.parametrize("method", [choice.identifier for choice in METHODS])
def test_settings_that_have_no_effect_change_nothing_and_others_do(method, rng):
    """What the user interface hides must not matter, and what it shows must."""
    assert {*CHANGES, "method", "tuning", "threads"} == set(INFO)
    mesh = noisy(MESHES["irregular grid"](), rng)
    settings = DenoiseSettings(method=method, iterations=3)
    plain = denoise(mesh, settings).vertices
    assert not [name for name, value in CHANGES.items() if getattr(settings, name) == value]
    hidden = {name: value for name, value in CHANGES.items() if not INFO[name].has_effect(method)}
    # In one run, as each of many settings would take one of its own.
    assert_same_bits(denoise(mesh, settings.with_changes(**hidden)).vertices, plain)
    for name in [name for name in CHANGES if name not in hidden]:
        other = denoise(mesh, settings.with_changes(**{name: CHANGES[name]})).vertices
        assert not np.array_equal(other, plain), name
    assert_same_bits(denoise(mesh, settings.with_changes(threads=3)).vertices, plain)
    assert INFO["threads"].has_effect(method) and INFO["method"].has_effect(method)


def test_every_method_has_settings_of_its_own():
    named = {method for info in INFO.values() for method in info.methods}
    assert named == {choice.identifier for choice in METHODS}
    own = {name for name, info in INFO.items() if info.methods == ("NORMALS",)}
    assert own == {
        "normal_threshold",
        "sharpness",
        "sigma_n",
        "average_steps",
        "passes",
        "vertex_steps",
    }


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"normal_threshold": -0.1}, "Threshold is -0.1; it must be between 0 and 10."),
        ({"sharpness": 2.5}, "Sharpening is 2.5; it must be between 0 and 2."),
        ({"sigma_n": 0}, "Crease (σn) is 0; it must be between 0.01 and 2."),
        ({"average_steps": 1.5}, "Averaging Steps is 1.5; it must be a whole number."),
        ({"passes": 0}, "Passes is 0; it must be between 1 and 100."),
        ({"vertex_steps": 0}, "Vertex Steps is 0; it must be between 1 and 1000."),
    ],
)
def test_wrong_settings_are_refused_in_one_sentence(changes, sentence):
    with pytest.raises(ValueError) as error:
        DenoiseSettings(method="NORMALS", **changes)
    assert str(error.value) == sentence


@pytest.mark.parametrize(
    "changes",
    [
        {"normal_threshold": 10.0},
        {"sharpness": 2.0},
        {"sharpness": 1e-50},
        {"sigma_n": 0.01},
        {"sigma_n": 2.0, "average_steps": 100},
        {"passes": 100, "average_steps": 1, "vertex_steps": 1},
        {"vertex_steps": 500, "average_steps": 0},
    ],
)
@pytest.mark.filterwarnings("error")
def test_the_ends_of_the_ranges(changes, rng, monkeypatch):
    """Nothing overflows, and nothing is divided by zero, in silence or aloud."""
    monkeypatch.setattr(pilot, "ITERATIONS", 4)
    mesh = noisy(union(MESHES["mixed sheet"](), *(soup(seed) for seed in range(5))), rng)
    result = denoise(mesh, DenoiseSettings(method="NORMALS", **changes))
    assert np.isfinite(result.vertices).all()
    assert 0 < result.report.displacement_max <= 2 * np.ptp(mesh.vertices, axis=0).max()
