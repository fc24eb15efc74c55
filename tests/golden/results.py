# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every preset makes of a few meshes that are made in code: the table that guards against silent change.

Where a change is meant, as of the net's weights, make the table again and commit it: `make golden` does so.
A row holds checksums: the root mean square of the displacements, and sums of them with weights that look
random, all in mean edge lengths. They tell any change from rounding, which differs between processors.

`--bits FILE` writes the bits of all results instead, and `--same-as FILE` compares them with those of another
NumPy: `make numbers` does both. Kernels that leave products of matrices to NumPy's library round as it does;
all others give the same bits.
"""

import argparse
import csv
import hashlib
import importlib.util
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
TABLE = Path(__file__).with_name("results.csv")
N_SUMS = 4

TOLERANCE = 2e-4
"""Mean edge lengths by which rounding may change a checksum."""

OWN_ROUNDING = {"TRI_2", "QUAD_1", "QUAD_2", "BILATERAL"}
"""Presets that no matrix library has a part in."""


def numbers(shape, salt):
    """Return numbers around 0 with deviation 1 that look random, the same for every NumPy and processor."""
    count = np.arange(4 * int(np.prod(shape)), dtype=np.uint64) + np.uint64(salt * 1_000_003)
    for factor in (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB):
        count = (count ^ (count >> np.uint64(29))) * np.uint64(factor)
    part = (count >> np.uint64(40)).astype(np.float64) / 2**24 - 0.5
    return part.reshape(*shape, 4).sum(axis=-1) * np.sqrt(3.0)


def grid_faces(rows, columns, is_closed, kind):
    """Return the faces of a grid: quads, triangles with either diagonal, or both in stripes."""
    number = np.arange(rows * columns).reshape(rows, columns)
    if is_closed:
        a, b = number, np.roll(number, -1, axis=0)
        d, c = np.roll(a, -1, axis=1), np.roll(b, -1, axis=1)
    else:
        a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    faces = []
    for k, quad in enumerate(np.stack((a, b, c, d), axis=-1).reshape(-1, 4).tolist()):
        if kind == "quads" or (kind == "mixed" and k % 5 < 2):
            faces.append(quad)
        elif numbers((1,), k)[0] > 0:
            faces += [quad[:3], [quad[0], *quad[2:]]]
        else:
            faces += [[*quad[:2], quad[3]], quad[1:]]
    return faces


def torus(kind, rows=20, columns=34):
    """Return a closed, smooth surface."""
    u = np.repeat(np.arange(rows), columns) * (2 * np.pi / rows)
    w = np.tile(np.arange(columns), rows) * (2 * np.pi / columns)
    radius = 6.0 + 2.5 * np.cos(u)
    points = np.stack((radius * np.cos(w), radius * np.sin(w), 2.5 * np.sin(u)), axis=1)
    return points, grid_faces(rows, columns, True, kind)


def roof(kind, rows=22, columns=30):
    """Return an open sheet with a sharp crease and a round hill."""
    y, x = np.divmod(np.arange(rows * columns), columns)
    hill = 4.0 * np.exp(-((x - 22.0) ** 2 + (y - 11.0) ** 2) / 18.0)
    return np.stack((x, -y, np.maximum(8.0 - x, 0.0) + hill), axis=1), grid_faces(rows, columns, False, kind)


MESHES = {
    "triangle torus": lambda: torus("triangles"),
    "quad torus": lambda: torus("quads"),
    "triangle roof": lambda: roof("triangles"),
    "mixed roof": lambda: roof("mixed"),
}
NOISE = 0.2
"""Standard deviation of each coordinate, in lengths that are about those of the edges."""


def results(core, names=None):
    """Yield mesh, preset, edge length, and positions (N, 3) before and after, for each preset that fits."""
    for mesh, build in MESHES.items():
        points, faces = build()
        points = (points + NOISE * numbers(points.shape, 7)).astype(np.float32)
        surface = core.SurfaceMesh.from_faces(points, faces)
        ends = surface.vertices[surface.edges].astype(np.float64)
        edge = float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).mean())
        for name, preset in core.PRESETS.items():
            if names is None or name in names:
                try:
                    found = core.denoise(surface, preset.settings.with_changes(threads=1)).vertices
                except core.FrameError:  # frames for quads on triangles
                    continue
                yield mesh, name, edge, points, found


def checksums(edge, before, after):
    """Return the checksums of a result, a list of floats: root mean square, then weighted sums."""
    moved = (after.astype(np.float64) - before) / edge
    sums = [float((moved * numbers(moved.shape, 100 + k)).sum()) / np.sqrt(moved.size) for k in range(N_SUMS)]
    return [float(np.sqrt(np.mean(moved**2))), *sums]


def read_rows(path):
    """Return the rows of a table: a list of words by mesh and preset."""
    with path.open(newline="", encoding="utf-8") as file:
        return {(row[0], row[1]): row[2:] for row in list(csv.reader(file))[1:]}


def differences(rows, others):
    """Return a line for each result of a table that is not as in another one; both may end with digests."""
    lines = [f"{', '.join(case)}: only in one table" for case in rows.keys() ^ others.keys()]
    for case in rows.keys() & others.keys():
        one, two = (row[case][: N_SUMS + 1] for row in (rows, others))
        apart = max(abs(float(a) - float(b)) for a, b in zip(one, two, strict=True))
        if not apart <= TOLERANCE:
            lines.append(f"{', '.join(case)}: checksums differ by {apart:.2g} edges")
        elif case[1] in OWN_ROUNDING and rows[case][N_SUMS + 1 :] != others[case][N_SUMS + 1 :]:
            lines.append(f"{', '.join(case)}: other bits")
    return sorted(lines)


def main(words=None):
    """Write the table, or the bits of all results; return 1 where they are not those of another file."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--bits", type=Path, help="write checksums and digests of the bits to this file instead"
    )
    parser.add_argument("--same-as", type=Path, help="and compare them with these")
    options = parser.parse_args(words)
    rows = [
        [mesh, preset, *(f"{number:.6f}" for number in checksums(edge, before, after))]
        + ([hashlib.sha256(after.tobytes()).hexdigest()] if options.bits else [])
        for mesh, preset, edge, before, after in results(loaded_core())
    ]
    head = ["mesh", "preset", "rms", *(f"sum {k}" for k in range(N_SUMS)), "sha256"]
    target = options.bits or TABLE
    target.parent.mkdir(parents=True, exist_ok=True)
    with target.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([head[: len(rows[0])], *rows])
    print(f"Wrote {len(rows)} results of NumPy {np.__version__} to {target.name}.")
    lines = differences(read_rows(target), read_rows(options.same_as)) if options.same_as else []
    print("\n".join(lines) or "The results are the same." * bool(options.same_as))
    return int(bool(lines))


def loaded_core():
    """Return `framelet.core` of this checkout."""
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)
    return importlib.import_module("framelet.core")


if __name__ == "__main__":
    sys.exit(main())
