# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Train the net: on whole meshes, with noise that is drawn anew each time, both passes at once.

A run that was cut off goes on from its last checkpoint.
"""

from __future__ import annotations

import ctypes
import sys
import time
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from core.learned.features import Features
from core.learned.scales import Scales

from . import noise
from .net import Net
from .sample_mesh import SampleMesh
from .shapes.catalog import family_of, is_coarse

LARGEST_RATE = 0.006
CHECKPOINT_SECONDS = 120
VALIDATION_STEPS = 1500
LOSS_FLOOR = 0.004
AVERAGE = 0.998
"""Decay of the running mean of the weights, which is what is exported; less at the start."""

RELIEF = {"fine": 0.3, "wide": 0.03}
"""Share of the shapes with relief that keep all of it. It is finer than that of most real meshes, which are
sampled until nothing is finer than a few edges; with all of it wide noise is taken for relief."""

SMOOTHEST = 200
"""Most averages over the others, down to 4. Shapes of ten thousand faces bend as much from face to face with
few averages as real meshes, which have more faces, with many."""

SCANS = 2
"""How often range images are drawn for once that others are: what scanners make is what has to be right."""

REPEATS = {"fine": (1, 2, 2, 2, 2, 2, 2, 1), "wide": (2, 3, 4, 4, 4, 4, 3, 2)}
"""Steps of shrinkage with the same gains, for each layer. What is wide has to come from farther away."""

WARM_UP = 0.02
"""Share of the time in which the learning rate rises."""

INSIDE_OUT = 0.35
"""Share of the draws that are turned inside out."""

ONE_PASS, SOME = 0.25, 0.3
"""Up to this share of the time only some of the steps train the second pass: the first has to work before."""

MOST_FACES = 21_000


class Draw:
    """A clean mesh with noise."""

    def __init__(self, mesh: SampleMesh, rng: np.random.Generator, width: str) -> None:
        positions, self.kind = noise.draw(mesh, rng, width)
        self.engine = mesh.engine.for_positions(mesh.surface.with_vertices(positions), mesh.connectivity)
        self.points = np.ascontiguousarray(positions.T, np.float32)
        wanted = mesh.normals.copy()
        if rng.random() < INSIDE_OUT:
            # All inputs are scalar products: a mirror image is the same as a mesh that is inside out.
            self.points[0] *= -1
            wanted[1:] *= -1
        self.wanted = torch.from_numpy(np.ascontiguousarray(wanted.T))
        cluster = mesh.clusters(rng)
        self.is_counted = torch.from_numpy(cluster >= 0)
        self.cluster = torch.from_numpy(cluster[cluster >= 0])
        self.n_faces = torch.bincount(self.cluster).clamp(min=1).float()

    def described(self, normals: NDArray[np.float32] | None = None) -> tuple[Scales, Features]:
        """Return what the net sees: of the noisy mesh, or of the mesh that fits wanted normals (3, F)."""
        if normals is None:
            return self.engine.describe(self.points)
        points = self.engine.fit.fit(self.points, normals)
        return self.engine.describe(points, self.engine.residual(self.points, points))

    def loss(self, normals: torch.Tensor) -> torch.Tensor:
        """Return the mean over clusters of log(mean |n - n*| + floor)."""
        apart = (normals - self.wanted)[self.is_counted].norm(dim=1)
        total = torch.zeros(len(self.n_faces)).index_add(0, self.cluster, apart)
        return torch.log(total / self.n_faces + LOSS_FLOOR).mean()


def both_passes(net: Net, draw: Draw, weights: Sequence[float]) -> tuple[float, float]:
    """Add the gradients of both passes, if they are wanted, and return both losses."""
    losses = []
    found = None
    for weight in weights:
        scales, features = draw.described(found)
        normals = net(scales, features, draw.engine)
        loss = draw.loss(normals)
        if torch.is_grad_enabled():
            (weight * loss).backward()
        losses.append(float(loss.detach()))
        found = np.ascontiguousarray(normals.detach().numpy().T)
    return losses[0], losses[-1]


def standardize(net: Net, draws: Sequence[Draw]) -> None:
    """Set means and deviations of the inputs to those of some draws."""
    found = [draw.described()[1] for draw in draws]
    for name, parts in (
        ("face", [item.faces for item in found]),
        ("edge", [item.pairs[:-1] for item in found]),
    ):
        rows = np.concatenate([part[:: max(1, len(part) // 2000)] for part in parts])
        getattr(net, f"{name}_mean").copy_(torch.from_numpy(rows.mean(axis=0)))
        # Columns that are the same everywhere here, such as what no pass before took away, stay as they are.
        spread = np.where(rows.std(axis=0) < 1e-6, 1.0, np.maximum(rows.std(axis=0), 0.05))
        getattr(net, f"{name}_scale").copy_(torch.from_numpy(spread.astype(np.float32)))


def validate(net: Net, draws: Sequence[Draw]) -> tuple[float, str]:
    """Return the mean loss of the second pass, and the losses of each kind of noise as text."""
    by_kind = defaultdict(list)
    with torch.no_grad():
        for draw in draws:
            by_kind[draw.kind].append(both_passes(net, draw, (1, 1))[1])
    text = " ".join(f"{kind} {np.mean(values):.2f}" for kind, values in sorted(by_kind.items()))
    return float(np.mean([value for values in by_kind.values() for value in values])), text


def load(path: Path, rng: np.random.Generator, width: str) -> SampleMesh:
    """Read a mesh for the net "fine" or "wide"; most of those with relief are made smooth first.

    Coarse ones stay rough for fine noise: on real meshes, too, few faces are left for what they show.
    """
    mesh, index = SampleMesh.load(path), int(path.stem)
    has_relief = family_of(index) in ("organic", "islands", "terrain")
    if has_relief and (width == "wide" or not is_coarse(index)) and rng.random() > RELIEF[width]:
        return mesh.smoothed(round(noise.log_uniform(rng, 4, SMOOTHEST)))
    return mesh


def keep_memory() -> None:
    """Have the allocator keep freed memory: fresh memory costs a quarter of the time of a step."""
    if sys.platform.startswith("linux"):
        library = ctypes.CDLL(None)
        library.mallopt(-4, 0)  # M_MMAP_MAX: nothing is mapped by itself
        library.mallopt(-1, 2**31 - 1)  # M_TRIM_THRESHOLD: nothing is given back


def train(
    width: str,
    shapes: Path,
    output: Path,
    seconds: float,
    seed: int,
    target: Path,
    *,
    warm_start: Path | None = None,
    rate: float = LARGEST_RATE,
    provenance: Mapping[str, str] | None = None,
) -> Net:
    """Train a net and write its arrays.

    Parameters
    ----------
    width : str
        Which net: "fine" or "wide".
    shapes : Path
        Folder of the meshes. New ones are seen while training.
    output : Path
        Folder of the checkpoint and the log. With a checkpoint there, training goes on from it.
    seconds : float
        Wall time, in all runs together; the learning rate falls to zero over it.
    seed : int
        Seed of weights and noise.
    target : Path
        File for the arrays.
    warm_start : Path, optional
        Checkpoint of another run to begin with.
    rate : float
        Largest learning rate.
    provenance : mapping, optional
        Texts that are written beside the arrays.

    Returns
    -------
    Net
        The running mean of the weights.
    """
    keep_memory()
    torch.set_num_threads(1)
    output.mkdir(parents=True, exist_ok=True)
    checkpoint = output / "checkpoint.pt"
    torch.manual_seed(seed)
    rng = np.random.default_rng(seed)
    paths = sorted(shapes.glob("*.npz"))
    held_out = [path for path in paths if int(path.stem) % 20 == 0]
    meshes: dict[Path, SampleMesh] = {}
    trial = np.random.default_rng(1000)
    held = [load(path, trial, width) for path in held_out[:14]]
    net, average = Net(REPEATS[width]), Net(REPEATS[width])
    validation = [Draw(held[number % len(held)], trial, width) for number in range(42)]
    optimizer = torch.optim.Adam(net.parameters(), lr=LARGEST_RATE, betas=(0.9, 0.98))
    elapsed, step = 0.0, 0
    if checkpoint.exists():
        state = torch.load(checkpoint, weights_only=False)
        net.load_state_dict(state["net"])
        average.load_state_dict(state["average"])
        optimizer.load_state_dict(state["optimizer"])
        elapsed, step = state["elapsed"], state["step"]
        rng = np.random.default_rng(seed + step)
    elif warm_start is not None:
        net.load_state_dict(torch.load(warm_start, weights_only=False)["average"])
    else:
        standardize(net, validation)
    if step == 0:
        average.load_state_dict(net.state_dict())
    log = (output / "log.txt").open("a", buffering=1)
    began, saved = time.perf_counter() - elapsed, time.perf_counter()
    recent: list[tuple[float, float]] = []
    while elapsed < seconds:
        share = elapsed / seconds
        current = rate * 0.5 * (1 + np.cos(np.pi * share)) * min(1.0, share / WARM_UP)
        for group in optimizer.param_groups:
            group["lr"] = current
        if step % 200 == 0:
            paths = [path for path in sorted(shapes.glob("*.npz")) if int(path.stem) % 20]
            paths += [path for path in paths if family_of(int(path.stem)) == "scanned"] * (SCANS - 1)
        path = paths[rng.integers(len(paths))]
        if path not in meshes:
            meshes[path] = load(path, rng, width)
        mesh = meshes[path]
        if mesh.engine.graph.n_faces > MOST_FACES:
            continue
        optimizer.zero_grad()
        has_two = warm_start is not None or share > ONE_PASS or rng.random() < SOME
        losses = both_passes(net, Draw(mesh, rng, width), (0.5, 1.0) if has_two else (1.0,))
        if not all(map(np.isfinite, losses)):
            print(f"{path.name} gave {losses}", file=log)
            continue
        torch.nn.utils.clip_grad_norm_(net.parameters(), 1.0)
        optimizer.step()
        with torch.no_grad():
            for own, other in zip(average.parameters(), net.parameters(), strict=True):
                own.lerp_(other, max(1 - AVERAGE, 1 / (1 + 0.1 * step)))
        recent.append(losses)
        step += 1
        elapsed = time.perf_counter() - began
        if time.perf_counter() - saved > CHECKPOINT_SECONDS or elapsed >= seconds:
            saved = time.perf_counter()
            state = {"net": net.state_dict(), "average": average.state_dict()}
            state["optimizer"] = optimizer.state_dict()
            torch.save({**state, "elapsed": elapsed, "step": step}, checkpoint.with_suffix(".part"))
            checkpoint.with_suffix(".part").replace(checkpoint)
            first, second = np.mean(recent, axis=0)
            print(f"{elapsed:6.0f} s step {step} loss {first:.3f} {second:.3f}", file=log)
            recent.clear()
        if step % VALIDATION_STEPS == 0 or elapsed >= seconds:
            mean, text = validate(average, validation)
            print(f"{elapsed:6.0f} s step {step} validation {mean:.4f}: {text}", file=log)
    average.export(target, steps=str(step), **(provenance or {}))
    return average
