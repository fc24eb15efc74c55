# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the development meshes: binary PLY and Wavefront OBJ, as far as those files use them."""

import numpy as np
from checks import wild_mesh


def mesh_files(folder, *kinds):
    """Return the paths of the meshes in some of the folders, sorted."""
    return sorted(
        path for kind in kinds for path in (folder / kind).iterdir() if path.suffix in (".ply", ".obj")
    )


def read_mesh(path, dtype=np.float32):
    """Return the mesh of a file, with float32 positions unless told otherwise."""
    vertices, faces, loose = (_read_ply if path.suffix == ".ply" else _read_obj)(path)
    return wild_mesh(np.asarray(vertices, dtype).reshape(-1, 3), faces, loose)


def _read_obj(path):
    vertices, faces, loose = [], [], []
    for line in path.read_text().splitlines():
        key, *words = line.split() or [""]
        if key == "v":
            vertices.append([float(word) for word in words])
        elif key == "f":
            faces.append([int(word.split("/")[0]) - 1 for word in words])
        elif key == "l":
            loose.append([int(word) - 1 for word in words])
    return vertices, faces, loose


def _read_ply(path):
    head, _, body = path.read_bytes().partition(b"end_header\n")
    words = [line.split() for line in head.decode().splitlines()]
    assert words[1][1] == "binary_little_endian", path
    counts = {line[1]: int(line[2]) for line in words if line[0] == "element"}
    n = counts["vertex"]
    vertices = np.frombuffer(body, "<f4", 3 * n).reshape(n, 3)
    faces, end = _ply_faces(body, 12 * n, counts.get("face", 0))
    loose = np.frombuffer(body, "<i4", 2 * counts.get("edge", 0), end).reshape(-1, 2)
    return vertices, faces, loose


def _ply_faces(body, begin, n_faces):
    """Return the faces and where they end: an array where all have one size, else a list."""
    if not n_faces:
        return [], begin
    size = body[begin]
    layout = np.dtype([("size", "u1"), ("vertices", "<i4", (size,))])
    if begin + n_faces * layout.itemsize <= len(body):
        table = np.frombuffer(body, layout, n_faces, begin)
        if (table["size"] == size).all():
            return table["vertices"], begin + n_faces * layout.itemsize
    faces = []
    for _ in range(n_faces):
        size = body[begin]
        faces.append(np.frombuffer(body, "<i4", size, begin + 1))
        begin += 1 + 4 * size
    return faces, begin
