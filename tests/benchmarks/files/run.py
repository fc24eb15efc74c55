# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure seconds and peak memory of reading and writing mesh files, beside Blender and trimesh.

    python3 .ci/environment.py run speed -- tests/benchmarks/files/run.py --update

Each run is a process of its own, one after the other; of three the best one counts. `--update` puts the table
into docs/scripts/files.md.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[2]
PAGE = ROOT / "docs" / "scripts" / "files.md"
BEGIN, END = "<!-- table -->\n", "<!-- end of table -->\n"
PROGRAMS = ("framelet", "blender", "trimesh")
FILES = {
    "PLY, binary": "binary.ply",
    "PLY, ascii": "ascii.ply",
    "OBJ": "mesh.obj",
    "STL, binary": "binary.stl",
    "GLB": "mesh.glb",
}
TIMEOUT = 600


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=1000, help="vertices along each side of the sheet")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--python", action="append", default=[], metavar="PROGRAM=PYTHON")
    parser.add_argument("--update", action="store_true", help="put the table into docs/scripts/files.md")
    arguments = parser.parse_args()
    pythons = dict(word.split("=", 1) for word in arguments.python)
    with tempfile.TemporaryDirectory() as folder:
        make_files(Path(folder), arguments.side)
        found = {
            (title, program): best(
                pythons.get(program, sys.executable), program, Path(folder) / name, arguments.repeats
            )
            for title, name in FILES.items()
            for program in PROGRAMS
        }
    text = table(found)
    print(text)
    if arguments.update:
        page = PAGE.read_text(encoding="utf-8")
        head, tail = page.split(BEGIN)[0], page.split(END)[1]
        PAGE.write_text(head + BEGIN + text + END + tail, encoding="utf-8")


def make_files(folder, side):
    """Write a noisy sheet of side * side vertices in all formats, by plain means."""
    i, j = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    points = np.stack([i, j, 10 * np.sin(i / 50) * np.cos(j / 70)], -1).reshape(-1, 3) * 0.01
    points = (points + np.random.default_rng(0).normal(0, 0.002, points.shape)).astype("<f4")
    a = (i * side + j)[:-1, :-1].ravel()
    faces = np.stack([a, a + side, a + side + 1, a, a + side + 1, a + 1], 1).reshape(-1, 3)
    flat, corners = tuple(points.ravel().tolist()), tuple(faces.ravel().tolist())
    n = len(points)
    head = "element vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n"
    head = head.format(n, len(faces)) + "property list uchar int vertex_indices\nend_header\n"
    rows = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", 3)])
    rows["n"], rows["v"] = 3, faces
    binary = f"ply\nformat binary_little_endian 1.0\n{head}".encode() + points.tobytes() + rows.tobytes()
    (folder / "binary.ply").write_bytes(binary)
    text = ("%.6f %.6f %.6f\n" * n) % flat + ("3 %d %d %d\n" * len(faces)) % corners
    (folder / "ascii.ply").write_text(f"ply\nformat ascii 1.0\n{head}{text}")
    text = ("v %.6f %.6f %.6f\n" * n) % flat + ("f %d %d %d\n" * len(faces)) % tuple(
        (faces + 1).ravel().tolist()
    )
    (folder / "mesh.obj").write_text(text)
    triangles = np.zeros(len(faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    triangles["corners"], triangles["normal"] = points[faces], (0, 0, 1)
    (folder / "binary.stl").write_bytes(bytes(80) + np.uint32(len(faces)).tobytes() + triangles.tobytes())
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": n, "type": "VEC3",
             "min": points.min(0).tolist(), "max": points.max(0).tolist()},
            {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes},
            {"buffer": 0, "byteOffset": points.nbytes, "byteLength": faces.size * 4},
        ],
        "buffers": [{"byteLength": points.nbytes + faces.size * 4}],
    }  # fmt: skip
    words = json.dumps(content).encode()
    words += b" " * (-len(words) % 4)
    chunk = points.tobytes() + faces.astype("<u4").tobytes()
    sizes = np.array([2, 12 + 8 + len(words) + 8 + len(chunk), len(words), 0x4E4F534A], "<u4").tobytes()
    tail = np.array([len(chunk), 0x004E4942], "<u4").tobytes()
    (folder / "mesh.glb").write_bytes(b"glTF" + sizes + words + tail + chunk)


def best(python, program, source, repeats):
    """Return the least of what some runs took; None if the program is not there or fails."""
    found = []
    for _ in range(repeats):
        target = source.with_name(f"out-{source.name}")
        words = [python, str(FOLDER / "task.py"), program, str(source), str(target)]
        result = subprocess.run(words, capture_output=True, text=True, timeout=TIMEOUT, check=False)
        target.unlink(missing_ok=True)
        if result.returncode:
            print(f"{program} on {source.name}: {result.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
            return None
        found.append(json.loads(result.stdout.strip().splitlines()[-1]))
    return {key: min(each[key] for each in found) for key in found[0]}


def table(found):
    """Return the table as Markdown."""
    lines = [
        "| 1M vertices, 2M triangles | Framelet | Blender | trimesh |",
        "|---|---|---|---|",
    ]
    for title in FILES:
        cells = []
        for program in PROGRAMS:
            each = found[title, program]
            cells.append(
                f"{each['read']:.1f} + {each['write']:.1f} s, {each['megabytes']:,.0f} MB" if each else "-"
            )
        lines.append(f"| {title} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
