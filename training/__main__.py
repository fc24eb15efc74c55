# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the meshes, train the nets, and write their arrays: one command, which goes on where it was cut off.

python3 .ci/environment.py run training -- -m training
"""

import argparse
import subprocess
import sys
from pathlib import Path

from .shapes.__main__ import make_shapes
from .train import LARGEST_RATE, train

ROOT = Path(__file__).resolve().parent.parent


def main() -> int:
    """Train, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m training", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "training", help="all that is made")
    parser.add_argument("--shapes", type=int, default=1500, help="number of meshes")
    parser.add_argument("--minutes", type=float, default=240, help="time for each net, in all runs together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--start", type=Path, help="folder of checkpoints to start from, such as training")
    parser.add_argument("--rate", type=float, default=LARGEST_RATE, help="largest learning rate")
    parser.add_argument("--write", action="store_true", help="replace the arrays that come with Framelet")
    options = parser.parse_args()
    make_shapes(options.folder / "shapes", options.shapes, seed=1, keep=True)
    commit = subprocess.run(
        ["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False
    ).stdout.strip()
    target = ROOT / "core" / "learned" if options.write else options.folder
    for width in ("fine", "wide"):
        train(
            width,
            options.folder / "shapes",
            options.folder / width,
            60 * options.minutes,
            options.seed,
            target / f"{width}.npz",
            warm_start=options.start and options.start / f"{width}.pt",
            rate=options.rate,
            provenance={
                "shapes": f"{options.shapes} of seed 1",
                "seed": str(options.seed),
                "commit": commit,
            },
        )
    print(f"Wrote {target}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
