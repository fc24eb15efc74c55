# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The promises of section 6 and perfect reconstruction of every bank, on the development meshes."""

import numpy as np
import pytest
from framelet.core import BANKS, connect, make_transform
from framelet.core.frames.valence_masks import FAMILIES
from mesh_files import mesh_files, read_mesh

EXACT = 1e-12
KINDS = pytest.mark.parametrize("kind", ["tri", "quad", "mixed", "nonmanifold", "scan", "bad"])


def meshes_in(folder, kind, largest=10**9):
    """Yield name, mesh and connectivity of the files up to a size that are surfaces; the same faces once."""
    for path in mesh_files(folder, kind):
        if "_noisy" in path.stem or path.stat().st_size > largest:
            continue
        mesh = read_mesh(path, np.float64)
        if mesh.n_faces and np.isfinite(mesh.vertices).all():
            yield path.name, mesh, connect(mesh)


def made(mesh, frame, n_levels, connectivity, stencil="ADAPTIVE", boundary="ALONG"):
    """Return the transform, with fewer levels if the mesh is too small for as many."""
    while True:
        try:
            return make_transform(
                mesh, frame, stencil, n_levels, connectivity=connectivity, boundary=boundary
            )
        except ValueError as error:
            if "too small" not in str(error):
                raise
            n_levels -= 1


@KINDS
def test_adaptive_frames_are_tight(shared_meshes, kind):
    """W*W = I, and energy is conserved: four levels, on meshes of 2000 vertices and more fewer of them.

    Both families choose their neighbors alike, so the pairwise one takes every second of the smaller meshes.
    """
    n_deep = 0
    largest = 10**9 if kind == "scan" else 10**6
    for number, (name, mesh, connectivity) in enumerate(meshes_in(shared_meshes, kind, largest)):
        n = mesh.n_vertices
        n_levels = 4 if n < 2000 else 3 if n < 3000 or name == "botijo10k.ply" else 2 if n < 10500 else 1
        for frame in FAMILIES if n < 1500 and number % 2 == 0 else ["ADAPTIVE"]:
            transform = made(mesh, frame, n_levels, connectivity)
            levels = transform.levels
            found = transform.analyze(mesh.vertices)
            error = np.abs(transform.weighted_adjoint(found) - mesh.vertices).max()
            assert error <= EXACT * np.abs(mesh.vertices).max(), name
            measures = transform.measures()
            assert len(measures) == len(levels) + 1
            energy = measures[-1] @ (found.low**2).sum(axis=1)
            for level, chunks in enumerate(found.chunks):
                for sites, chunk in zip(levels[level].sites, chunks, strict=True):
                    energy += measures[level + 1][sites] @ (chunk**2).sum(axis=(0, 1))
            before = measures[0] @ (mesh.vertices**2).sum(axis=1)
            assert energy == pytest.approx(before, rel=EXACT), name
            n_deep += len(levels) == 4
    assert n_deep >= {"tri": 0, "quad": 5, "scan": 0, "nonmanifold": 2, "mixed": 3, "bad": 5}[kind]


@pytest.mark.parametrize("kind", ["tri", "quad", "mixed", "nonmanifold", "bad"])
def test_every_bank_reconstructs(shared_meshes, kind):
    """Each mesh takes three of the banks, in turn, and larger ones a single one."""
    names, used = list(BANKS), set()
    turn = 0
    for name, mesh, connectivity in meshes_in(shared_meshes, kind, largest=320_000):
        small = mesh.n_vertices < 1500
        for _ in range(3 if small else 1):
            frame, rule = names[turn % len(names)], ("MEAN", "STRAIGHT")[turn % 2]
            turn += 1
            try:
                transform = made(
                    mesh, frame, 2 if small else 1, connectivity, rule, ("ALONG", "FREE")[turn % 3 == 0]
                )
            except ValueError as error:
                assert "but the mesh has none" in str(error), name
                continue
            error = np.abs(transform.synthesize(transform.analyze(mesh.vertices)) - mesh.vertices).max()
            assert error <= EXACT * np.abs(mesh.vertices).max(), (name, frame)
            used.add(frame)
    assert len(used) >= {"quad": 11, "bad": 11, "mixed": 4, "nonmanifold": 3, "tri": 3}[kind]
