# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A run says what it took for noise: in words, and as structure in its report."""

import json

import numpy as np
from known_shapes import lifted, wide
from meshes import faces_of, noisy, quad_torus, triangle_grid


def denoised(command, write_ply, folder, mesh, *options):
    """Return what a run says of a mesh, and the noise in its report."""
    source = write_ply(folder / "in.ply", mesh.vertices, faces_of(mesh))
    found = command("denoise", source, folder / "out.ply", "--report", folder / "run.json", *options)
    assert found.code == 0
    return found.out, json.loads((folder / "run.json").read_text())["objects"][0]["noise"]


def test_noise_along_the_surface(command, write_ply, tmp_path, rng):
    words, noise = denoised(command, write_ply, tmp_path, noisy(quad_torus(30, 60), rng, 0.15))
    assert f"{noise['along']:.2g} mean edge lengths of it along the surface" in words
    assert 0.05 < noise["along"] < 0.2 and noise["wide"] == noise["shared"] == 0 and noise["steps"] == ""


def test_wide_noise_and_what_may_be_some(command, write_ply, tmp_path, rng):
    clean = quad_torus(40, 60)
    wavy = lifted(clean, 0.3 * wide(clean, rng, 12))
    words, noise = denoised(command, write_ply, tmp_path, wavy)
    assert "clean already; if what is left is noise, it is several edges wide: try --noise wide" in words
    assert noise["is_clean"] and noise["shared"] == 1 and noise["wide"] == 0
    words, noise = denoised(command, write_ply, tmp_path, wavy, "--noise", "wide")
    assert "wide in 100 % of the faces" in words and noise["wide"] == 1


def test_exact_steps(command, write_ply, tmp_path):
    flat = triangle_grid(60, 60)
    rows, columns = np.mgrid[:60, :60].astype(float)
    heights = 4 * np.sin(rows / 9) * np.cos(columns / 11)

    def rounded(step):
        points = np.stack((columns, rows, np.round(heights / step) * step), axis=-1)
        return flat.with_vertices(points.reshape(-1, 3))

    words, noise = denoised(command, write_ply, tmp_path, rounded(1.0))
    assert noise["steps"] == "ROUNDED" and "wide in 100 % of the faces" in words
    ground = rounded(3.0)
    words, noise = denoised(command, write_ply, tmp_path, ground)
    assert "clean already; its heights are in whole steps: --preset tri-2 takes them away." in words
    assert noise["steps"] == "TERRACES"
    words, _ = denoised(command, write_ply, tmp_path, ground, "--preset", "tri-2")
    assert "whole steps" not in words and ", 0 vertices moved" not in words
