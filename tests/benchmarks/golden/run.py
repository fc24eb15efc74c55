# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Golden results: what two checkouts make of the same meshes, preset by preset, and where they differ most.

`run.py OLD NEW` denoises each mesh as it is and with noise added, with every preset that both checkouts have.
It prints the largest distance between the two results, in mean edge lengths, and how many vertices are
further apart than rounding explains. It fails if those are more than a few.

Where a fold may be taken back in two ways, the last bit of the input decides, and a few vertices of a mesh
differ by as much as half an edge. How many that are for one and the same code shows `run.py OLD OLD --shake`,
where the second run gets positions that are moved as little as single precision allows.

Weights of the net are results of training, not code: `--weights` puts those of one folder into both.
"""

import argparse
import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
GOOD = ("tri", "quad", "mixed", "scan")

ROUNDING = 1e-3
"""Mean edge lengths that single precision may make of a difference in the last bit, in all steps of a run."""

FEW = 0.01
"""Share of the vertices that may be further apart."""

NOISE = 0.2
"""Standard deviation of the noise that is added, in each coordinate, in mean edge lengths."""

SHAKE = 1e-6
"""The same for `--shake`: about the last bit of coordinates ten edges from the origin."""


def main(words=None):
    """Compare two checkouts; return 0 if they agree."""
    options = parsed(words)
    paths = [
        path
        for kind in options.kinds
        for path in sorted((options.meshes / kind).iterdir())
        if path.suffix == ".ply" and path.stat().st_size <= options.most
    ]
    worst, is_good = {}, bool(paths)
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            old, new = (
                results_of(checkout.resolve(), path, Path(folder) / f"{name}.npz", options, shake)
                for name, checkout, shake in (("old", options.old, 0.0), ("new", options.new, options.shake))
            )
            for case, distances, is_same in differences(old, new):
                largest, n_apart = distances.max(initial=0.0), int((distances > ROUNDING).sum())
                said = "same bits" if is_same else f"{n_apart} of {len(distances)} beyond rounding"
                print(f"{path.stem:24} {case:22} {largest:10.3g}  {said}", flush=True)
                is_good &= n_apart <= FEW * len(distances)
                preset = case.partition(" ")[0]
                worst[preset] = max(worst.get(preset, (-1.0, "")), (largest, f"{path.stem}, {case}"))
    print()
    for preset, (largest, where) in worst.items():
        print(f"{preset:16} largest distance {largest:10.3g} edges: {where}")
    return int(not is_good)


def parsed(words):
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("old", type=Path, help="one checkout")
    parser.add_argument("new", type=Path, help="the other")
    parser.add_argument("--meshes", type=Path, default=ROOT.parent / "shared" / "meshes")
    parser.add_argument("--kinds", nargs="+", default=GOOD, help="folders of meshes")
    parser.add_argument("--most", type=int, default=10**9, help="leave out meshes with more bytes than this")
    parser.add_argument(
        "--weights",
        type=Path,
        help="a folder with the arrays of the nets, such as core/learned, that both use",
    )
    parser.add_argument("--presets", nargs="+", help="by default all that both have")
    parser.add_argument(
        "--shake", action="store_const", const=SHAKE, default=0.0, help="move the input of NEW by a last bit"
    )
    return parser.parse_args(words)


def results_of(checkout, path, out, options, shake):
    """Return the results of a checkout by case, and the mean edge length; it runs in a process of its own."""
    presets = " ".join(options.presets or ())
    words = ["--one", str(checkout), str(path), str(out), str(options.weights or ""), str(shake), presets]
    subprocess.run([sys.executable, __file__, *words], check=True)
    with np.load(out) as file:
        return dict(file)


def differences(old, new):
    """Yield each case that both have, distances in mean edge lengths, shape (N,), and whether all bits agree.

    What both refuse is the same; what only one refuses is infinitely far away.
    """
    edge = float(old.pop("edge"))
    for case in old:
        if case in new:
            refused = [result[case].dtype.kind == "U" for result in (old, new)]
            if any(refused):
                yield case, np.array([0.0 if all(refused) else np.inf]), all(refused)
                continue
            distances = np.linalg.norm(old[case].astype(np.float64) - new[case], axis=1)
            yield case, distances / edge, old[case].tobytes() == new[case].tobytes()


def write_results(checkout, path, out, weights, shake, presets):
    """Write what a checkout makes of a mesh, with and without noise, with each of its presets."""
    core = loaded_core(checkout, weights)
    vertices, faces = read_ply(path)
    ends = np.concatenate([np.stack((face, np.roll(face, -1)), axis=1) for face in faces])
    edge = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1).mean()
    noise, last_bits = np.random.default_rng(0).normal(0.0, edge, (2, *vertices.shape))
    results = {"edge": edge}
    for word, level in (("given", 0.0), ("noisy", NOISE)):
        positions = (vertices + level * noise + shake * last_bits).astype(np.float32)
        surface = core.SurfaceMesh.from_faces(positions, faces)
        for name, preset in core.PRESETS.items():
            if presets and name not in presets:
                continue
            try:
                results[f"{name} {word}"] = core.denoise(surface, preset.settings).vertices
            except ValueError as error:  # as frames for quads do on triangles
                results[f"{name} {word}"] = np.array(str(error))
    np.savez(out, **results)


def loaded_core(checkout, weights):
    """Return `framelet.core` of a checkout, whose nets have the arrays of a folder if one is given."""
    spec = importlib.util.spec_from_file_location(
        "framelet", checkout / "__init__.py", submodule_search_locations=[str(checkout)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)
    if weights:
        net = importlib.import_module("framelet.core.learned.net")
        for width, path in net.WEIGHTS.items():
            net.WEIGHTS[width] = Path(weights) / path.name
    return importlib.import_module("framelet.core")


def read_ply(path):
    """Return the vertices and faces of a development mesh."""
    head, _, body = path.read_bytes().partition(b"end_header\n")
    counts = {
        line.split()[1]: int(line.split()[2])
        for line in head.decode().splitlines()
        if line.startswith("element")
    }
    vertices = np.frombuffer(body, "<f4", 3 * counts["vertex"]).reshape(-1, 3)
    faces, begin = [], vertices.nbytes
    for _ in range(counts["face"]):
        faces.append(np.frombuffer(body, "<i4", body[begin], begin + 1))
        begin += 1 + 4 * body[begin]
    return vertices, faces


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        where, mesh, target, own_weights, moved, chosen = sys.argv[2:]
        write_results(Path(where), Path(mesh), target, own_weights, float(moved), chosen.split())
    else:
        sys.exit(main())
