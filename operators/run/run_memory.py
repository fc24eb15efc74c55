# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Remembers where the vertices of a mesh were before and after its last run.

It is kept in memory, not as an attribute: a run changes positions and nothing else, neither in the file nor
in what other tools see. A mesh is recognized by Blender's number for it and by its present positions, value
by value, so that undo, edits and other tools need not be watched: positions that are neither those before
nor those after are another shape.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ..mesh_io import mesh_bridge
from ..mesh_io.shape_keys import read_followers, write_followers

if TYPE_CHECKING:
    from collections.abc import Mapping

    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

MOST_BYTES = 1_000_000_000
"""What is remembered of all meshes together; the oldest are forgotten first."""


class LastRun(NamedTuple):
    """Positions of a mesh, shape (N, 3), float32, in object space.

    `followers` are the shape keys that moved with the active one: their points before and after, by name.
    """

    before: NDArray[np.float32]
    after: NDArray[np.float32]
    followers: dict[str, tuple[NDArray[np.float32], NDArray[np.float32]]]

    @property
    def n_bytes(self) -> int:
        """Memory of all arrays."""
        pairs = [(self.before, self.after), *self.followers.values()]
        return sum(before.nbytes + after.nbytes for before, after in pairs)


class Recalled(NamedTuple):
    """A last run, the mesh as it is now, and whether it is as after the run."""

    run: LastRun
    surface: SurfaceMesh
    is_after: bool


_runs: dict[int, LastRun] = {}


def remember(
    obj: bpy.types.Object,
    surface: SurfaceMesh,
    positions: NDArray[np.float32],
    followers: Mapping[str, NDArray[np.float32]],
) -> None:
    """Remember a run whose result was just written.

    Parameters
    ----------
    obj : bpy.types.Object
        The object that has the result.
    surface : SurfaceMesh
        The mesh as it was before; its positions are kept and must not be changed afterwards.
    positions : ndarray, shape (N, 3), float32
        What `mesh_bridge.write_vertices` returned; kept, and not to be changed afterwards.
    followers : mapping
        What `shape_keys.read_followers` returned before the result was written.
    """
    import numpy as np

    moved = read_followers(obj)
    pairs = {name: (points, moved[name]) for name, points in followers.items() if name in moved}
    key = obj.data.session_uid
    _runs.pop(key, None)
    _runs[key] = LastRun(np.asarray(surface.vertices, np.float32), positions, pairs)
    while len(_runs) > 1 and sum(run.n_bytes for run in _runs.values()) > MOST_BYTES:
        del _runs[next(iter(_runs))]


def is_remembered(obj: bpy.types.Object | None) -> bool:
    """Tell whether there was a run; quick, and without looking at positions."""
    return obj is not None and obj.type == "MESH" and obj.data.session_uid in _runs


def recall(obj: bpy.types.Object) -> Recalled:
    """Return the last run of an object's mesh.

    Raises
    ------
    ValueError
        In one sentence, if there was none, or the mesh is as neither before nor after it.
    """
    import numpy as np

    if not is_remembered(obj):
        raise ValueError(f"‘{obj.name}’ was not denoised since this file was opened; denoise it first.")
    run = _runs[obj.data.session_uid]
    surface = mesh_bridge.read_surface(obj)
    for positions, is_after in ((run.after, True), (run.before, False)):
        if np.array_equal(surface.vertices, positions):
            return Recalled(run, surface, is_after)
    raise ValueError(
        f"‘{obj.name}’ was changed since it was denoised, or another shape key is active; denoise it again."
    )


def flip(obj: bpy.types.Object) -> bool:
    """Move an object's mesh to where it was before its last run, or back to where it was after.

    Returns
    -------
    bool
        Whether it is now as after the run.

    Raises
    ------
    ValueError
        In one sentence, if it cannot be edited or `recall` refuses. The mesh is as it was.
    """
    import numpy as np

    reason = mesh_bridge.refusal(obj)
    if reason is not None:
        raise ValueError(reason)
    run, surface, is_after = recall(obj)
    # What moved along gets its own bits back, unless it was edited meanwhile: then it moves along again.
    present = read_followers(obj)
    exact = {
        name: points[not is_after]
        for name, points in run.followers.items()
        if name in present and np.array_equal(present[name], points[is_after])
    }
    mesh_bridge.write_vertices(obj, surface, run.before if is_after else run.after)
    write_followers(obj, exact)
    return not is_after


def forget_runs() -> None:
    """Forget all meshes."""
    _runs.clear()
