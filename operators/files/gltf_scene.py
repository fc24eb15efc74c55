# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the nodes of a glTF file place its meshes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .gltf_buffers import as_count
from .mesh_file import FileError


def placed_meshes(content: dict[str, Any]) -> list[tuple[int, NDArray[np.float64]]]:
    """Return the meshes that the scene shows and their matrices, shape (4, 4).

    Parameters
    ----------
    content : dict
        The JSON text of a glTF file.

    Raises
    ------
    FileError
        In one sentence, if a node does not exist, or names no mesh or no place.

    Examples
    --------
    >>> nodes = [{"translation": [1, 0, 0], "children": [1]}, {"mesh": 0, "scale": [2, 2, 2]}]
    >>> ((mesh, matrix),) = placed_meshes({"nodes": nodes, "scenes": [{"nodes": [0]}], "meshes": [{}]})
    >>> mesh, matrix[:3, 3].tolist(), float(matrix[0, 0])
    (0, [1.0, 0.0, 0.0], 2.0)
    """
    try:
        return _placed(content)
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"The scene of the file is damaged ({type(error).__name__}).") from error


def _placed(content: dict[str, Any]) -> list[tuple[int, NDArray[np.float64]]]:
    nodes, scenes, n_meshes = content.get("nodes", []), content.get("scenes", []), len(content["meshes"])
    if not scenes:
        return [(number, np.eye(4)) for number in range(n_meshes)]
    roots = scenes[as_count(content.get("scene", 0))].get("nodes", [])
    found, seen = [], set()
    waiting = [(root, np.eye(4)) for root in reversed(roots)]
    while waiting:
        number, above = waiting.pop()
        if number in seen:  # each node has one parent; a circle would never end
            continue
        seen.add(number)
        node = nodes[as_count(number)]
        with np.errstate(over="ignore", invalid="ignore"):
            matrix = above @ _matrix(node)
        if not np.isfinite(matrix).all():
            raise FileError(f"Node {number} is placed by numbers that are not finite; the file is damaged.")
        if "mesh" in node:
            if as_count(node["mesh"]) >= n_meshes:
                raise FileError(
                    f"Node {number} names mesh {node['mesh']}, but there are {n_meshes}; the file is damaged."
                )
            found.append((node["mesh"], matrix))
        waiting += [(child, matrix) for child in reversed(node.get("children", []))]
    return found


def _matrix(node: dict[str, Any]) -> NDArray[np.float64]:
    """Return the matrix of a node, shape (4, 4)."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    result = np.eye(4)
    result[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    result[:3, :3] *= np.array(node.get("scale", (1.0, 1.0, 1.0)), np.float64)
    result[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return result
