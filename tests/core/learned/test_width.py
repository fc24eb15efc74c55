# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which net is taken: by what is measured over each island, and by the user's word."""

import numpy as np
from framelet.core import DenoiseSettings, denoise, vertex_normals
from framelet.core.learned import width as width_module
from framelet.core.learned.features import N_GLOBAL
from framelet.core.learned.width import find_wide
from meshes import noisy, triangle_torus, union

AUTO = DenoiseSettings(method="AUTO", threads=1)


def smooth_noise(mesh, rng, n_averages, sigma=0.2):
    """Return a mesh with noise along its normals that neighbors share, in mean edges."""
    heights = rng.normal(size=mesh.n_vertices)
    ends = np.concatenate((mesh.edges, mesh.edges[:, ::-1]))
    valence = np.bincount(ends[:, 0], minlength=mesh.n_vertices)
    for _ in range(n_averages):
        around = np.bincount(ends[:, 0], heights[ends[:, 1]], mesh.n_vertices) / valence
        heights = (heights + around) / 2
    steps = mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]]
    heights *= sigma * np.linalg.norm(steps, axis=1).mean() / np.sqrt((heights**2).mean())
    return mesh.with_vertices(mesh.vertices + vertex_normals(mesh) * heights[:, None])


def test_the_choice_is_a_regression(rng):
    with np.load(width_module.ARRAYS) as file:
        arrays = {name: file[name].astype(float) for name in file.files}
    rows = rng.normal(size=(200, N_GLOBAL)) * 3 * arrays["scale"] + arrays["mean"]
    expected = []
    for row in rows:
        z = np.clip((row - arrays["mean"]) / arrays["scale"], -3, 3)
        products = [z[i] * z[j] for i in range(len(z)) for j in range(i, len(z))]
        expected.append(float(np.dot([1, *z, *products], arrays["weights"])) > 0)
    found = find_wide(rows.astype(np.float32))
    assert found.dtype == bool and found.tolist() == expected
    assert 0 < found.sum() < len(found)


def test_white_noise_is_fine_and_smooth_noise_is_wide(rng):
    mesh = triangle_torus(40, 60)
    for noise, width in ((noisy(mesh, rng, 0.1), "FINE"), (smooth_noise(mesh, rng, 3), "WIDE")):
        found = denoise(noise, AUTO).vertices
        assert np.array_equal(found, denoise(noise, AUTO.with_changes(noise="FINE")).vertices) == (
            width == "FINE"
        )
        told = denoise(noise, AUTO.with_changes(noise="WIDE")).vertices
        assert np.array_equal(found, told) == (width == "WIDE")


def test_each_island_has_the_net_that_it_needs(rng):
    one, other = noisy(triangle_torus(20, 40), rng, 0.05), smooth_noise(triangle_torus(20, 40), rng, 3)
    both = union(one, other)
    found = denoise(both, AUTO).vertices
    alone = np.concatenate([denoise(mesh, AUTO).vertices for mesh in (one, other)])
    assert np.abs(found - alone).max() < 1e-3
    for width in ("FINE", "WIDE"):
        same = denoise(both, AUTO.with_changes(noise=width)).vertices
        n = one.n_vertices
        assert np.abs(same[:n] - found[:n]).max() < 1e-3 if width == "FINE" else True
        assert (np.abs(same[n:] - found[n:]).max() < 1e-3) == (width == "WIDE")
