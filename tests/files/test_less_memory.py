# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A command line with less and less memory gives a result or a sentence, and never half a file."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LIMITS = (1, 6, 20, 2000)
"""Megabytes more than what the program has at its start."""

PROGRAM = """
import hashlib, json, os, resource, sys
sys.modules["bpy"] = None
sys.path.insert(0, {tests!r})
from conftest import load_package
load_package()
import numpy as np
from framelet.operators.command_line import main
n, folder = 80, sys.argv[1]
z = np.random.default_rng(1).normal(0.0, 0.1, (n, n))
with open(folder + "/in.obj", "w") as file:
    file.writelines(f"v {{i}} {{j}} {{z[i, j]:.4f}}\\n" for i in range(n) for j in range(n))
    for i in range(n - 1):
        for j in range(n - 1):
            a, b = i * n + j + 1, (i + 1) * n + j + 1
            file.write(f"f {{a}} {{b}} {{b + 1}} {{a + 1}}\\n")
words = ["denoise", folder + "/in.obj", folder + "/out.obj", "--preset", "positions", "--quiet"]
def run():
    try:
        return main(words) or 0
    except SystemExit as end:
        return end.code or 0
from framelet.core import denoise
from framelet.operators.command_line import file_work
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
found = []
for megabytes in {limits!r}:
    resource.setrlimit(resource.RLIMIT_AS, (used + megabytes * 1000000, resource.RLIM_INFINITY))
    code = run()
    resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    digest = ""
    if os.path.exists(folder + "/out.obj"):
        digest = hashlib.sha256(open(folder + "/out.obj", "rb").read()).hexdigest()
        os.remove(folder + "/out.obj")
    found.append([megabytes, code, digest])
print(json.dumps(found))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of memory and /proc, as Linux has them")
def test_less_and_less_memory(tmp_path):
    program = PROGRAM.format(tests=str(ROOT / "tests"), limits=LIMITS)
    command = [sys.executable, "-c", program, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Traceback" not in done.stderr, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    _, code, whole = found[-1]
    assert code == 0 and whole
    for megabytes, code, digest in found:
        assert (code, digest) in ((0, whole), (1, "")), (megabytes, code, done.stderr)
    assert found[0][1] == 1 and "memory" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["in.obj"]
