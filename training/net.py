# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The net of `core.learned.net` in PyTorch, for gradients."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from torch import nn

from core.learned.engine import FaceEngine
from core.learned.features import FLOOR, N_CONTEXT, N_EDGE, N_FACE, Features
from core.learned.net import HIDDEN, INPUT_HIDDEN, pair_weights
from core.learned.scales import N_SCALES, Scales

from .kernels import Diffuse, FaceSum, LogEnergy, Pairs, PairSum


class Layer(nn.Module):
    """One unrolled step of shrinkage."""

    def __init__(self, repeats: int) -> None:
        super().__init__()
        self.repeats = repeats
        self.from_faces = nn.Linear(HIDDEN, HIDDEN, bias=False)
        self.from_pairs = nn.Linear(N_SCALES + N_EDGE, HIDDEN)
        self.gains = nn.Linear(HIDDEN, N_SCALES)
        self.mixing = nn.Linear(HIDDEN, N_SCALES)
        self.channels = nn.Parameter(0.1 * torch.randn(N_SCALES, N_SCALES))
        self.collect = nn.Linear(2 * HIDDEN + N_SCALES, HIDDEN)
        self.update = nn.Linear(HIDDEN, HIDDEN)
        with torch.no_grad():
            self.update.weight *= 0.3
            self.mixing.weight *= 0.3

    def forward(
        self,
        v: torch.Tensor,
        s: torch.Tensor,
        edge: torch.Tensor,
        share: tuple[torch.Tensor, torch.Tensor],
        pairs: Pairs,
        shifts: Sequence[torch.Tensor],
    ) -> tuple[torch.Tensor, torch.Tensor]:
        of_hidden, of_gains, of_mixing = shifts
        energies = LogEnergy.apply(v, pairs) / 4
        hidden = PairSum.apply(self.from_faces(s), pairs)
        hidden = torch.relu(hidden + self.from_pairs(torch.cat((energies, edge), 1)) + of_hidden)
        gains = torch.sigmoid(self.gains(hidden) + of_gains) * share[0]
        v = Diffuse.apply(v, gains, pairs, self.repeats)
        v = v + torch.tanh(self.mixing(s) + of_mixing)[:, None, :] * (v @ self.channels.T)
        apart = v[:, :, 1:] - v[:, :, :-1]
        lengths = torch.cat(((apart * apart).sum(1), (v[:, :, :1] ** 2).sum(1)), 1)
        around = FaceSum.apply(hidden, pairs) * share[1]
        collected = torch.cat((s, around, torch.log(lengths + float(FLOOR))), 1)
        return v, s + self.update(torch.relu(self.collect(collected)))


class Net(nn.Module):
    """Features and normals of all scales in, a normal for each face out."""

    def __init__(self, repeats: Sequence[int]) -> None:
        super().__init__()
        self.register_buffer("face_mean", torch.zeros(N_FACE))
        self.register_buffer("face_scale", torch.ones(N_FACE))
        self.register_buffer("edge_mean", torch.zeros(N_EDGE))
        self.register_buffer("edge_scale", torch.ones(N_EDGE))
        self.enter = nn.Linear(N_FACE, INPUT_HIDDEN)
        self.begin = nn.Linear(INPUT_HIDDEN, HIDDEN)
        self.layers = nn.ModuleList(Layer(steps) for steps in repeats)
        self.sizes = [HIDDEN, *[HIDDEN, N_SCALES, N_SCALES] * len(self.layers)]
        self.context = nn.Linear(N_CONTEXT, INPUT_HIDDEN)
        self.shift = nn.Linear(INPUT_HIDDEN, sum(self.sizes))
        self.leave = nn.Linear(HIDDEN, N_SCALES)
        with torch.no_grad():
            self.leave.weight *= 0.3
            self.leave.bias.fill_(0.3)
            self.shift.weight.zero_()
            self.shift.bias.zero_()

    def forward(self, scales: Scales, features: Features, engine: FaceEngine) -> torch.Tensor:
        """Return unit normals, shape (F, 3)."""
        graph = engine.graph
        weight, inverse_area = pair_weights(scales, graph)
        pairs = Pairs(graph.first[:-1], graph.second[:-1], weight[:-1], inverse_area)
        count = np.empty(graph.n_faces, np.float32)
        for group in graph.groups:
            count[group.begin : group.end] = len(group.corners)
        largest = np.maximum(count[pairs.first], count[pairs.second])
        share = (torch.from_numpy(1 / (largest + 1))[:, None], torch.from_numpy(1 / count)[:, None])
        v = torch.from_numpy(np.ascontiguousarray(scales.normals.transpose(1, 0, 2)))
        x = (torch.from_numpy(features.faces) - self.face_mean) / self.face_scale
        edge = (torch.from_numpy(features.pairs[:-1]) - self.edge_mean) / self.edge_scale
        edge = edge.clamp(-6, 6)
        context = torch.from_numpy(features.context)
        known = (context - self.face_mean[-N_CONTEXT:]) / self.face_scale[-N_CONTEXT:]
        shifts = self.shift(torch.relu(self.context(known.clamp(-6, 6)))).split(self.sizes, dim=1)
        of_pairs = of_faces = slice(None)
        if features.island is not None:
            of_faces, of_pairs = features.island, features.island[pairs.first]
        s = self.begin(torch.relu(self.enter(x.clamp(-6, 6)))) + shifts[0][of_faces]
        for number, layer in enumerate(self.layers):
            of_hidden, of_gains, of_mixing = shifts[1 + 3 * number : 4 + 3 * number]
            own = (of_hidden[of_pairs], of_gains[of_pairs], of_mixing[of_faces])
            v, s = layer(v, s, edge, share, pairs, own)
        normals = (v * self.leave(s)[:, None, :]).sum(2)
        return normals / (normals.norm(dim=1, keepdim=True) + 1e-6)

    def export(self, path: Path, **provenance: str) -> None:
        """Write all arrays to a file of NumPy, with where they come from."""
        arrays = {
            name: value.detach().numpy().astype(np.float32) for name, value in self.state_dict().items()
        }
        repeats = np.array([layer.repeats for layer in self.layers], np.int32)
        np.savez_compressed(
            path, **arrays, repeats=repeats, **{key: np.array(text) for key, text in provenance.items()}
        )
