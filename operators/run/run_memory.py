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

from ..mesh_io import custom_normals, mesh_bridge
from ..mesh_io.shape_keys import active_key, read_followers, read_key_points, write_followers
from ..modifier.inputs import get_input, set_input
from ..modifier.node_groups import ON
from ..modifier.recipes import DISPLACEMENT
from ..modifier.stack import find_modifier
from ..properties.output_choices import IN_PLACE, MODIFIER, NEW_OBJECT, SHAPE_KEY

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

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
    output: str = IN_PLACE
    """Where the result is. With the output Modifier the mesh stays as before, and the modifier moves it."""
    normals: tuple[NDArray[np.float32], NDArray[np.float32]] | None = None
    """Custom normals of the corners before and after, shape (C, 3) each; None without any."""

    @property
    def n_bytes(self) -> int:
        """Memory of all arrays."""
        pairs = [(self.before, self.after), *self.followers.values()]
        pairs += [self.normals] if self.normals else []
        return sum(before.nbytes + after.nbytes for before, after in pairs)


class Recalled(NamedTuple):
    """A last run, the mesh as it is now, and whether it is as after the run."""

    run: LastRun
    surface: SurfaceMesh
    is_after: bool


_runs: dict[int, LastRun] = {}

_sides: dict[int, tuple[str, str]] = {}
"""Which side of its run a mesh shows, with the shape key that was active when it was found."""


def remember(
    obj: bpy.types.Object,
    surface: SurfaceMesh,
    positions: NDArray[np.float32],
    followers: Mapping[str, NDArray[np.float32]],
    *,
    output: str = IN_PLACE,
    normals: NDArray[np.float32] | None = None,
) -> None:
    """Remember a run whose result was just written.

    A run that moved nothing leaves what is known of the run before it.

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
    output : str
        One of `output_choices.OUTPUTS`, where the result is.
    normals : ndarray, shape (C, 3), optional
        What `custom_normals.read_normals` returned before the result was written.
    """
    import numpy as np

    last = _runs.get(obj.data.session_uid)
    if last is not None and np.array_equal(positions, surface.vertices) and _knows(last, positions):
        return
    moved = read_followers(obj)
    pairs = {name: (points, moved[name]) for name, points in followers.items() if name in moved}
    key = obj.data.session_uid
    _runs.pop(key, None)
    now = None if normals is None else custom_normals.read_normals(obj.data)
    both = None if normals is None or now is None else (normals, now)
    _runs[key] = LastRun(np.asarray(surface.vertices, np.float32), positions, pairs, output, both)
    _sides.pop(key, None)
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
    modifier = find_modifier(obj, DISPLACEMENT)
    if run.output == MODIFIER and modifier is not None and np.array_equal(surface.vertices, run.before):
        return Recalled(run, surface, bool(get_input(modifier, ON)))
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
    modifier = find_modifier(obj, DISPLACEMENT)
    _sides.pop(obj.data.session_uid, None)
    if run.output == MODIFIER and modifier is not None:
        set_input(modifier, ON, not is_after)
        return not is_after
    # What moved along gets its own bits back, unless it was edited meanwhile: then it moves along again.
    present = read_followers(obj)
    exact = {
        name: points[not is_after]
        for name, points in run.followers.items()
        if name in present and np.array_equal(present[name], points[is_after])
    }
    mesh_bridge.write_vertices(obj, surface, run.before if is_after else run.after)
    write_followers(obj, exact)
    if run.normals is not None and not obj.data.is_editmode:
        custom_normals.write_normals(obj.data, run.normals[not is_after])
    return not is_after


def last_run_of(obj: bpy.types.Object, surface: SurfaceMesh) -> LastRun | None:
    """Return the run whose result an object's mesh still is; None if it is not, or no way leads back.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object.
    surface : SurfaceMesh
        Its mesh as it is now.
    """
    import numpy as np

    run = _runs.get(obj.data.session_uid)
    if run is None or run.output == MODIFIER or not np.array_equal(surface.vertices, run.after):
        return None
    key = active_key(obj)
    if run.output == SHAPE_KEY and (key is None or not np.array_equal(_base_points(key), run.before)):
        return None
    return run


def go_back(obj: bpy.types.Object, output: str) -> str:
    """Give the mesh of an object, which is the result of a run, its shape before that run.

    Parameters
    ----------
    obj : bpy.types.Object
        An object of which `last_run_of` knows a run.
    output : str
        Where the next result is to go.

    Returns
    -------
    str
        Where it has to go: an object that was made for a result takes the next one too.
    """
    run = _runs[obj.data.session_uid]
    if run.output == SHAPE_KEY:
        key = obj.active_shape_key
        obj.active_shape_key_index = obj.data.shape_keys.key_blocks.find(key.relative_key.name)
        if output != SHAPE_KEY:
            key.value = 0.0
        return output
    flip(obj)
    return IN_PLACE if run.output == output == NEW_OBJECT else output


def known_side(obj: bpy.types.Object | None) -> str:
    """Tell which side of its last run an object shows: AFTER, BEFORE, or empty for neither or no run.

    For panels: meshes are compared once after each change, and not in Edit Mode.
    """
    if obj is None or not is_remembered(obj) or obj.mode == "EDIT":
        return ""
    uid = obj.data.session_uid
    modifier = find_modifier(obj, DISPLACEMENT)
    if _runs[uid].output == MODIFIER and modifier is not None:
        return "AFTER" if get_input(modifier, ON) else "BEFORE"
    key = active_key(obj)
    name = "" if key is None else key.name
    if _sides.get(uid, ("", ""))[0] != name or uid not in _sides:
        try:
            side = "AFTER" if recall(obj).is_after else "BEFORE"
        except ValueError:
            side = ""
        _sides[uid] = name, side
    return _sides[uid][1]


def shows_result(obj: bpy.types.Object | None) -> bool:
    """Tell whether an object shows the result of a run; that in a modifier also after a file was opened."""
    modifier = find_modifier(obj, DISPLACEMENT)
    return known_side(obj) == "AFTER" if modifier is None else bool(get_input(modifier, ON))


def forget_sides(touched: Iterable[int] | None = None) -> None:
    """Have `known_side` look again at meshes, by their numbers in the session; at all by default."""
    for uid in list(_sides) if touched is None else touched:
        _sides.pop(uid, None)


def forget_runs() -> None:
    """Forget all meshes."""
    _runs.clear()
    _sides.clear()


def _knows(run: LastRun, positions: NDArray[np.float32]) -> bool:
    """Tell whether positions are those of a mesh before or after a run."""
    import numpy as np

    return np.array_equal(positions, run.after) or np.array_equal(positions, run.before)


def _base_points(key: bpy.types.ShapeKey) -> NDArray[np.float32]:
    """Return the points of the key that a key is relative to."""
    return read_key_points(key.relative_key)
