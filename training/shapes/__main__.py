# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write clean meshes: ``python -m training.shapes --out build/training/shapes --count 600 --seed 1``."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

from .catalog import make


def make_shapes(out: Path, count: int, seed: int, first: int = 0, *, keep: bool = False) -> None:
    """Write meshes as files; skip those that fail.

    Parameters
    ----------
    out : Path
        Folder of the files.
    count, seed, first : int
        Number of meshes, and what they depend on, see `catalog.make`.
    keep : bool
        Leave files that exist.
    """
    out.mkdir(parents=True, exist_ok=True)
    for index in range(first, first + count):
        path = out / f"{index:04d}.npz"
        if keep and path.exists():
            continue
        start = time.process_time()
        try:
            mesh, kind = make(seed, index)
        except ValueError as error:
            print(f"{index:04d} skipped: {error}", flush=True)
            path.unlink(missing_ok=True)
            continue
        # Under another name first: who trains meanwhile must not read half a file.
        part = path.with_suffix(".part")
        with part.open("wb") as file:
            np.savez(
                file,
                vertices=mesh.vertices.astype(np.float32),
                face_offset=mesh.face_offset.astype(np.int32),
                corner_vertex=mesh.corner_vertex.astype(np.int32),
                kind=kind,
                **({} if mesh.noisy is None else {"noisy": mesh.noisy.astype(np.float32)}),
                **({} if mesh.grid is None else {"grid": mesh.grid}),
            )
        part.replace(path)
        print(f"{index:04d} {kind} {mesh.n_faces} faces, {time.process_time() - start:.1f} s", flush=True)


def main() -> int:
    """Make the meshes asked for."""
    parser = argparse.ArgumentParser(prog="python -m training.shapes", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the .npz files")
    parser.add_argument("--count", type=int, default=1500, help="number of meshes")
    parser.add_argument("--first", type=int, default=0, help="index of the first mesh")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="leave files that exist")
    options = parser.parse_args()
    make_shapes(options.out, options.count, options.seed, options.first, keep=options.keep)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
