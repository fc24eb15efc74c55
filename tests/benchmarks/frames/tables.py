# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as Markdown tables."""

import math
from collections.abc import Iterable, Sequence

from algorithms import LEVELS, NORMALS, preset_keys
from dilation import Cost
from measuring import Row

CHOICES = ("default", "best")


class Results:
    """Rows that can be asked for."""

    def __init__(self, rows: Iterable[Row]) -> None:
        self.rows = list(rows)
        self._by_key = {(row.mesh, row.algorithm, row.choice): row for row in self.rows}

    def meshes(self, is_quad: bool | None = None) -> list[str]:
        """Return the names of the meshes, of one kind if wanted, in order."""
        names = sorted({row.mesh for row in self.rows})
        if is_quad is None:
            return names
        return [name for name in names if self.has(name, "QUAD_1") == is_quad]

    def has(self, mesh: str, algorithm: str) -> bool:
        """Return whether an algorithm ran on a mesh."""
        return (mesh, algorithm, "default") in self._by_key

    def get(self, mesh: str, algorithm: str, choice: str) -> Row:
        """Return a row."""
        return self._by_key[mesh, algorithm, choice]

    def noisy(self, mesh: str) -> Row:
        """Return the row of the mesh before denoising."""
        return self._by_key[mesh, "", "noisy"]


def markdown(head: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    """Return a table whose first column is text and whose others are numbers."""
    lines = ["| " + " | ".join(head) + " |", "|---|" + "--:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in body]) + "\n"


def mean_table(results: Results) -> str:
    """Return means of the paper's presets, the baseline and the main frames over all meshes of a kind."""
    head = ["Faces", "Algorithm", "Angle", "rms", "Angle, best λ", "rms, best λ"]
    body = []
    for is_quad in (False, True):
        meshes = results.meshes(is_quad)
        frame = "LINEAR_SPLINE" if is_quad else "BOX_SPLINE_111"
        kind = f"{len(meshes)} of {'quads' if is_quad else 'triangles'}"
        names = {key: key.capitalize().replace("_", "-") for key in preset_keys(is_quad)}
        names |= {f"{frame} STRAIGHT 1": f"`{frame}`", "ADAPTIVE ADAPTIVE 1": "`ADAPTIVE`"}
        for key, name in names.items() if meshes else ():
            cells = []
            for choice in CHOICES:
                rows = [results.get(mesh, key, choice) for mesh in meshes]
                cells += [f"{_mean(row.angle for row in rows):.2f}", f"{_mean(row.rms for row in rows):.2f}"]
            body.append([kind, name, *cells])
    return markdown(head, body)


def preset_table(results: Results, is_quad: bool) -> str:
    """Return angle and rms of the presets at their defaults and at the best of their grids."""
    keys = ("BILATERAL", "QUAD_1", "QUAD_2") if is_quad else ("BILATERAL", "TRI_1", "TRI_2")
    labels = [key.capitalize().replace("_", "-") for key in keys]
    head = ["Mesh", "Noisy"] + [f"{label}, {choice}" for choice in CHOICES for label in labels]
    body = []
    for mesh in results.meshes(is_quad):
        cells = []
        for choice in CHOICES:
            rows = [results.get(mesh, key, choice) for key in keys]
            lowest = min(row.angle for row in rows)
            cells += [_cell(row, row.angle == lowest) for row in rows]
        noisy = results.noisy(mesh)
        body.append([_mesh(noisy), f"{noisy.angle:.2f}", *cells])
    return markdown(head, body)


def extra_table(results: Results, is_quad: bool) -> str:
    """Return angle and rms of the paper's presets by number of levels, and of the presets on normals."""
    keys = preset_keys(is_quad)[1:]
    names = [key if levels == 1 else f"{key} {levels}" for key in keys for levels in LEVELS] + list(NORMALS)
    head = ["Mesh", "Noisy"]
    head += [f"{key.capitalize().replace('_', '-')}, {_levels(levels)}" for key in keys for levels in LEVELS]
    head += [key.title().replace("_", "-") for key in NORMALS]
    body = []
    for mesh in results.meshes(is_quad):
        if not results.has(mesh, names[-1]):
            continue
        rows = [results.get(mesh, name, "default") for name in names]
        lowest = min(row.angle for row in rows)
        noisy = results.noisy(mesh)
        body.append([_mesh(noisy), f"{noisy.angle:.2f}", *(_cell(row, row.angle == lowest) for row in rows)])
    return markdown(head, body)


def stencil_table(results: Results) -> str:
    """Return MEAN against STRAIGHT, over all faces and over those at creases."""
    head = ["Mesh", "Frame"]
    head += [f"{rule}, {choice}" for choice in CHOICES for rule in ("MEAN", "STRAIGHT")]
    body = []
    for mesh in results.meshes():
        frame = "LINEAR_SPLINE" if results.has(mesh, "QUAD_1") else "BOX_SPLINE_111"
        if not all(results.has(mesh, f"{frame} {rule} 1") for rule in ("MEAN", "STRAIGHT")):
            continue
        cells = []
        for choice in CHOICES:
            rows = [results.get(mesh, f"{frame} {rule} 1", choice) for rule in ("MEAN", "STRAIGHT")]
            lowest = min(row.angle for row in rows)
            lowest_at_creases = min(row.crease_angle for row in rows)
            cells += [
                _bold(f"{row.angle:.2f}", row.angle == lowest)
                + " / "
                + _bold(_number(row.crease_angle), row.crease_angle == lowest_at_creases)
                for row in rows
            ]
        body.append([mesh, frame, *cells])
    return markdown(head, body)


def level_table(results: Results) -> str:
    """Return angle and rms of the main frames by number of levels."""
    head = ["Mesh", "Frame"] + [f"{_levels(levels)}, {choice}" for choice in CHOICES for levels in LEVELS]
    body = []
    for mesh in results.meshes():
        for name in ("BOX_SPLINE_111 STRAIGHT", "LINEAR_SPLINE STRAIGHT", "ADAPTIVE ADAPTIVE"):
            if not results.has(mesh, f"{name} {LEVELS[-1]}"):
                continue
            cells = []
            for choice in CHOICES:
                rows = [results.get(mesh, f"{name} {levels}", choice) for levels in LEVELS]
                lowest = min(row.angle for row in rows)
                cells += [_cell(row, row.angle == lowest) for row in rows]
            body.append([mesh, name.split()[0], *cells])
    return markdown(head, body)


def frame_table(results: Results, is_quad: bool) -> str:
    """Return every frame's angle, as a mean over the meshes on which all ran."""
    head = ["Frame and stencil"] + [f"{_levels(levels)}, {choice}" for choice in CHOICES for levels in LEVELS]
    head += ["Seconds, 1 level", "3 levels"]
    names = sorted({row.algorithm.rsplit(" ", 1)[0] for row in results.rows if row.group == "FRAMES"})
    meshes = [mesh for mesh in results.meshes(is_quad) if results.has(mesh, f"B_SPLINE_5 MEAN {LEVELS[-1]}")]
    body = []
    for name in names:
        if not meshes or not results.has(meshes[0], f"{name} {LEVELS[-1]}"):
            continue
        cells = []
        for choice in CHOICES:
            for levels in LEVELS:
                rows = [results.get(mesh, f"{name} {levels}", choice) for mesh in meshes]
                cells.append(f"{_mean(row.angle for row in rows):.2f} ({_mean(row.rms for row in rows):.2f})")
        for levels in (LEVELS[0], LEVELS[-1]):
            rows = [results.get(mesh, f"{name} {levels}", "default") for mesh in meshes]
            cells.append(f"{sum(row.seconds for row in rows):.2f}")
        body.append([name, *cells])
    return f"Means over {', '.join(meshes) or 'no mesh'}.\n\n" + markdown(head, body)


def cost_table(costs: Iterable[Cost]) -> str:
    """Return time and memory of dilation."""
    head = ["Mesh", "Vertices", "Frame", "Levels", "Widest ring", "Transform, s"]
    head += ["Peak before, MB", "Peak after, MB"]
    body = [
        [
            cost.mesh,
            f"{cost.vertices:,}",
            cost.frame,
            str(cost.levels),
            str(2 ** (cost.levels - 1)),
            f"{cost.transform_seconds:.2f}",
            f"{cost.start_megabytes:.0f}",
            f"{cost.transform_megabytes:.0f}",
        ]
        for cost in costs
    ]
    return markdown(head, body)


def _levels(number: int) -> str:
    """Return a number of levels in words."""
    return f"{number} level{'' if number == 1 else 's'}"


def _mesh(row: Row) -> str:
    """Return a mesh's name and size."""
    return f"{row.mesh} ({row.vertices:,})"


def _cell(row: Row, is_lowest: bool) -> str:
    """Return angle and rms."""
    return f"{_bold(f'{row.angle:.2f}', is_lowest)} ({row.rms:.2f})"


def _bold(text: str, is_bold: bool) -> str:
    """Return a text, in bold if wanted."""
    return f"**{text}**" if is_bold else text


def _number(value: float) -> str:
    """Return a number, or a dash for one that there is not."""
    return "-" if math.isnan(value) else f"{value:.2f}"


def _mean(values: Iterable[float]) -> float:
    """Return the mean of some numbers."""
    values = list(values)
    return sum(values) / len(values)
