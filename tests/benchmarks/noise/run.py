# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure how well `estimate_noise` finds noise that was added to clean meshes.

It needs Python and NumPy only:

    python3 .ci/environment.py run core -- tests/benchmarks/noise/run.py

Meshes come from the folder that FRAMELET_MESHES names, by default shared/meshes beside the checkout; without
one they are made in code.
"""

import argparse
import sys
from pathlib import Path
from time import perf_counter

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "frames"))

import checkout  # noqa: F401
import numpy as np
from cases import mesh_folder
from framelet.core import SurfaceMesh, add_noise, connect, estimate_noise
from framelet.core.mesh.geometry import mean_edge_length
from made import MADE
from mesh_files import read_mesh
from noise_tables import Row, level_table, mesh_tables, summary
from records import read_records, write_records
from science_page import update_page

RESULTS = "noise.csv"
LEVELS = (0.1, 0.2, 0.3, 0.5, 0.7)
IMPULSIVE = 0.5
"""Standard deviation of the vertices that impulsive noise moves, in clean mean edge lengths."""

SHARE = 0.5
"""Share of the vertices that impulsive noise moves."""

QUICK = ("made/box_tri", "made/torus_quad")


def main() -> int:
    """Run the benchmark and return the exit code."""
    arguments = parse()
    if arguments.again is not None:
        rows = read_records(Row, arguments.again / RESULTS)
    else:
        meshes = known_meshes()
        names = arguments.meshes or list(QUICK if arguments.quick else meshes)
        for name in names:
            if name not in {**meshes, **MADE}:
                known = ", ".join({**meshes, **MADE})
                print(f"There is no mesh {name!r}; choose from {known}.", file=sys.stderr)
                return 2
        rows = [row for name in names for row in measure(name, 1 if arguments.quick else arguments.seeds)]
    arguments.output.mkdir(parents=True, exist_ok=True)
    text = f"{level_table(rows)}\n{summary(rows)}\n{mesh_tables(rows)}"
    (arguments.output / "noise.md").write_text(text, encoding="utf-8")
    write_records(rows, arguments.output / RESULTS)
    print(text)
    if arguments.update:
        update_page({"noise estimate": level_table(rows)})
    print(f"Wrote noise.md and {RESULTS} in {arguments.output}.")
    return 0


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(description="Measure the estimate of noise on meshes with known noise.")
    parser.add_argument("meshes", nargs="*", metavar="MESH", help="names such as tri/fandisk (default: all)")
    parser.add_argument("--quick", action="store_true", help="two small meshes made in code, one seed")
    parser.add_argument("--seeds", type=int, default=3, help="draws of each noise (default: %(default)s)")
    parser.add_argument(
        "--output", type=Path, default=Path("build/benchmarks/noise"), help="folder for the results"
    )
    parser.add_argument(
        "--again", type=Path, metavar="FOLDER", help="only write the tables again, from a CSV file"
    )
    parser.add_argument("--update", action="store_true", help="write the table of levels into docs")
    return parser.parse_args()


def known_meshes() -> dict[str, Path | None]:
    """Return the names of the clean meshes with their files, or those made in code without a folder."""
    folder = mesh_folder()
    if folder is None:
        return dict.fromkeys(MADE)
    paths = [path for kind in ("tri", "quad", "mixed") for path in sorted(folder.glob(f"{kind}/*.ply"))]
    return {f"{path.parent.name}/{path.stem}": path for path in paths if "noisy" not in path.stem}


def load(name: str) -> SurfaceMesh:
    """Return a clean mesh with float32 positions."""
    if name in MADE:
        mesh = MADE[name]()
        return mesh.with_vertices(mesh.vertices.astype(np.float32))
    return read_mesh(mesh_folder() / f"{name}.ply")


def measure(name: str, n_seeds: int) -> list[Row]:
    """Return the estimates on a clean mesh and with each noise."""
    clean = load(name)
    edge, connectivity = mean_edge_length(clean), connect(clean)
    rows = []
    for kind, level in [("clean", 0.0), *((k, s) for k in KINDS for s in LEVELS), ("impulsive", IMPULSIVE)]:
        for seed in range(n_seeds if level else 1):
            noisy = clean if not level else clean.with_vertices(KINDS_OF_NOISE[kind](clean, level, seed))
            start = perf_counter()
            found = estimate_noise(noisy, connectivity=connectivity)
            seconds = perf_counter() - start
            truth = level * np.sqrt(SHARE) if kind == "impulsive" else level
            estimate = (found.rms if kind == "impulsive" else found.sigma) / edge
            rows.append(
                Row(
                    name,
                    clean.n_vertices,
                    kind,
                    level,
                    seed,
                    float(truth),
                    float(estimate),
                    float(estimate / truth) if truth else np.nan,
                    found.sigma_clean_edges,
                    found.is_impulsive,
                    seconds,
                )
            )
    print(f"{name}: {len(rows)} estimates", flush=True)
    return rows


def in_all_directions(clean: SurfaceMesh, level: float, seed: int) -> np.ndarray:
    """Return positions with Gaussian noise in each coordinate, shape (N, 3)."""
    sigma = level * mean_edge_length(clean)
    offset = np.random.default_rng(seed).normal(0.0, sigma, clean.vertices.shape)
    return (clean.vertices + offset).astype(np.float32)


def impulsive(clean: SurfaceMesh, level: float, seed: int) -> np.ndarray:
    """Return positions of which a share is moved along the normals, the others exact, shape (N, 3)."""
    moved = np.random.default_rng(1000 + seed).random(clean.n_vertices) < SHARE
    return np.where(moved[:, None], add_noise(clean, level, seed), clean.vertices)


KINDS = ("normals", "directions")
KINDS_OF_NOISE = {"normals": add_noise, "directions": in_all_directions, "impulsive": impulsive}

if __name__ == "__main__":
    sys.exit(main())
