# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, settings and regions made at random, among them what no program would write.

A mesh is a shape and a list of damages, each drawn by hypothesis, so that a failure shrinks to few of them.
Inside a shape or a damage the numbers come from a seed, which costs no draws.
"""

from dataclasses import fields
from typing import NamedTuple

import numpy as np
from checks import read_only, wild_mesh
from framelet.core import PRESETS, DenoiseSettings, Region, SurfaceMesh
from framelet.core.settings import used_settings
from hypothesis import strategies as st
from meshes import (
    bow_tie,
    clean_soup,
    faces_of,
    flipped,
    loose_edges_of,
    mixed_sheet,
    moebius_strip,
    noisy,
    prism,
    pyramid,
    quad_grid,
    quad_torus,
    soup,
    triangle_grid,
    triangle_torus,
    turned_over,
    union,
)

SEEDS = st.integers(0, 2**20)


def few(rng):
    """Return a mesh of 0 to 3 vertices with 0 to 2 faces, whatever these name."""
    n_vertices = int(rng.integers(0, 4))
    n_faces = int(rng.integers(0, 3)) if n_vertices else 0
    faces = [rng.integers(n_vertices, size=rng.integers(0, 5)).tolist() for _ in range(n_faces)]
    return wild_mesh(rng.normal(size=(n_vertices, 3)), faces)


def glued_patches(rng):
    """Return sheets of triangles and quads that share vertices, edges or whole borders at random."""
    parts = [quad_grid, triangle_grid, quad_grid]
    sheets = [parts[k](int(rng.integers(2, 5)), int(rng.integers(2, 6))) for k in rng.permutation(3)]
    mesh = union(*sheets)
    glue = np.arange(mesh.n_vertices)
    for _ in range(int(rng.integers(1, 12))):
        a, b = rng.integers(mesh.n_vertices, size=2)
        glue[glue == glue[a]] = glue[b]
    points = mesh.vertices * np.array([0.3, 1.0, 1.0]) + rng.normal(0, 0.3, mesh.vertices.shape)
    return wild_mesh(points, [glue[face] for face in faces_of(mesh)])


def pages(rng):
    """Return sheets that share one edge line: a book, non-manifold along its back."""
    n_pages, length = int(rng.integers(3, 9)), int(rng.integers(2, 6))
    back = np.column_stack((np.arange(length), np.zeros((length, 2))))
    points, faces = [back], []
    for page in range(n_pages):
        turn = 2 * np.pi * page / n_pages
        points.append(back + np.array([0.0, np.cos(turn), np.sin(turn)]))
        own = length * (page + 1)
        faces += [[k, k + 1, own + k + 1, own + k] for k in range(length - 1)]
    return SurfaceMesh.from_faces(np.concatenate(points), faces)


def hub(rng):
    """Return a fan around one vertex, of up to 500 triangles, with a second ring around it."""
    n = int(rng.choice([3, 7, 17, 40, 120, 500], p=[0.2, 0.2, 0.2, 0.2, 0.15, 0.05]))
    inner = pyramid(n, closed=True)
    outer = inner.vertices[1:] * [2, 2, 1]
    here, there = np.arange(1, n + 1), np.roll(np.arange(1, n + 1), -1)
    ring = np.stack((here, here + n, there + n, there), axis=1).tolist()
    return SurfaceMesh.from_faces(np.concatenate((inner.vertices, outer)), faces_of(inner) + ring)


def voxels(rng):
    """Return the quads between full and empty cells of a random block; edges and corners touch."""
    full = np.zeros((5, 5, 5), bool)
    full[1:4, 1:4, 1:4] = rng.random((3, 3, 3)) < rng.uniform(0.2, 0.9)
    corner = np.array([[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]])
    quads = []
    for axis in range(3):
        beside = np.roll(full, 1, axis)
        at = np.argwhere(full != beside)
        turned = np.roll(corner, axis, axis=1)
        quads += [q if full[tuple(p)] else q[::-1] for p, q in zip(at, at[:, None] + turned, strict=True)]
    if not quads:
        return prism(4)
    points, number = np.unique(np.concatenate(quads), axis=0, return_inverse=True)
    return wild_mesh(points.astype(np.float64), number.reshape(-1, 4))


def strip(rng):
    """Return a strip of triangles: every vertex is on the border."""
    n = int(rng.integers(3, 30))
    points = np.column_stack((np.arange(n) / 2, np.arange(n) % 2, rng.normal(0, 0.2, n)))
    return SurfaceMesh.from_faces(points, [[k, k + 1, k + 2] for k in range(n - 2)])


SHAPES = {
    "torus": lambda rng: flipped(triangle_torus(7, 8), seed=int(rng.integers(9))),
    "sheet": lambda rng: flipped(triangle_grid(6, 7), seed=int(rng.integers(9))),
    "quad torus": lambda rng: quad_torus(6, 7),
    "quad sheet": lambda rng: quad_grid(5, 6),
    "mixed sheet": lambda rng: mixed_sheet(),
    "strip": strip,
    "prism": lambda rng: prism(int(rng.choice([3, 5, 24, 200]))),
    "Moebius strip": lambda rng: moebius_strip(),
    "glued patches": glued_patches,
    "pages": pages,
    "bow tie": lambda rng: bow_tie(int(rng.integers(2, 8))),
    "hub": hub,
    "voxels": voxels,
    "soup": lambda rng: soup(int(rng.integers(10**6)), shortest=int(rng.integers(1, 4))),
    "clean soup": lambda rng: clean_soup(int(rng.integers(10**6))),
    "few": few,
}


def _with(mesh, vertices=None, faces=None):
    """Return a mesh with other positions or faces."""
    return wild_mesh(
        mesh.vertices if vertices is None else vertices,
        faces_of(mesh) if faces is None else faces,
        loose_edges_of(mesh),
    )


def loose_parts(mesh, rng):
    """Add vertices without faces, some with an edge, one of them far away."""
    n, more = mesh.n_vertices, rng.normal(size=(5, 3))
    more[0] *= 1e5
    return wild_mesh(
        np.concatenate((mesh.vertices, more)), faces_of(mesh), [*loose_edges_of(mesh), (n, n + 1), (n + 2, 0)]
    )


def duplicate_faces(mesh, rng):
    """Repeat faces, as they are or turned over."""
    faces = faces_of(mesh)
    for k in rng.integers(max(len(faces), 1), size=3):
        faces += [face[:: int(rng.choice([-1, 1]))] for face in faces[k : k + 1]]
    return _with(mesh, faces=faces)


def degenerate_faces(mesh, rng):
    """Add faces that name a vertex twice, or have two corners, one or none."""
    if not mesh.n_vertices:
        return mesh
    a, b, c = (int(v) for v in rng.integers(mesh.n_vertices, size=3))
    return _with(mesh, faces=[*faces_of(mesh), [a, a, b], [b, c], [c], [], [a, b, a, c], [c, c, c]])


def mixed_polygons(mesh, rng):
    """Join neighboring faces to larger ones."""
    faces = faces_of(mesh)
    for _ in range(4):
        first, second = rng.integers(max(len(faces), 1), size=2)
        if first < len(faces) and second < len(faces) and first != second:
            one, two = faces[first], faces[second]
            if len(shared := set(one) & set(two)) == 2:
                at, into = one.index(shared.pop()) + 1, [v for v in two if v not in one]
                faces[first] = one[:at] + into + one[at:]
                faces.pop(second)
    return _with(mesh, faces=faces)


def coincident_vertices(mesh, rng):
    """Put some vertices where others are."""
    if not mesh.n_vertices:
        return mesh
    points = mesh.vertices.copy()
    some, others = rng.integers(mesh.n_vertices, size=(2, max(mesh.n_vertices // 4, 1)))
    points[some] = points[others]
    return _with(mesh, points)


def _scaled(low, high):
    def damage(mesh, rng):
        return _with(mesh, mesh.vertices * 10.0 ** rng.uniform(low, high))

    return damage


def extreme_aspect(mesh, rng):
    """Stretch or flatten along an axis, to a plane in the end."""
    factors = np.ones(3)
    factors[rng.integers(3)] = rng.choice([0.0, 1e-9, 1e-4, 1e4, 1e9])
    return _with(mesh, mesh.vertices * factors)


def offset(mesh, rng):
    """Move far away from the origin."""
    return _with(mesh, mesh.vertices + rng.normal(size=3) * 10.0 ** rng.uniform(1, 8))


def spikes(mesh, rng):
    """Throw single vertices far out."""
    points = mesh.vertices.copy()
    if mesh.n_vertices:
        points[rng.integers(mesh.n_vertices, size=2)] *= 10.0 ** rng.uniform(1, 6)
    return _with(mesh, points)


def not_finite(mesh, rng):
    """Put NaN or infinity into a coordinate."""
    points = mesh.vertices.copy()
    if mesh.n_vertices:
        points[rng.integers(mesh.n_vertices), rng.integers(3)] = rng.choice([np.nan, np.inf, -np.inf])
    return _with(mesh, points)


def single_precision(mesh, rng):
    """Round to single precision."""
    with np.errstate(over="ignore"):
        return _with(mesh, mesh.vertices.astype(np.float32))


DAMAGES = {
    "noise": noisy,
    "strong noise": lambda mesh, rng: noisy(mesh, rng, 0.8),
    "single precision": single_precision,
    "turned over": lambda mesh, rng: turned_over(mesh, seed=int(rng.integers(99))),
    "mixed polygons": mixed_polygons,
    "loose parts": loose_parts,
    "duplicate faces": duplicate_faces,
    "degenerate faces": degenerate_faces,
    "coincident vertices": coincident_vertices,
    "extreme aspect": extreme_aspect,
    "tiny": _scaled(-12, 0),
    "huge": _scaled(0, 12),
    "offset": offset,
    "spikes": spikes,
    "not finite": not_finite,
}
TAME = ("noise", "turned over", "mixed polygons", "loose parts", "duplicate faces")
"""Damages after which edges are about as long as before, so that rounding stays small."""


class Drawn(SurfaceMesh):
    """A mesh that hypothesis shows by how it was made, instead of all its arrays."""

    made = ""

    def _repr_pretty_(self, printer, is_cycle):
        printer.text(f"<{self.n_vertices} vertices, {self.n_faces} faces: {self.made}>")


@st.composite
def meshes(draw, damages=tuple(DAMAGES), shapes=tuple(SHAPES)):
    """Return a mesh of some shape with up to four damages; its arrays cannot be written to."""
    shape = draw(st.sampled_from(shapes))
    seed, names = draw(SEEDS), draw(st.lists(st.sampled_from(damages), max_size=4))
    rng = np.random.default_rng(seed)
    mesh = SHAPES[shape](rng)
    for name in names:
        mesh = DAMAGES[name](mesh, rng)
    drawn = Drawn.trusted(**vars_of(read_only(mesh)))
    object.__setattr__(drawn, "made", f"{shape}, seed {seed}, {', '.join(names) or 'no damage'}")
    return drawn


def vars_of(mesh):
    """Return the arrays of a mesh by name."""
    return {item.name: getattr(mesh, item.name) for item in fields(SurfaceMesh)}


def _values(info, kind):
    """Return a strategy for the values of a setting: its ends, its default's neighborhood, and between."""
    if info.choices:
        return st.sampled_from([choice.identifier for choice in info.choices])
    low, high = info.minimum, min(info.maximum, 8) if kind == "int" else info.maximum
    if kind == "int":
        return st.integers(int(low), int(high))
    usual = min(info.soft_maximum or info.maximum, high)
    return st.one_of(st.sampled_from([low, high, usual]), st.floats(low, usual))


@st.composite
def denoise_settings(draw):
    """Return a preset, or settings drawn from all that their method allows."""
    if draw(st.booleans()):
        return PRESETS[draw(st.sampled_from(list(PRESETS)))].settings
    method = draw(st.sampled_from(["POSITIONS", "AUTO", "BILATERAL"]))
    values = {"method": method}
    for item in fields(DenoiseSettings):
        info = item.metadata["info"]
        if item.name not in ("method", "threads") and info.has_effect(method):
            values[item.name] = draw(_values(info, str(item.type)))
    values["levels"] = min(values.get("levels", 1), 4)
    # Neighborhoods of the bilateral filter grow with the square, on a hub with more.
    values["sigma_c"] = min(values.get("sigma_c", 1.0), 1.5)
    values["passes"] = min(values.get("passes", 2), 3)
    return DenoiseSettings(**used_settings(values))


class Limits(NamedTuple):
    """What limits a run: a region, and the vertices that may move, shape (N,), bool, or None."""

    region: Region | None
    movable: np.ndarray | None


@st.composite
def limits(draw, mesh, **given):
    """Return limits that fit a mesh, or nearly; `given` are fields of the region that are not drawn."""
    if draw(st.booleans()):
        return Limits(None, None)
    rng, n = np.random.default_rng(draw(SEEDS)), mesh.n_vertices
    with np.errstate(all="ignore"):
        size = np.nan_to_num(np.abs(mesh.vertices[mesh.edges]).max(initial=0.0) if mesh.n_edges else 1.0)
        ends = mesh.vertices[mesh.edges].astype(np.float64)
        edge = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).mean() if mesh.n_edges else 1.0
    edge = float(edge) if np.isfinite(edge) else float(min(size, 1.0))
    weights = [None, rng.random(n), (rng.random(n) < 0.5).astype(np.float32), np.zeros(n), np.ones(n)]
    lines = mesh.edges[rng.random(mesh.n_edges) < rng.choice([0.05, 0.5])]
    values = {
        "weights": weights[draw(st.sampled_from([0, 1, 2, 4, 3]))],
        "feature_edges": draw(st.sampled_from([None, lines, rng.integers(max(n, 1), size=(3, 2))])),
        "max_displacement": draw(st.sampled_from([None, 0.0, 1e-3 * edge, 0.3 * edge, 5.0 * edge])),
        "along_normals": draw(st.booleans()),
        "keep_volume": draw(st.booleans()),
        "weld_distance": draw(st.sampled_from([None, 0.0, 0.1 * edge, 1.1 * edge])),
        "weldable": draw(st.sampled_from([None, rng.random(n) < 0.5])),
        "repair_folds": draw(st.booleans()),
        "straighten_borders": draw(st.booleans()),
    }
    return Limits(Region(**values | given), draw(st.sampled_from([None, rng.random(n) < 0.7])))


def one_sentence(error):
    """Fail unless an error is one sentence for people."""
    text = str(error)
    assert text[0].isupper() and text.endswith(".") and ". " not in text and "\n" not in text, text
