# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Small mesh files, written and read by other means than ours, and a way to call the command line."""

from types import SimpleNamespace

import numpy as np
import pytest

N_SIDE = 7


@pytest.fixture
def command(capfd):
    """Call `main` with arguments; give exit code, stdout and stderr, file descriptors included."""
    from framelet.operators.command_line import main

    def call(*arguments):
        capfd.readouterr()
        code = main([str(argument) for argument in arguments])
        out, err = capfd.readouterr()
        return SimpleNamespace(code=code, out=out, err=err)

    return call


@pytest.fixture
def fails(command):
    """Call `main` with arguments that cannot work; give the one sentence."""

    def call(*arguments, code=1):
        result = command(*arguments)
        assert result.code == code, result
        assert result.out == "" or result.out.startswith("Read ")
        lines = result.err.splitlines()
        assert len(lines) == 1, result.err
        assert lines[0].startswith("framelet: ") and lines[0].endswith((".", ".)"))
        return lines[0]

    return call


@pytest.fixture
def grid(rng):
    """A noisy grid of quads and triangles, float32, with a loose vertex in the middle of the order."""
    x, y = np.meshgrid(np.arange(N_SIDE), np.arange(N_SIDE), indexing="ij")
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3) + rng.normal(0, 0.1, (N_SIDE**2, 3))
    number = np.arange(N_SIDE**2).reshape(N_SIDE, N_SIDE)
    # The loose vertex takes number 10; what comes after moves on by one.
    number[number >= 10] += 1
    vertices = np.insert(points, 10, (20.0, 0.0, 0.0), axis=0).astype(np.float32)
    faces = []
    for a, b, c, d in zip(
        number[:-1, :-1].flat, number[1:, :-1].flat, number[1:, 1:].flat, number[:-1, 1:].flat, strict=True
    ):
        faces += [(a, b, c, d)] if (a + b) % 3 else [(a, b, c), (a, c, d)]
    faces = [tuple(int(v) for v in face) for face in faces]
    colors = rng.integers(0, 256, (len(vertices), 4))
    uvs = rng.random((len(vertices), 2)).astype(np.float32)
    return SimpleNamespace(
        vertices=vertices,
        faces=faces,
        colors=colors,
        uvs=uvs,
        used_vertices=np.delete(vertices, 10, axis=0),
        faces_of_used=[tuple(v - (v > 10) for v in face) for face in faces],
    )


def digits(values):
    """Return float32 numbers as words that give them back."""
    return " ".join(str(np.float32(value)) for value in values)


@pytest.fixture
def write_ply():
    """Write an ASCII PLY file; colors and UVs are optional."""

    def write(path, vertices, faces, colors=None, uvs=None):
        lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
        lines += [f"property float {axis}" for axis in "xyz"]
        lines += [f"property uchar {c}" for c in ("red", "green", "blue", "alpha") if colors is not None]
        lines += [f"property float {c}" for c in "st" if uvs is not None]
        lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
        for index, vertex in enumerate(vertices):
            row = [digits(vertex)]
            row += [] if colors is None else [" ".join(map(str, colors[index]))]
            row += [] if uvs is None else [digits(uvs[index])]
            lines.append(" ".join(row))
        lines += [" ".join(map(str, (len(face), *face))) for face in faces]
        path.write_text("\n".join(lines) + "\n")
        return path

    return write


@pytest.fixture
def write_obj():
    """Write an OBJ file; UVs are optional and one per vertex."""

    def write(path, vertices, faces, uvs=None, before=""):
        lines = [before] if before else []
        lines += ["v " + digits(vertex) for vertex in vertices]
        lines += ["vt " + digits(uv) for uv in uvs] if uvs is not None else []
        for face in faces:
            lines.append("f " + " ".join(f"{v + 1}/{v + 1}" if uvs is not None else f"{v + 1}" for v in face))
        path.write_text("\n".join(lines) + "\n")
        return path

    return write


PLY_TYPES = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4", "uint": "<u4"}


@pytest.fixture
def read_ply():
    """Read a PLY file, ascii or little-endian: the vertices as a structured array, faces as tuples."""

    def read(path):
        header, body = path.read_bytes().split(b"end_header\n", 1)
        fields, counts, element, count_type = [], {}, None, "uchar"
        for line in header.decode().splitlines():
            words = line.split()
            if words[0] == "element":
                element = words[1]
                counts[element] = int(words[2])
            elif words[0] == "property" and element == "vertex":
                fields.append((words[2], PLY_TYPES[words[1]]))
            elif words[0] == "property" and words[1] == "list":
                count_type = words[2]
        if b"format ascii" in header:
            lines = body.decode().splitlines()
            rows = [tuple(map(float, line.split())) for line in lines[: counts["vertex"]]]
            vertices = np.array(rows, np.dtype(fields))
            last = counts["vertex"] + counts.get("face", 0)
            faces = [tuple(map(int, line.split()[1:])) for line in lines[counts["vertex"] : last]]
        else:
            vertices = np.frombuffer(body, np.dtype(fields), counts["vertex"])
            faces, start = [], vertices.nbytes
            for _ in range(counts.get("face", 0)):
                n = int(np.frombuffer(body, PLY_TYPES[count_type], 1, start)[0])
                start += np.dtype(PLY_TYPES[count_type]).itemsize
                faces.append(tuple(np.frombuffer(body, "<u4", n, start).tolist()))
                start += 4 * n
        positions = np.stack([vertices[axis] for axis in "xyz"], axis=1)
        return SimpleNamespace(vertices=positions, faces=faces, fields=vertices)

    return read


@pytest.fixture
def read_obj():
    """Read an OBJ file: positions as float32, faces, texture coordinates by face."""

    def read(path):
        vertices, uvs, faces, uv_faces, others = [], [], [], [], []
        for line in path.read_text().splitlines():
            word, *rest = line.split() or [""]
            if word == "v":
                vertices.append([float(number) for number in rest])
            elif word == "vt":
                uvs.append([float(number) for number in rest])
            elif word == "f":
                corners = [corner.split("/") for corner in rest]
                faces.append(tuple(int(corner[0]) - 1 for corner in corners))
                uv_faces.append([int(corner[1]) - 1 for corner in corners if len(corner) > 1 and corner[1]])
            else:
                others.append(line)
        rows = np.array(vertices)
        return SimpleNamespace(
            vertices=rows[:, :3].astype(np.float32),
            colors=rows[:, 3:],
            faces=faces,
            uvs=np.array(uvs),
            uv_faces=uv_faces,
            others=others,
        )

    return read
