# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What faces and pairs of faces tell each other, forward and adjoint, compiled.

Plain indexing in PyTorch takes several times as long, above all backward.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np
import torch
from numpy.typing import NDArray

FLOOR = 1e-4


class Pairs(NamedTuple):
    """Faces of pairs, shapes (P,), int32; pair weights (P,) and inverse areas (F,) of the diffusion."""

    first: NDArray[np.int32]
    second: NDArray[np.int32]
    weight: NDArray[np.float32]
    inverse_area: NDArray[np.float32]


_jit = numba.njit(fastmath=True, cache=True)


@_jit
def _gather(x, first, second, out):  # type: ignore[no-untyped-def]
    for e in range(len(first)):
        f, g = first[e], second[e]
        for c in range(x.shape[1]):
            out[e, c] = x[f, c] + x[g, c]


@_jit
def _scatter(y, first, second, out):  # type: ignore[no-untyped-def]
    for e in range(len(first)):
        f, g = first[e], second[e]
        for c in range(y.shape[1]):
            value = y[e, c]
            out[f, c] += value
            out[g, c] += value


@_jit
def _energies(v, first, second, out):  # type: ignore[no-untyped-def]
    for e in range(len(first)):
        f, g = first[e], second[e]
        for c in range(v.shape[2]):
            total = np.float32(FLOOR)
            for a in range(3):
                d = v[g, a, c] - v[f, a, c]
                total += d * d
            out[e, c] = total


@_jit
def _energies_back(v, first, second, factor, out):  # type: ignore[no-untyped-def]
    for e in range(len(first)):
        f, g = first[e], second[e]
        for c in range(v.shape[2]):
            for a in range(3):
                step = factor[e, c] * (v[g, a, c] - v[f, a, c])
                out[g, a, c] += step
                out[f, a, c] -= step


@_jit
def _flow(v, gain, first, second, weight, out):  # type: ignore[no-untyped-def]
    for e in range(len(first)):
        f, g = first[e], second[e]
        for c in range(v.shape[2]):
            share = weight[e] * gain[e, c]
            for a in range(3):
                step = share * (v[g, a, c] - v[f, a, c])
                out[f, a, c] += step
                out[g, a, c] -= step


@_jit
def _gain_back(v, u, first, second, weight, out):  # type: ignore[no-untyped-def]
    for e in range(len(first)):
        f, g = first[e], second[e]
        for c in range(v.shape[2]):
            total = np.float32(0)
            for a in range(3):
                total += (v[g, a, c] - v[f, a, c]) * (u[f, a, c] - u[g, a, c])
            out[e, c] += weight[e] * total


class PairSum(torch.autograd.Function):
    """x (F, C) to x_f + x_g (P, C)."""

    @staticmethod
    def forward(ctx: Any, x: torch.Tensor, pairs: Pairs) -> torch.Tensor:
        ctx.pairs, ctx.n_faces = pairs, len(x)
        out = torch.empty(len(pairs.first), x.shape[1])
        _gather(x.detach().numpy(), pairs.first, pairs.second, out.numpy())
        return out

    @staticmethod
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor, None]:
        out = torch.zeros(ctx.n_faces, grad.shape[1])
        _scatter(grad.contiguous().numpy(), ctx.pairs.first, ctx.pairs.second, out.numpy())
        return out, None


class FaceSum(torch.autograd.Function):
    """The adjoint of `PairSum`: y (P, C) to the sum over the pairs of each face, (F, C)."""

    @staticmethod
    def forward(ctx: Any, y: torch.Tensor, pairs: Pairs) -> torch.Tensor:
        ctx.pairs = pairs
        out = torch.zeros(len(pairs.inverse_area), y.shape[1])
        _scatter(y.detach().numpy(), pairs.first, pairs.second, out.numpy())
        return out

    @staticmethod
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor, None]:
        out = torch.empty(len(ctx.pairs.first), grad.shape[1])
        _gather(grad.contiguous().numpy(), ctx.pairs.first, ctx.pairs.second, out.numpy())
        return out, None


class LogEnergy(torch.autograd.Function):
    """V (F, 3, C) to log(|V_g - V_f|^2 + floor) (P, C)."""

    @staticmethod
    def forward(ctx: Any, v: torch.Tensor, pairs: Pairs) -> torch.Tensor:
        ctx.pairs = pairs
        energy = torch.empty(len(pairs.first), v.shape[2])
        _energies(v.detach().numpy(), pairs.first, pairs.second, energy.numpy())
        ctx.save_for_backward(v, energy)
        return energy.log()

    @staticmethod
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor, None]:
        v, energy = ctx.saved_tensors
        out = torch.zeros_like(v)
        factor = (2 * grad / energy).contiguous()
        _energies_back(v.numpy(), ctx.pairs.first, ctx.pairs.second, factor.numpy(), out.numpy())
        return out, None


class Diffuse(torch.autograd.Function):
    """V_f + sum over the pairs of f of c_e g_e (V_g - V_f) / area_f, repeated with the same gains (P, C)."""

    @staticmethod
    def forward(ctx: Any, v: torch.Tensor, gain: torch.Tensor, pairs: Pairs, repeats: int) -> torch.Tensor:
        inverse = torch.from_numpy(pairs.inverse_area)[:, None, None]
        states = []
        gains = gain.detach().contiguous()
        for _ in range(repeats):
            states.append(v.detach())
            flow = torch.zeros_like(v)
            _flow(states[-1].numpy(), gains.numpy(), pairs.first, pairs.second, pairs.weight, flow.numpy())
            v = states[-1] + flow.mul_(inverse)
        ctx.pairs, ctx.gains, ctx.states, ctx.inverse = pairs, gains, states, inverse
        return v

    @staticmethod
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, None, None]:
        pairs = ctx.pairs
        of_gain = torch.zeros_like(ctx.gains)
        grad = grad.contiguous()
        for state in reversed(ctx.states):
            u = grad * ctx.inverse
            _gain_back(state.numpy(), u.numpy(), pairs.first, pairs.second, pairs.weight, of_gain.numpy())
            # The flow is symmetric in V, so its adjoint is the flow of the gradient over the area.
            flow = torch.zeros_like(grad)
            _flow(u.numpy(), ctx.gains.numpy(), pairs.first, pairs.second, pairs.weight, flow.numpy())
            grad = grad + flow
        return grad, of_gain, None, None
