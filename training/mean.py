# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the mean of the weights of several runs that began alike: arrays for Framelet, and a restart point.

python3 .ci/environment.py run training -- -m training.mean wide build/training/one build/training/other
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch

from .net import Net

ROOT = Path(__file__).resolve().parent.parent


def mean_of_runs(width: str, runs: Sequence[Path], arrays: Path, start: Path) -> None:
    """Write the mean of some runs.

    Parameters
    ----------
    width : {"fine", "wide"}
        Which net it is.
    runs : sequence of Path
        Folders of `python -m training --folder`, with the checkpoint and the arrays of each run.
    arrays : Path
        The file of arrays that is written.
    start : Path
        The restart point that is written.
    """
    states = [torch.load(run / width / "checkpoint.pt", weights_only=False) for run in runs]
    averages = [state["average"] for state in states]
    mean = {name: torch.stack([own[name] for own in averages]).mean(dim=0) for name in averages[0]}
    known = []
    for run in runs:
        with np.load(run / f"{width}.npz") as file:
            repeats = file["repeats"].tolist()
            known.append({name: str(file[name]) for name in file.files if file[name].dtype.kind == "U"})
    net = Net(repeats)
    net.load_state_dict(mean)
    seeds = " and ".join(own.get("seed", "?") for own in known)
    net.export(arrays, **{**known[-1], "seed": f"mean of {seeds}"})
    torch.save({"average": mean, "step": states[-1]["step"]}, start)


def main() -> int:
    """Write the mean where the arrays of Framelet and their restart points are, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m training.mean", description=__doc__)
    parser.add_argument("width", choices=("fine", "wide"))
    parser.add_argument("runs", type=Path, nargs="+", help="folders of runs, without --write")
    options = parser.parse_args()
    arrays = ROOT / "core" / "learned" / f"{options.width}.npz"
    mean_of_runs(options.width, options.runs, arrays, ROOT / "training" / f"{options.width}.pt")
    print(f"Wrote {arrays}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
