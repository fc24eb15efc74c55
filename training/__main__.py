# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
import argparse
from pathlib import Path

from .train import train

parser = argparse.ArgumentParser()
parser.add_argument("--shapes", type=Path, default=Path("build/training/shapes"))
parser.add_argument("--output", type=Path, default=Path("build/training/run"))
parser.add_argument("--minutes", type=float, default=100)
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--warm-start", type=Path)
parser.add_argument("--rate", type=float, default=0.006)
a = parser.parse_args()
train(a.shapes, a.output, 60 * a.minutes, a.seed, a.warm_start, a.rate)
