# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands as attributes of a mesh, and the note beside them that says how to read them.

With `mesh_bridge` and `shape_keys` the only file that touches mesh data. Positions are not written here.
"""

from __future__ import annotations

import re
from hashlib import blake2b
from typing import TYPE_CHECKING, Any, NamedTuple

from ...core.settings import DenoiseSettings
from ..properties.setting_values import FRAME_NAMES
from .mesh_bridge import ownership_refusal
from .own_names import is_own, remove_own

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

FORMAT = 1
NOTE = "framelet_bands"
LOW = "framelet_low"
REST = "framelet_rest"
COLORS = "framelet_band"
HEAT_COLORS = "framelet_heat_map"
COLORS_BEFORE = "framelet_colors_before"
NOISE = "framelet_noise"
NOISE_WIDTH = "framelet_noise_width"
"""Of the noise map: the numbers themselves, which stay when colors go, so that masks go on working."""

BANDS = rf"{LOW}|{REST}|framelet_L\d+_B\d+(_edges)?"
"""The names of all attributes with bands, as a regular expression."""

_OURS = re.compile(rf"{BANDS}|{COLORS}|{HEAT_COLORS}|{NOISE}|{NOISE_WIDTH}")
_AGAIN = "analyze it again."


class BandNote(NamedTuple):
    """How the bands of a mesh were made; kept as a custom property of the mesh.

    `n_bands` has the number of high bands of each level, finest first. `topology` and `rest` are fingerprints
    of the faces and of the analyzed positions.
    """

    frame: str
    stencil: str
    levels: int
    boundary: str
    n_bands: tuple[int, ...]
    topology: str
    rest: str


def band_name(level: int, band: int, is_on_edges: bool = False) -> str:
    """Return the attribute of a band: levels count from 1, the finest, and band 0 would be the low-pass.

    On a mesh with quads and pairs of triangles, cell-centered bands have one attribute on faces and one on
    edges, which `is_on_edges` names.
    """
    return f"framelet_L{level}_B{band}{'_edges' if is_on_edges else ''}"


def topology_fingerprint(surface: SurfaceMesh) -> str:
    """Return a short text that differs between meshes with different faces or edges."""
    digest = blake2b(digest_size=16)
    for array in (surface.face_offset, surface.corner_vertex, surface.corner_edge, surface.edges):
        digest.update(str(array.shape).encode())
        digest.update(array.tobytes())
    digest.update(str(surface.n_vertices).encode())
    return digest.hexdigest()


def position_fingerprint(positions: NDArray[np.float32]) -> str:
    """Return a short text that differs between positions."""
    return blake2b(positions.tobytes(), digest_size=16).hexdigest()


def has_note(mesh: bpy.types.Mesh) -> bool:
    """Tell whether bands were stored on a mesh."""
    return NOTE in mesh


def has_colors(mesh: bpy.types.Mesh) -> bool:
    """Tell whether a mesh has the colors of a band or a heat map."""
    found = (mesh.attributes.get(name) for name in (COLORS, HEAT_COLORS))
    return any(item is not None and is_own(item) for item in found)


def has_traces(mesh: bpy.types.Mesh) -> bool:
    """Tell whether there is anything to remove."""
    if NOTE in mesh or COLORS_BEFORE in mesh:
        return True
    return any(_OURS.fullmatch(item.name) and is_own(item) for item in mesh.attributes)


def write_note(mesh: bpy.types.Mesh, note: BandNote) -> None:
    """Write how the bands were made."""
    mesh[NOTE] = {"format": FORMAT, **note._asdict()}


def read_note(obj: bpy.types.Object) -> BandNote:
    """Return how the bands on an object's mesh were made.

    Raises
    ------
    ValueError
        In one sentence, if there are none, or if the note cannot be read.
    """
    name, found = f"‘{obj.name}’", obj.data.get(NOTE)
    if found is None:
        raise ValueError(f"{name} has no stored bands; analyze it first.")
    values: dict[str, Any] = found.to_dict() if hasattr(found, "to_dict") else {}
    if values.get("format") != FORMAT:
        raise ValueError(
            f"The bands of {name} have format {values.get('format')}, but this version reads format "
            f"{FORMAT}; {_AGAIN}"
        )
    del values["format"]
    if not _is_whole(values):
        raise ValueError(f"The custom property {NOTE} of {name} was altered; {_AGAIN}")
    return BandNote(**values | {"n_bands": tuple(values["n_bands"])})


def _is_whole(values: dict[str, Any]) -> bool:
    """Tell whether a note has the fields that it should have, with values that are possible."""
    kinds = {"levels": int, "n_bands": list}
    if set(values) != set(BandNote._fields):
        return False
    if not all(isinstance(value, kinds.get(key, str)) for key, value in values.items()):
        return False
    if values["frame"] == "AUTO":  # bands are those of one frame
        return False
    try:
        DenoiseSettings(method="POSITIONS", **{name: values[name] for name in FRAME_NAMES})
    except ValueError:
        return False
    counts = values["n_bands"]
    return len(counts) == values["levels"] and all(isinstance(n, int) and n > 0 for n in counts)


def write_vectors(mesh: bpy.types.Mesh, name: str, domain: str, vectors: NDArray[np.floating]) -> None:
    """Add an attribute of vectors, shape (elements of the domain, 3); its name must be free."""
    import numpy as np

    attribute = mesh.attributes.new(name, "FLOAT_VECTOR", domain)
    attribute.data.foreach_set("vector", np.ascontiguousarray(vectors, np.float32).reshape(-1))


def read_vectors(obj: bpy.types.Object, name: str, domain: str) -> NDArray[np.float32]:
    """Return an attribute of vectors, shape (elements of the domain, 3).

    Raises
    ------
    ValueError
        In one sentence, if it is missing, is of another kind, or holds numbers that are not finite.
    """
    import numpy as np

    mesh, who = obj.data, f"‘{obj.name}’"
    attribute = mesh.attributes.get(name)
    if attribute is None:
        raise ValueError(f"The attribute {name} of {who} is missing; {_AGAIN}")
    if (attribute.data_type, attribute.domain) != ("FLOAT_VECTOR", domain):
        raise ValueError(
            f"The attribute {name} of {who} is {attribute.data_type} on {attribute.domain} instead of "
            f"FLOAT_VECTOR on {domain}; {_AGAIN}"
        )
    n_elements = {"POINT": len(mesh.vertices), "EDGE": len(mesh.edges), "FACE": len(mesh.polygons)}[domain]
    if len(attribute.data) != n_elements:
        raise ValueError(
            f"The attribute {name} of {who} has {len(attribute.data)} values instead of {n_elements}; "
            f"{_AGAIN}"
        )
    vectors = np.empty((n_elements, 3), np.float32)
    attribute.data.foreach_get("vector", vectors.reshape(-1))
    if not np.isfinite(vectors).all():
        raise ValueError(f"The attribute {name} of {who} has numbers that are not finite; {_AGAIN}")
    return vectors


def write_numbers(obj: bpy.types.Object, name: str, values: NDArray[np.floating]) -> None:
    """Write an attribute of numbers at the vertices, shape (N,).

    A vertex group of that name, which somebody made of it, or an attribute of another kind stays instead:
    both cannot be.
    """
    import numpy as np

    mesh = obj.data
    if name in obj.vertex_groups:
        return
    attribute = mesh.attributes.get(name)
    if attribute is not None and not is_own(attribute):
        return
    attribute = attribute or mesh.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def write_colors(
    mesh: bpy.types.Mesh, colors: NDArray[np.float32], name: str = COLORS, domain: str = "POINT"
) -> None:
    """Write colors, and make them those that are shown and rendered; others of Framelet's are removed.

    `own_names.names_refusal` gives no reason against it.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        The mesh that is changed.
    colors : ndarray, shape (elements of the domain, 4), float32
        Scene-linear colors.
    name : str
        COLORS or HEAT_COLORS.
    domain : str
        POINT, or CORNER for colors that differ between faces.
    """
    if COLORS_BEFORE not in mesh:
        mesh[COLORS_BEFORE] = [mesh.attributes.active_color_name, mesh.attributes.default_color_name]
    for other in (COLORS, HEAT_COLORS):
        attribute = mesh.attributes.get(other)
        if attribute is None:
            continue
        if other != name or attribute.domain != domain:
            remove_own(mesh, other)
    if name not in mesh.attributes:
        mesh.color_attributes.new(name, "FLOAT_COLOR", domain)
    mesh.attributes[name].data.foreach_set("color", colors.reshape(-1))
    mesh.attributes.active_color_name = name
    mesh.attributes.default_color_name = name
    mesh.update()


def remove_bands(mesh: bpy.types.Mesh) -> None:
    """Remove the stored bands and the note, but neither colors nor the noise."""
    _remove(mesh, [item.name for item in mesh.attributes if re.fullmatch(BANDS, item.name)])
    if NOTE in mesh:
        del mesh[NOTE]


def remove_colors(mesh: bpy.types.Mesh) -> None:
    """Remove the colors of a band or heat map; those that were active before are active again."""
    _remove(mesh, (COLORS, HEAT_COLORS))
    if COLORS_BEFORE not in mesh:
        return
    names = mesh[COLORS_BEFORE]
    names = list(names) if hasattr(names, "__iter__") else []
    del mesh[COLORS_BEFORE]
    if len(names) != 2 or not all(isinstance(name, str) for name in names):
        names = [next(iter(mesh.color_attributes.keys()), "")] * 2  # somebody altered the note
    active, default = names
    mesh.attributes.active_color_name = active
    mesh.attributes.default_color_name = default
    mesh.update()


def remove_noise(mesh: bpy.types.Mesh) -> None:
    """Remove the numbers of the noise map."""
    _remove(mesh, (NOISE, NOISE_WIDTH))


def _remove(mesh: bpy.types.Mesh, names: Iterable[str]) -> None:
    """Remove attributes of ours by name, where they are there."""
    for name in names:
        remove_own(mesh, name)


def remove_object_colors(obj: bpy.types.Object) -> None:
    """Remove the colors from an object's mesh as `remove_colors` does.

    Raises
    ------
    ValueError
        With a sentence that names the object, if its mesh cannot be written to.
    """
    reason = ownership_refusal(obj)
    if reason is not None:
        raise ValueError(reason)
    remove_colors(obj.data)
