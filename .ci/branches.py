# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ask for a share of branches, which `coverage report --fail-under` mixes with that of lines.

    python3 .ci/branches.py build/coverage/core.json --fail-under 95

The file is what `coverage json` writes.
"""

import argparse
import json
import sys
from pathlib import Path


def main(words=None):
    """Print the share of branches that were taken; return 1 if it is too small."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("report", type=Path, help="written by coverage json")
    parser.add_argument("--fail-under", type=float, required=True, metavar="PERCENT")
    options = parser.parse_args(words)
    totals = json.loads(options.report.read_text(encoding="utf-8"))["totals"]
    n_branches = totals.get("num_branches", 0)
    if not n_branches:
        print(f"{options.report} knows of no branches; measure with branch = true.", file=sys.stderr)
        return 1
    # Rounded down, so that what is shown as enough is enough.
    share = int(10000 * totals["covered_branches"] / n_branches) / 100
    print(f"{options.report.stem}: {share} % of {n_branches:,} branches")
    if share < options.fail_under:
        print(f"Tests must take {options.fail_under:g} % of the branches; write more.", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
