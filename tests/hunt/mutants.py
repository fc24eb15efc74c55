# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mutants: does a test fail if one operator or number of the code is another one?

    python3 .ci/environment.py run core -- tests/hunt/mutants.py --count 60
    python3 .ci/environment.py run core -- tests/hunt/mutants.py --room shrinkage --seed 3

Each mutant is one change in a copy of the checkout: a comparison, a sign, `and` for `or`, a number
that is one larger, a condition turned around. The tests of its room run until one fails. Those that no test
tells are printed: each asks for a test, or does what the original does.
"""

import argparse
import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
ROOMS = {
    "stencils": ("core/stencils/*.py", ["core/stencils"]),
    "transform": (
        "core/transform/*.py",
        ["core/transform", "core/frames/test_every_frame.py", "core/frames/test_frame_choice.py"],
    ),
    "shrinkage": (
        "core/methods/{proximal,split_bregman}.py",
        [
            "core/methods/test_shrinkage.py",
            "core/methods/test_split_bregman.py",
            "core/test_library.py",
            "core/transform/test_adaptive.py",
        ],
    ),
    "averages": ("core/averages/*.py", ["core/averages", "core/limits/test_lines.py"]),
    "files": (
        "operators/files/*.py",
        [
            "files/test_ply.py",
            "files/test_obj.py",
            "files/test_stl.py",
            "files/test_gltf.py",
            "files/test_damaged_files.py",
            "files/test_formats.py",
            "files/test_safe_write.py",
            "files/test_digits.py",
            "files/test_hostile.py",
            "files/test_defects.py",
            "files/test_fuzz.py",
            "files/test_less_memory.py",
            "files/test_command_line.py",
        ],
    ),
}
COMPARED = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
SIGNS = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
}
EXPLAINED = {
    "core/methods/split_bregman.py: steps.delta > 0  ->  steps.delta >= 0": "adds zeros, and takes memory",
    "core/stencils/grid.py: 20  ->  21": "how many vertices are worked on together",
    "core/transform/make.py: index + 1  ->  index - 1": "prepares a level that does not come",
    "core/transform/make.py: index + 1 < levels  ->  index + 1 <= levels": (
        "prepares a level that does not come"
    ),
    "core/transform/frame_transform.py: index < len(self.levels)  ->  index <= len(self.levels)": (
        "computes what nobody reads"
    ),
    "core/transform/frame_transform.py: length < 1e-12 * max(map(abs, diagonal))  ->  "
    "length <= 1e-12 * max(map(abs, diagonal))": "no length is that to the bit",
    "operators/files/ply.py: 10000  ->  10001": "how many triangles are looked at",
}
"""Changes that do what the original does, by `path: before  ->  after`, and why; they are not tried."""

TIMEOUT = 1200
"""Seconds for the tests of a mutant; one that hangs is found out."""


class Mutant(NamedTuple):
    """A change: where, what, and the whole text of the file with it."""

    path: str
    line: int
    what: str
    text: str

    @property
    def name(self):
        """What it is called in `EXPLAINED`: without its line, which moves."""
        return f"{self.path}: {self.what}"


def changes(tree):
    """Yield functions that change a node of a tree in place and say what they did, with the node."""
    typed = {
        id(inner)
        for node in ast.walk(tree)
        for part in ("annotation", "returns")
        if (outer := getattr(node, part, None)) is not None
        for inner in ast.walk(outer)
    }
    negative = {
        id(node.operand)
        for node in ast.walk(tree)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub)
    }
    for node in ast.walk(tree):
        if id(node) in typed:
            continue
        if isinstance(node, ast.Compare) and type(node.ops[0]) in COMPARED:
            yield node, lambda node=node: node.ops.__setitem__(0, COMPARED[type(node.ops[0])]())
        elif isinstance(node, ast.BinOp | ast.AugAssign) and type(node.op) in SIGNS:
            yield node, lambda node=node: setattr(node, "op", SIGNS[type(node.op)]())
        elif isinstance(node, ast.BoolOp):
            other = ast.Or if isinstance(node.op, ast.And) else ast.And
            yield node, lambda node=node, other=other: setattr(node, "op", other())
        elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
            # -1 becomes 0: NumPy takes -2 for -1 in shapes.
            step = -1 if id(node) in negative else 1
            yield node, lambda node=node, step=step: setattr(node, "value", node.value + step)
        elif isinstance(node, ast.If | ast.IfExp):
            yield (
                node,
                lambda node=node: setattr(node, "test", ast.UnaryOp(ast.Not(), node.test)),
            )


def mutants(path):
    """Return all mutants of a file; comments are lost, which no test minds."""
    source = (ROOT / path).read_text(encoding="utf-8")
    found = []
    for index in range(len(list(changes(ast.parse(source))))):
        tree = ast.parse(source)
        node, change = list(changes(tree))[index]
        before = ast.unparse(node).splitlines()[0]
        change()
        ast.fix_missing_locations(tree)
        after = ast.unparse(node).splitlines()[0]
        found.append(Mutant(str(path), node.lineno, f"{before}  ->  {after}", ast.unparse(tree)))
    return found


def files_of(pattern):
    """Return the files of a room, relative to the root."""
    folder, _, name = pattern.rpartition("/")
    stems = name.strip("{}").partition("}")[0].split(",") if "{" in name else ["*"]
    return sorted(path.relative_to(ROOT) for stem in stems for path in (ROOT / folder).glob(f"{stem}.py"))


def exit_code(tests, copy):
    """Return the exit code of pytest in a copy of the checkout; 0 if all tests pass."""
    words = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-m", "not shared", *tests]
    # Python would take the compiled original, if both were written within a second.
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(words, cwd=copy, env=environment, capture_output=True, timeout=TIMEOUT).returncode


def is_told(mutant, tests, copy):
    """Return whether a test fails, in a copy of the checkout, with the mutant in the place of its file."""
    target = copy / mutant.path
    original = target.read_text(encoding="utf-8")
    target.write_text(mutant.text, encoding="utf-8")
    try:
        return exit_code(tests, copy) != 0
    except subprocess.TimeoutExpired:
        return True
    finally:
        target.write_text(original, encoding="utf-8")


def main(words=None):
    """Try a sample of mutants, and print those that live; return 0, as to live may be right.

    It is 1 if the tests of a room do not pass without a mutant: then they would tell any.
    """
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=20, help="mutants of each room (default: 20)")
    parser.add_argument("--room", choices=ROOMS, action="append", help="only this one")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(words)
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "checkout"
        leave = shutil.ignore_patterns(".*", "build", "dist", "__pycache__", "docs", "training")
        shutil.copytree(ROOT, copy, ignore=leave)
        for room in options.room or ROOMS:
            pattern, names = ROOMS[room]
            tests = [f"tests/{name}" for name in names]
            if code := exit_code(tests, copy):
                print(f"{room}: The tests end with exit code {code} without a mutant; mend them first.")
                return 1
            found = [mutant for path in files_of(pattern) for mutant in mutants(path)]
            everything = [mutant for mutant in found if mutant.name not in EXPLAINED]
            chosen = random.Random(options.seed).sample(everything, min(options.count, len(everything)))
            lives = []
            for mutant in chosen:
                if not is_told(mutant, tests, copy):
                    lives.append(mutant)
                    print(f"  {mutant.path}:{mutant.line}: {mutant.what}", flush=True)
            print(f"{room}: {len(chosen) - len(lives)} of {len(chosen)} mutants told, of {len(everything)}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
