# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Learned shrinkage of normals: an unrolled shrinkage in the pairwise frame, with learned gains.

The state of a face is its normal V at all scales and a few scalars s that do not depend on pose. A layer
takes the frame coefficients D_e = V_g - V_f of the pairs e of faces, makes a gain for each coefficient of
each scale out of invariant numbers, and takes a step of shrinkage, which for the pairwise frame is

    V_f <- V_f + sum over e at f of c_e g_e (V_g - V_f) / area_f,  c_e = 2 area_f area_g / (area_f + area_g).

Normals enter linearly only, so that the result turns with the mesh by construction.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..scratch import Scratch
from .face_graph import FACES_AT_ONCE, FaceGraph, Polygons
from .features import FLOOR, N_CONTEXT, Features
from .rows import Bias, Matrix, product, tiled, times
from .scales import N_SCALES, Scales

HIDDEN = 16
"""Scalars of a face, and of a pair."""

INPUT_HIDDEN = 32

N_LAYERS = 8

CLIP = np.float32(6)
"""Standardized inputs are cut off here: far out the net has seen nothing."""

LEAST_AREA, MOST_AREA = np.float32(1e-4), np.float32(1e15)
"""Least and largest area of a face, in squares of the local unit, so that weights stay finite."""

WEIGHTS = {width: Path(__file__).with_name(f"{width}.npz") for width in ("fine", "wide")}
"""The arrays that come with Framelet: for noise from vertex to vertex, and for noise that neighbors share."""


class Layer(NamedTuple):
    """Arrays of a layer, ready for rows times matrix; biases of faces are repeated over a block."""

    from_faces: Matrix
    from_energies: Matrix
    from_pairs: Matrix
    gains: Matrix
    gain_bias: Matrix
    mixing: Matrix
    mixing_bias: Matrix
    channels: Matrix
    collect_state: Matrix
    collect_around: Matrix
    collect_lengths: Matrix
    collect_bias: Matrix
    update: Matrix
    update_bias: Matrix


class Net:
    """The learned arrays.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        As `training` writes them; `repeats`, shape (N_LAYERS,), are the steps with the same gains.
    """

    def __init__(self, arrays: Mapping[str, Matrix]) -> None:
        self.face_mean, self.face_scale = arrays["face_mean"], arrays["face_scale"]
        self.edge_mean, self.edge_scale = arrays["edge_mean"], arrays["edge_scale"]
        self.enter, self.enter_bias = arrays["enter.weight"].T, tiled(arrays["enter.bias"])
        self.begin, self.begin_bias = arrays["begin.weight"].T, arrays["begin.bias"]
        self.context, self.context_bias = arrays["context.weight"].T, arrays["context.bias"]
        self.shift, self.shift_bias = arrays["shift.weight"].T, arrays["shift.bias"]
        self.leave, self.leave_bias = arrays["leave.weight"].T, tiled(arrays["leave.bias"])
        self.repeats = arrays["repeats"].tolist()
        self.layers = [_layer(arrays, f"layers.{number}.") for number in range(len(self.repeats))]

    def normals(
        self,
        scales: Scales,
        features: Features,
        graph: FaceGraph,
        tick: Callable[[], None] = lambda: None,
    ) -> NDArray[np.float32]:
        """Return clean unit normals of the faces of a graph, shape (3, F).

        `tick` is called after each layer. The normals of `scales` are overwritten.
        """
        return self.begun(scales, features, graph).normals(tick)

    def shifts(self, context: Matrix) -> list[Matrix]:
        """Make biases of state and layers, shape (I, n), of the context of islands, shape (I, N_CONTEXT)."""
        known = (context - self.face_mean[-N_CONTEXT:]) / self.face_scale[-N_CONTEXT:]
        hidden = np.maximum(np.clip(known, -CLIP, CLIP) @ self.context + self.context_bias, 0)
        sizes = [HIDDEN, *[HIDDEN, N_SCALES, N_SCALES] * len(self.layers)]
        return np.split(hidden @ self.shift + self.shift_bias, np.cumsum(sizes)[:-1], axis=1)

    def begun(self, scales: Scales, features: Features, graph: FaceGraph) -> NetRun:
        """Return a run that has taken in the features, so that their memory can be used for the rest."""
        return NetRun(self, scales, features, graph)


@cache
def load_net(width: str) -> Net:
    """Read the arrays that come with Framelet for "fine" or "wide" noise."""
    with np.load(WEIGHTS[width]) as file:
        return Net({name: file[name] for name in file.files if file[name].dtype.kind in "fi"})


def pair_weights(scales: Scales, graph: FaceGraph) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return c_e of the pairs, shape (P + 1,), and 1 / area of the faces, shape (F,), in local units."""
    areas = np.clip(scales.areas[:, 0] / (scales.length * scales.length), LEAST_AREA, MOST_AREA)
    one, two = areas.take(graph.first), areas.take(graph.second)
    weight = one * two
    weight *= np.float32(2)
    weight /= one + two
    return weight, np.reciprocal(areas)


class NetRun:
    """A run of the net on a mesh: the state of faces and pairs."""

    def __init__(self, net: Net, scales: Scales, features: Features, graph: FaceGraph) -> None:
        self.net, self.graph = net, graph
        n_faces, n_pairs = graph.n_faces, graph.n_pairs
        self.vectors = scales.normals
        self.state = np.empty((n_faces, HIDDEN), np.float32)
        self.offer = np.empty((n_faces, HIDDEN), np.float32)
        weight, inverse_area = pair_weights(scales, graph)
        self.inverse_area = np.repeat(inverse_area[:, None], N_SCALES, axis=1)
        self.factor = self._factor(weight)
        self.scratch = Scratch()
        self.zeros = np.zeros((FACES_AT_ONCE, HIDDEN), np.float32)
        first, *others = net.shifts(features.context)
        begin_bias = Bias(first + net.begin_bias, features.island)
        # Each of the two faces of a pair offers half.
        self.hidden_bias = [Bias(np.float32(0.5) * rows, features.island) for rows in others[::3]]
        self.gain_bias = [
            # A logistic function is half of 1 + tanh of the half.
            Bias(np.float32(0.5) * rows + layer.gain_bias, features.island)
            for rows, layer in zip(others[1::3], net.layers, strict=True)
        ]
        self.mixing_bias = [
            Bias(rows + layer.mixing_bias, features.island)
            for rows, layer in zip(others[2::3], net.layers, strict=True)
        ]
        self.edge = np.ones((n_pairs, features.pairs.shape[1] + 1), np.float32)

        def standardize(start: int, stop: int) -> None:
            part = features.pairs[start:stop] - net.edge_mean
            part /= net.edge_scale
            np.clip(part, -CLIP, CLIP, out=self.edge[start:stop, :-1])

        graph.for_pairs(standardize)

        def begin(faces: slice, polygons: Polygons) -> None:
            part = features.block(faces, polygons)
            part -= net.face_mean
            part /= net.face_scale
            np.clip(part, -CLIP, CLIP, out=part)
            hidden = product(part, net.enter, net.enter_bias)
            np.maximum(hidden, np.float32(0), out=hidden)
            state = product(hidden, net.begin, begin_bias.of(faces, len(part)))
            self.state[faces] = state
            self._offer(0, faces, state)

        graph.for_faces(begin)

    def _factor(self, weight: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return what (1 + tanh) of a pair is multiplied with, shape (P, S): c_e / (2 (K + 1))."""
        graph = self.graph
        count = np.empty(graph.n_faces, np.float32)
        for group in graph.groups:
            count[group.begin : group.end] = len(group.corners)
        factor = np.empty((graph.n_pairs, N_SCALES), np.float32)

        def kernel(start: int, stop: int) -> None:
            largest = np.maximum(count.take(graph.first[start:stop]), count.take(graph.second[start:stop]))
            largest += 1
            part = np.float32(0.5) * weight[start:stop]
            part /= largest
            factor[start:stop] = part[:, None]

        graph.for_pairs(kernel)
        return factor

    def _offer(self, number: int, faces: slice, state: Matrix) -> None:
        """Tell the pairs of some faces what a layer makes of their state."""
        bias = self.hidden_bias[number].of(faces, len(state))
        product(state, self.net.layers[number].from_faces, bias, self.offer[faces])

    def normals(self, tick: Callable[[], None]) -> NDArray[np.float32]:
        """Go through all layers and return unit normals, shape (3, F)."""
        n_pairs = self.graph.n_pairs
        # Made here, where the memory of scales and features may be free again.
        self.following = np.empty_like(self.vectors)
        self.hidden = np.zeros((n_pairs + 1, HIDDEN), np.float32)
        self.gates = np.zeros((n_pairs + 1, N_SCALES), np.float32)
        for number, repeats in enumerate(self.net.repeats):
            self.graph.for_pairs(partial(self._make_gates, number))
            for step in range(repeats):
                is_last = step == repeats - 1
                self.graph.for_faces(partial(self._diffuse, number, is_last=is_last))
                self.vectors, self.following = self.following, self.vectors
            tick()
        normals = np.empty(self.vectors.shape[:2], np.float32)

        def leave(start: int, stop: int) -> None:
            share = product(self.state[start:stop], self.net.leave, self.net.leave_bias)
            for axis in range(3):
                part = share * self.vectors[axis, start:stop]
                normals[axis, start:stop] = part.sum(axis=1)
            own = normals[:, start:stop]
            length = np.sqrt((own * own).sum(axis=0))
            length += np.float32(1e-6)
            own /= length

        self.graph.blocks.run(leave, self.graph.n_faces)
        return normals

    def _make_gates(self, number: int, start: int, stop: int) -> None:
        """Make the gains of some pairs: what their faces offer, energies and features say how much."""
        layer = self.net.layers[number]
        one, two, n = self.graph.first[start:stop], self.graph.second[start:stop], stop - start
        scratch = self.scratch
        energies, apart = scratch("energies", n, N_SCALES), scratch("apart", n, N_SCALES)
        other = scratch("other", n, N_SCALES)
        energies.fill(FLOOR)
        for plane in self.vectors:
            np.take(plane, two, axis=0, out=apart, mode="clip")
            apart -= np.take(plane, one, axis=0, out=other, mode="clip")
            apart *= apart
            energies += apart
        np.log(energies, out=energies)
        hidden, part = self.hidden[start:stop], scratch("part", n, HIDDEN)
        times(self.edge[start:stop], layer.from_pairs, hidden)
        hidden += times(energies, layer.from_energies, part)
        hidden += np.take(self.offer, one, axis=0, out=part, mode="clip")
        hidden += np.take(self.offer, two, axis=0, out=part, mode="clip")
        np.maximum(hidden, self.zeros[:n], out=hidden)
        gates = times(hidden, layer.gains, self.gates[start:stop])
        gates += self.gain_bias[number].of(one, n)
        np.tanh(gates, out=gates)
        gates += np.float32(1)
        gates *= self.factor[start:stop]

    def _diffuse(self, number: int, faces: slice, polygons: Polygons, *, is_last: bool) -> None:
        """Take a step of shrinkage for some faces; after the last one of a layer, mix scales and update s."""
        layer = self.net.layers[number]
        scratch, n = self.scratch, faces.stop - faces.start
        inverse = self.inverse_area[faces]
        step, total = (
            scratch("step", n, N_SCALES),
            [scratch(f"total {axis}", n, N_SCALES) for axis in range(3)],
        )
        gate = scratch("gate", n, N_SCALES)
        for slot, (neighbors, pairs) in enumerate(zip(polygons.neighbors, polygons.pairs, strict=True)):
            np.take(self.gates, pairs, axis=0, out=gate, mode="clip")
            for axis, plane in enumerate(self.vectors):
                own = step if slot else total[axis]
                np.take(plane, neighbors, axis=0, out=own, mode="clip")
                own -= plane[faces]
                own *= gate
                if slot:
                    total[axis] += step
        for axis, plane in enumerate(self.vectors):
            total[axis] *= inverse
            total[axis] += plane[faces]
            if not is_last:
                self.following[axis, faces] = total[axis]
        if not is_last:
            return
        state, part = self.state[faces], scratch("part", n, HIDDEN)
        mixing = product(state, layer.mixing, self.mixing_bias[number].of(faces, n), gate)
        np.tanh(mixing, out=mixing)
        lengths = scratch("energies", n, N_SCALES)
        lengths.fill(FLOOR)
        for axis, own in enumerate(total):
            mixed = times(own, layer.channels, step)
            mixed *= mixing
            own += mixed
            self.following[axis, faces] = own
            # Differences of scales, and the finest scale itself, by a constant matrix.
            apart = times(own, _APART, step)
            apart *= apart
            lengths += apart
        np.log(lengths, out=lengths)
        around = np.take(
            self.hidden, polygons.pairs[0], axis=0, out=scratch("around", n, HIDDEN), mode="clip"
        )
        for pairs in polygons.pairs[1:]:
            around += np.take(self.hidden, pairs, axis=0, out=part, mode="clip")
        around *= np.float32(1.0 / len(polygons.pairs))
        collected = product(state, layer.collect_state, layer.collect_bias, scratch("collected", n, HIDDEN))
        collected += times(around, layer.collect_around, part)
        collected += times(lengths, layer.collect_lengths, part)
        np.maximum(collected, self.zeros[:n], out=collected)
        state += product(collected, layer.update, layer.update_bias, part)
        if number + 1 < len(self.net.layers):
            self._offer(number + 1, faces, state)


_APART = np.zeros((N_SCALES, N_SCALES), np.float32)
_APART[range(N_SCALES - 1), range(N_SCALES - 1)] = -1
_APART[range(1, N_SCALES), range(N_SCALES - 1)] = 1
_APART[0, N_SCALES - 1] = 1


def _layer(arrays: Mapping[str, Matrix], prefix: str) -> Layer:
    """Return the arrays of a layer, turned and split for the order of the work."""

    def weight(name: str) -> Matrix:
        return np.ascontiguousarray(arrays[f"{prefix}{name}.weight"].T)

    def bias(name: str) -> Matrix:
        return arrays[f"{prefix}{name}.bias"]

    from_pairs, collect = weight("from_pairs"), weight("collect")
    return Layer(
        weight("from_faces"),
        from_pairs[:N_SCALES] * np.float32(0.25),
        np.vstack((from_pairs[N_SCALES:], bias("from_pairs"))),
        weight("gains") * np.float32(0.5),
        bias("gains") * np.float32(0.5),
        weight("mixing"),
        bias("mixing"),
        np.ascontiguousarray(arrays[f"{prefix}channels"].T),
        collect[:HIDDEN],
        collect[HIDDEN : 2 * HIDDEN],
        collect[2 * HIDDEN :],
        tiled(bias("collect")),
        weight("update"),
        tiled(bias("update")),
    )
