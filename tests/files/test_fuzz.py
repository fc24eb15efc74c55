# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Damaged files end in one sentence, or in a result: no traceback, no bomb, nothing written by halves.

`FRAMELET_FUZZ=2000` tries as many files as it says; `make fuzz` does so.
"""

import os
import re
import resource
import tracemalloc

import numpy as np
import pytest
from framelet.operators.files import FileError, open_file

from .made import (
    full_gltf,
    full_obj,
    full_ply,
    full_stl_binary,
    full_stl_text,
    normals_of,
    sheet,
    with_normals,
)

N_FILES = int(os.environ.get("FRAMELET_FUZZ", "288"))
MOST_MEMORY = 60e6
"""Bytes; the files have up to 40 kB."""

SEEDS = {
    "ascii.ply": full_ply("ascii")[0],
    "little.ply": full_ply("binary_little_endian")[0],
    "big.ply": full_ply("binary_big_endian", "double")[0],
    "normals.ply": with_normals(*sheet(), normals_of(*sheet()), "binary_big_endian"),
    "a.obj": full_obj(),
    "text.stl": full_stl_text(),
    "binary.stl": full_stl_binary(),
    "a.glb": full_gltf("glb")[0],
    "a.gltf": full_gltf("embedded")[0],
}
HOSTILE = [
    *(
        b"nan",
        b"-inf",
        b"1e999",
        b"-1",
        b"0",
        b"4294967295",
        b"99999999999999999999",
        b"-9223372036854775808",
    ),
    *(b"{", b"]", b"\x00", b"'", b'"', b"\\", b"[" * 5000, b"null", b"true"),
    *(b"list", b"property list uchar float x"),
]


def mutated(content, rng):
    """Return a content with a few mistakes: cut, flipped, doubled, shuffled, or with hostile words."""
    data = bytearray(content)
    for _ in range(rng.choice([1, 1, 1, 2, 3, 4])):
        if not data:
            break
        # Most mistakes belong to the beginning, where headers are.
        at = int(rng.integers(0, len(data) if rng.random() < 0.5 else min(len(data), 700)))
        kind = rng.integers(0, 7)
        if kind == 0:
            del data[at:]
        elif kind == 1:
            data[at] = int(rng.integers(0, 256))
        elif kind == 2:
            data[at] ^= 1 << int(rng.integers(0, 8))
        elif kind == 3:
            stop = at + int(rng.integers(1, 200))
            data[at:at] = data[at:stop]
        elif kind == 4:
            del data[at : at + int(rng.integers(1, 200))]
        elif kind == 5:
            numbers = list(re.finditer(rb"-?\d+(\.\d+)?", bytes(data[:2000])))
            if numbers:
                found = numbers[int(rng.integers(0, len(numbers)))]
                data[found.start() : found.end()] = HOSTILE[int(rng.integers(0, len(HOSTILE)))]
        else:
            data[at : at + 4] = HOSTILE[int(rng.integers(0, len(HOSTILE)))]
    return bytes(data)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", SEEDS)
def test_damaged_files(command, tmp_path, name):
    rng = np.random.default_rng(sum(name.encode()))
    n_read = 0
    for number in range(max(N_FILES // len(SEEDS), 1)):
        source = tmp_path / f"{number}-{name}"
        content = mutated(SEEDS[name], rng)
        source.write_bytes(content)
        tracemalloc.start()
        try:
            try:
                file = open_file(source)
            except FileError as error:
                file = None
                assert "\n" not in str(error) and str(error).endswith("."), (number, str(error))
            peak = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
        assert peak < MOST_MEMORY, (number, peak)
        if file is not None:
            n_read += 1
            assert file.patched(file.positions) == content
        target = tmp_path / f"out-{name}"
        result = command("denoise", source, target, "--preset", "tri-2")
        assert result.code in (0, 1) and "Traceback" not in result.err, (number, result.err)
        if result.code:
            assert result.err.splitlines()[-1].startswith("framelet: ") and not target.exists(), number
        else:
            assert len(open_file(target).corner_vertex) == len(file.corner_vertex), number
            target.unlink()
        source.unlink()
        assert not any(path.name.startswith(".framelet") for path in tmp_path.iterdir())
    assert n_read or N_FILES < 100
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < 4e6  # kilobytes
