# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Learn which of the two nets will be closer to the clean surface: the arrays of `core.learned.width`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from core.learned.width import terms

from .net import Net
from .train import MOST_FACES, Draw, both_passes, load

RIDGE = 20.0
"""Penalty on the squares of the weights: draws are few beside terms."""

FARTHEST = 0.5
"""Largest logarithm of a ratio of errors: how much better a net is counts up to here."""


def compare(
    nets: dict[str, Net], shapes: Path, n_draws: int, seed: int
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Run both nets on noise of both mixtures.

    Returns
    -------
    quantiles : ndarray, shape (n_draws, N_GLOBAL), float32
    gains : ndarray, shape (n_draws,), float32
        Loss of the net for fine noise minus that of the net for wide noise: positive where wide is better.
    """
    rng = np.random.default_rng(seed)
    paths = sorted(shapes.glob("*.npz"))
    quantiles, gains = [], []
    while len(gains) < n_draws:
        width = ("fine", "wide")[len(gains) % 2]
        mesh = load(paths[rng.integers(len(paths))], rng, width)
        if mesh.engine.graph.n_faces > MOST_FACES:
            continue
        draw = Draw(mesh, rng, width)
        with torch.no_grad():
            fine, wide = (both_passes(nets[width], draw, (1, 1))[1] for width in ("fine", "wide"))
        if np.isfinite(fine) and np.isfinite(wide):
            # Islands are rare in training; the one with the most faces stands for the mesh.
            features = draw.described()[1]
            quantiles.append(features.quantiles[features.n_measured.argmax()])
            gains.append(fine - wide)
    return np.array(quantiles, np.float32), np.array(gains, np.float32)


def fit(quantiles: NDArray[np.float32], gains: NDArray[np.float32], target: Path) -> tuple[float, float]:
    """Fit the regression and write its arrays.

    Returns the mean gain of the choice on draws that were kept aside, and of the best choice there.
    """
    mean, scale = quantiles.mean(axis=0), quantiles.std(axis=0) + np.float32(0.05)
    rows = terms(quantiles, mean, scale).astype(np.float64)
    wanted = gains.clip(-FARTHEST, FARTHEST)

    def weights_of(own: NDArray[np.bool_]) -> NDArray[np.float64]:
        form = rows[own].T @ rows[own] + RIDGE * np.eye(rows.shape[1])
        return np.linalg.solve(form, rows[own].T @ wanted[own])

    is_kept = np.arange(len(gains)) % 5 == 4
    chosen = rows[is_kept] @ weights_of(~is_kept) > 0
    weights = weights_of(np.ones(len(gains), bool)).astype(np.float32)
    np.savez_compressed(target, mean=mean, scale=scale, weights=weights)
    return float((gains[is_kept] * chosen).mean()), float(gains[is_kept].clip(0).mean())
