# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The training in a minute: meshes, gradients, the same net in PyTorch and NumPy, a run that goes on."""

import re

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is in the environment for training only")

from core.learned.net import Net as NumpyNet  # noqa: E402
from training import noise  # noqa: E402
from training.mean import mean_of_runs  # noqa: E402
from training.net import Net  # noqa: E402
from training.sample_mesh import SampleMesh  # noqa: E402
from training.shapes.catalog import family_of, make  # noqa: E402
from training.shapes.mesh import condition  # noqa: E402
from training.train import REPEATS, Draw, both_passes, standardize, train  # noqa: E402


@pytest.fixture(scope="module")
def meshes(shapes):
    return [SampleMesh.load(path) for path in sorted(shapes.glob("*.npz"))]


@pytest.fixture
def net(meshes):
    torch.manual_seed(0)
    rng = np.random.default_rng(0)
    net = Net(REPEATS["wide"])
    standardize(net, [Draw(mesh, rng, "wide") for mesh in meshes])
    return net


def test_meshes_depend_on_their_numbers_only():
    for index in (604, 612, 623, 620):
        (mesh, kind), (again, _) = make(1, index), make(1, index)
        assert kind == family_of(index)
        assert np.array_equal(mesh.vertices, again.vertices)
        assert np.array_equal(mesh.corner_vertex, again.corner_vertex)
        assert condition(mesh).non_manifold == 0
        assert not np.array_equal(mesh.vertices[:10], make(2, index)[0].vertices[:10])


def test_all_kinds_of_noise_are_what_they_say(meshes):
    rng = np.random.default_rng(1)
    for mesh in meshes:
        for kind in {*noise.MIXTURES["fine"], *noise.MIXTURES["wide"]}:
            if kind is noise.voxels and mesh.voxels is None:
                continue
            positions = kind(mesh, rng)
            assert np.isfinite(positions).all()
            moved = np.linalg.norm(positions - mesh.vertices, axis=1)
            if kind is noise.spikes:
                assert np.median(moved) < 0.35 * np.max(mesh.local_edge)
            if kind is noise.impulsive:
                assert (moved == 0).mean() > 0.3
    assert any(mesh.voxels is not None for mesh in meshes)


def test_numpy_computes_what_pytorch_computes(meshes, net, tmp_path):
    net.export(tmp_path / "weights.npz", seed="0")
    with np.load(tmp_path / "weights.npz") as file:
        assert str(file["seed"]) == "0"
        fast = NumpyNet({name: file[name] for name in file.files if file[name].dtype.kind in "fi"})
    rng = np.random.default_rng(2)
    sizes = set()
    for mesh in meshes:
        draw = Draw(mesh, rng, "wide")
        with torch.no_grad():
            expected = net(*draw.described(), draw.engine).numpy().T
        found = fast.normals(*draw.described(), draw.engine.graph)
        assert np.abs(found - expected).max() < 2e-5
        sizes |= {len(group.corners) for group in mesh.engine.graph.groups}
    assert {3, 4} < sizes


def test_gradients_are_differences_of_the_loss(meshes, net):
    draw = Draw(meshes[0], np.random.default_rng(3), "wide")
    scales, features = draw.described()
    draw.loss(net(scales, features, draw.engine)).backward()
    parameters = dict(net.named_parameters())
    for name in (
        "layers.0.from_faces.weight",
        "layers.3.gains.weight",
        "layers.5.channels",
        "enter.weight",
        "shift.bias",
    ):
        parameter = parameters[name]
        direction = parameter.grad / parameter.grad.norm()
        losses = []
        for sign in (1, -1):
            with torch.no_grad():
                parameter += sign * 5e-3 * direction
                losses.append(float(draw.loss(net(*draw.described(), draw.engine))))
                parameter -= sign * 5e-3 * direction
        found = (losses[0] - losses[1]) / 1e-2
        assert found == pytest.approx(float(parameter.grad.norm()), rel=0.05), name


def test_a_run_learns_and_goes_on_where_it_was_cut_off(shapes, meshes, net, tmp_path):
    arguments = ("fine", shapes, tmp_path / "run")
    target = tmp_path / "weights.npz"
    train(*arguments, 4, 1, target)
    with np.load(target) as file:
        n_first = int(str(file["steps"]))
    train(*arguments, 12, 1, target, provenance={"seed": "1"})
    steps = [int(step) for step in re.findall(r"step (\d+)", (tmp_path / "run" / "log.txt").read_text())]
    assert steps == sorted(steps)
    trained = Net(REPEATS["fine"])
    with np.load(target) as file:
        assert n_first < int(str(file["steps"])) == steps[-1]
        trained.load_state_dict({name: torch.from_numpy(file[name]) for name in trained.state_dict()})
    draws = [Draw(mesh, np.random.default_rng(4), "fine") for mesh in meshes]
    with torch.no_grad():
        losses = [np.mean([both_passes(own, draw, (1, 1)) for draw in draws]) for own in (net, trained)]
    assert losses[1] < losses[0] - 0.2


def test_the_mean_of_two_runs(shapes, meshes, tmp_path):
    runs = [tmp_path / "one", tmp_path / "other"]
    for seed, run in enumerate(runs):
        train("fine", shapes, run / "fine", 2, seed, run / "fine.npz", provenance={"seed": str(seed)})
    mean_of_runs("fine", runs, tmp_path / "mean.npz", tmp_path / "mean.pt")
    one, other, mean = (
        dict(np.load(path)) for path in (*(run / "fine.npz" for run in runs), tmp_path / "mean.npz")
    )
    assert str(mean["seed"]) == "mean of 0 and 1"
    assert not np.array_equal(one["begin.weight"], other["begin.weight"])
    assert mean["begin.weight"] == pytest.approx((one["begin.weight"] + other["begin.weight"]) / 2, abs=1e-6)
    further = tmp_path / "further.npz"
    train("fine", shapes, tmp_path / "further", 1, 1, further, warm_start=tmp_path / "mean.pt")
    assert NumpyNet(dict(np.load(further))).repeats == mean["repeats"].tolist()
