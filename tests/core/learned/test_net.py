# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The net against a loop over faces and pairs, and that its arrays are read late and once."""

import subprocess
import sys
from pathlib import Path

import framelet.core as core
import numpy as np
import pytest
from checks import assert_same_bits, random_rotation
from framelet.core import connect
from framelet.core.blocks import Blocks
from framelet.core.learned import net
from framelet.core.learned import rows as rows_module
from framelet.core.learned.engine import FaceEngine
from kinds import ALONE, KINDS
from learned_twins import pairs_of, slow_net
from meshes import MESHES, noisy, prism, triangle_torus, union

ROOT = Path(core.__file__).resolve().parent.parent
NETS = {
    **{
        name: KINDS[name]
        for name in ("irregular torus", "quad torus", "mixed sheet", "three pages", "border")
    },
    "polygons": lambda: union(prism(), prism(5), MESHES["tetrahedron"]()),
    "single triangle": MESHES["single triangle"],
    "single quad": MESHES["single quad"],
}
N_LAYERS = 3
"""Three layers are as good as many to compare, and cheaper."""


def random_arrays(rng, n_layers=N_LAYERS):
    """Return arrays of the shapes that come with Framelet, as a net begins."""
    with np.load(net.WEIGHTS["fine"]) as file:
        shapes = {name: file[name].shape for name in file.files if file[name].dtype.kind == "f"}
    arrays = {}
    for name, shape in shapes.items():
        if name.startswith("layers.") and int(name.split(".")[1]) >= n_layers:
            continue
        if name.endswith("_scale"):
            arrays[name] = rng.uniform(0.5, 2.0, shape)
        else:
            arrays[name] = rng.normal(0, 0.5 / np.sqrt(shape[-1] if len(shape) > 1 else 1), shape)
    for name in ("shift.weight", "shift.bias"):
        arrays[name] = arrays[name][: 16 + 24 * n_layers]
    arrays = {name: array.astype(np.float32) for name, array in arrays.items()}
    return {**arrays, "repeats": np.array((1, 2, 1) if n_layers == 3 else (1,) * n_layers)}


def described(mesh, blocks=ALONE, **sizes):
    engine = FaceEngine(mesh, connect(mesh), blocks, **sizes)
    return engine, *engine.describe(np.ascontiguousarray(mesh.vertices.T, np.float32))


@pytest.mark.parametrize("name", NETS)
def test_the_net_is_a_loop_over_faces_and_pairs(name, rng):
    mesh, arrays = noisy(NETS[name](), rng), random_arrays(rng)
    engine, scales, features = described(mesh)
    # Copies, as the net works in place.
    before = [
        scales.normals.transpose(1, 2, 0),
        scales.centroids.transpose(1, 2, 0),
        scales.areas,
        scales.length,
    ]
    before = [x.astype(float) for x in before]
    inputs = features.faces.astype(float)
    found = net.Net(arrays).normals(scales, features, engine.graph)
    # The pairs of the twin have the features of the same pairs of the graph.
    graph, number = engine.graph, {}
    for place, two in enumerate(zip(graph.first[:-1].tolist(), graph.second[:-1].tolist(), strict=True)):
        number.setdefault(two, []).append(place)
    pair_features = [features.pairs[number[f, g].pop(0)] for f, g, _ in pairs_of(mesh)]
    expected = slow_net(
        {key: array.astype(float) if array.dtype.kind == "f" else array for key, array in arrays.items()},
        mesh,
        before,
        inputs,
        [row.astype(float) for row in pair_features],
        features.context.astype(float)[
            np.zeros(len(inputs), int) if features.island is None else features.island
        ],
    )
    assert found.shape == (3, graph.n_faces) and found.dtype == np.float32
    assert np.abs(found.T - expected).max() < 1e-3
    assert np.abs(np.linalg.norm(expected, axis=1) - 1).max() < 1e-3
    assert graph.n_faces == 1 or np.abs(expected - before[0][:, 0]).max() > 0.1


@pytest.mark.parametrize("name", ["mixed sheet", "polygons"])
def test_blocks_and_threads_do_not_change_a_bit(name, rng):
    mesh, arrays = noisy(NETS[name](), rng), random_arrays(rng)
    results = []
    for size, threads in ((4096, 1), (5, 1), (5, 3)):
        with Blocks(threads) as blocks:
            engine, scales, features = described(mesh, blocks, faces_at_once=size)
            results.append(net.Net(arrays).normals(scales, features, engine.graph))
    assert_same_bits(results[2], results[1])
    # Products of other sizes may be summed up in another order.
    assert np.abs(results[1] - results[0]).max() < 1e-4


def test_normals_turn_with_the_mesh(rng):
    mesh, rotation = noisy(triangle_torus(10, 14), rng), random_rotation(rng)
    results = []
    for own in (mesh, mesh.with_vertices(mesh.vertices @ rotation)):
        engine, scales, features = described(own)
        results.append(net.load_net("wide").normals(scales, features, engine.graph).T)
    assert np.abs(results[1] - results[0] @ rotation).max() < 5e-3


def test_normals_are_given_back_where_the_net_does_nothing(rng):
    """Gains and mixing of zero, and the finest scale alone in the end."""
    arrays = {
        name: (0 if array.dtype.kind == "f" else 1) * array
        for name, array in random_arrays(rng, net.N_LAYERS).items()
    }
    for name in ("face_scale", "edge_scale"):
        arrays[name] += 1
    for number in range(net.N_LAYERS):
        arrays[f"layers.{number}.gains.bias"] -= 100
    arrays["leave.bias"][0] = 2
    mesh = noisy(NETS["mixed sheet"](), rng)
    engine, scales, features = described(mesh)
    before = scales.normals[..., 0].copy()
    found = net.Net(arrays).normals(scales, features, engine.graph)
    assert np.abs(found - before).max() < 1e-5


def test_it_ticks_after_each_layer(rng):
    mesh, ticks = noisy(NETS["border"](), rng), []
    engine, scales, features = described(mesh)
    net.load_net("wide").normals(scales, features, engine.graph, lambda: ticks.append(0))
    assert len(ticks) == net.N_LAYERS


def test_large_products_are_made_in_pieces(rng):
    matrix = rng.normal(size=(7, 5)).astype(np.float32)
    rows = rng.normal(size=(3 * rows_module.SMALL_PRODUCT // matrix.size + 101, 7)).astype(np.float32)
    assert np.abs(rows_module.times(rows, matrix) - rows @ matrix).max() < 1e-5
    out = np.full((len(rows), 5), np.nan, np.float32)
    assert rows_module.times(rows, matrix, out) is out and np.isfinite(out).all()


@pytest.mark.parametrize("width", net.WEIGHTS)
def test_the_arrays_that_come_with_framelet_are_small_and_finite(width):
    with np.load(net.WEIGHTS[width]) as file:
        arrays = {name: file[name] for name in file.files}
    numbers = [array for array in arrays.values() if array.dtype.kind == "f"]
    assert all(np.isfinite(array).all() for array in numbers)
    assert sum(array.size for array in numbers) < 50_000
    assert net.WEIGHTS[width].stat().st_size < 150_000
    assert (arrays["face_scale"] > 0).all() and (arrays["edge_scale"] > 0).all()
    assert len(arrays["repeats"]) == net.N_LAYERS


PROGRAM = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("framelet", {init!r}, submodule_search_locations=[{root!r}])
package = importlib.util.module_from_spec(spec)
sys.modules["framelet"] = package
import numpy, framelet.core as core
calls, load = [], numpy.load
numpy.load = lambda *given, **named: calls.append(given) or load(*given, **named)
for name in core.__all__:
    getattr(core, name)
mesh = core.SurfaceMesh.from_faces([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1)], [(0, 1, 2), (2, 1, 3)])
core.denoise(mesh, core.PRESETS["POSITIONS"].settings)
core.prepare(mesh)
assert not calls, calls
for _ in range(3):
    core.denoise(mesh)
assert len(calls) == 1, calls
"""


def test_the_arrays_are_read_by_the_first_run_that_uses_them_and_once():
    program = PROGRAM.format(init=str(ROOT / "__init__.py"), root=str(ROOT))
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
