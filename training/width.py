# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Learn which of the two nets will be closer to the clean surface: the arrays of `core.learned.width`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from .net import Net
from .train import MOST_FACES, Draw, both_passes, load

HIDDEN = 12
N_STEPS = 1500
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
        mesh = load(paths[rng.integers(len(paths))], rng)
        if mesh.engine.graph.n_faces > MOST_FACES:
            continue
        draw = Draw(mesh, rng, ("fine", "wide")[len(gains) % 2])
        with torch.no_grad():
            fine, wide = (both_passes(nets[width], draw, (1, 1))[1] for width in ("fine", "wide"))
        if np.isfinite(fine) and np.isfinite(wide):
            # Islands are rare in training; the one with the most faces stands for the mesh.
            quantiles.append(np.median(draw.described()[1].quantiles, axis=0))
            gains.append(fine - wide)
    return np.array(quantiles, np.float32), np.array(gains, np.float32)


def fit(quantiles: NDArray[np.float32], gains: NDArray[np.float32], target: Path) -> tuple[float, float]:
    """Fit the regression and write its arrays.

    Returns the mean gain of the choice on draws that were kept aside, and of the best choice there.
    """
    torch.manual_seed(0)
    is_kept = np.arange(len(gains)) % 5 == 4
    mean, scale = quantiles.mean(axis=0), quantiles.std(axis=0) + np.float32(0.05)
    rows = torch.from_numpy((quantiles - mean) / scale)
    wanted = torch.from_numpy(gains.clip(-FARTHEST, FARTHEST))
    enter, leave = nn.Linear(rows.shape[1], HIDDEN), nn.Linear(HIDDEN, 1)
    model = nn.Sequential(enter, nn.Tanh(), leave, nn.Flatten(0))
    optimizer = torch.optim.AdamW(model.parameters(), lr=0.01, weight_decay=0.1)
    learned, kept = torch.from_numpy(~is_kept), torch.from_numpy(is_kept)
    for step in range(N_STEPS):
        optimizer.param_groups[0]["lr"] = 0.01 * (1 - step / N_STEPS)
        # A little noise in the inputs, so that the choice does not hang on single draws.
        noisy = rows[learned] + 0.1 * torch.randn(int(learned.sum()), rows.shape[1])
        loss = nn.functional.smooth_l1_loss(model(noisy), wanted[learned], beta=0.1)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    with torch.no_grad():
        chosen = (model(rows[kept]) > 0).numpy()
    arrays = {
        "mean": mean,
        "scale": scale,
        "enter": enter.weight.detach().numpy().T,
        "enter_bias": enter.bias.detach().numpy(),
        "leave": leave.weight.detach().numpy()[0],
        "least": -leave.bias.detach().numpy()[0],
    }
    np.savez_compressed(target, **{name: np.asarray(array, np.float32) for name, array in arrays.items()})
    return float((gains[is_kept] * chosen).mean()), float(gains[is_kept].clip(0).mean())
