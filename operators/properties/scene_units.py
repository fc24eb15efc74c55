# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths as the scene shows them: with the object's scale, in the scene's units."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh


LEAST_WIDTH = 0.4
"""Width of noise in edges up to which nothing is said of it: it is next to white."""


def linear_part(obj: bpy.types.Object) -> NDArray[np.float64]:
    """Return the rotation and scale of an object, shape (3, 3); it is applied to rows as `rows @ part.T`."""
    import numpy as np

    return np.array(obj.matrix_world, np.float64)[:3, :3]


def origin_of(obj: bpy.types.Object) -> NDArray[np.float64]:
    """Return where an object is in the scene, shape (3,)."""
    import numpy as np

    return np.array(obj.matrix_world.translation, np.float64)


def displacement_in_scene(
    obj: bpy.types.Object, before: NDArray[np.floating], after: NDArray[np.floating]
) -> tuple[float, float]:
    """Return how far the vertices of an object moved in the scene, as `displacement_by` does."""
    return displacement_by(linear_part(obj), before, after)


def displacement_by(
    linear: NDArray[np.float64],
    before: NDArray[np.floating],
    after: NDArray[np.floating],
    n_threads: int = 0,
) -> tuple[float, float]:
    """Return how far vertices moved in the scene.

    Parameters
    ----------
    linear : ndarray, shape (3, 3)
        From `linear_part`; the scale counts, also where it differs between the axes.
    before, after : ndarray, shape (N, 3)
        Positions in object space.
    n_threads : int
        Number of threads; 0 takes one for each core.

    Returns
    -------
    rms, maximum : float
        Over all vertices, in scene units.
    """
    import numpy as np

    from ...core.blocks import Blocks

    def measure(start: int, stop: int) -> tuple[float, float]:
        moved = after[start:stop].T.astype(np.float64, order="C")
        moved -= before[start:stop].T
        moved = linear @ moved
        moved *= moved
        squares = moved[0]
        squares += moved[1]
        squares += moved[2]
        return float(squares.sum()), float(squares.max())

    def quietly(start: int, stop: int) -> tuple[float, float]:
        with np.errstate(invalid="ignore", over="ignore"):  # positions that were not finite before
            return measure(start, stop)

    with Blocks(n_threads) as blocks:
        sums, largest = zip(*blocks.run(quietly, len(after)), strict=True)
    return float(np.sqrt(sum(sums) / len(after))), float(np.sqrt(max(largest)))


def length_in_scene(obj: bpy.types.Object, length: float) -> float:
    """Return a length of no particular direction in scene units, as `length_by` does."""
    return length_by(linear_part(obj), length)


def length_by(linear: NDArray[np.float64], length: float) -> float:
    """Return a length of no particular direction in scene units.

    Parameters
    ----------
    linear : ndarray, shape (3, 3)
        From `linear_part`; where the scale differs between the axes, the root mean square over all directions
        counts.
    length : float
        In object space.
    """
    import numpy as np

    return length * float(np.sqrt(np.square(linear).sum() / 3.0))


def surface_in_scene(obj: bpy.types.Object, surface: SurfaceMesh) -> SurfaceMesh:
    """Return a surface with the rotation and scale of an object, but not its place in the scene."""
    import numpy as np

    part = linear_part(obj)
    if np.array_equal(part, np.eye(3)):
        return surface
    return surface.with_vertices(surface.vertices.astype(np.float64) @ part.T)


def turning(linear: NDArray[np.float64]) -> float:
    """Return -1 where a rotation and scale, shape (3, 3), turn faces over, else 1; 0 without a volume."""
    import numpy as np

    with np.errstate(invalid="ignore", over="ignore"):
        return float(np.sign(np.linalg.det(linear)))


def noise_text(scene: bpy.types.Scene, sigma: float, sigma_edges: float, is_impulsive: bool) -> str:
    """Return the measured noise in words; `sigma` is in scene units."""
    from bpy.app.translations import pgettext_rpt as rpt_

    if is_impulsive:
        text = rpt_("{length} ({edges:.3f} edge lengths, impulsive)")
    else:
        text = rpt_("{length} ({edges:.3f} edge lengths)")
    return text.format(length=length_text(scene, sigma), edges=sigma_edges)


def length_text(scene: bpy.types.Scene, length: float) -> str:
    """Return a length in words, in the units that the scene shows."""
    import bpy

    units = scene.unit_settings
    if units.system == "NONE":
        return f"{length:.4g}"
    return bpy.utils.units.to_string(
        units.system,
        "LENGTH",
        length * units.scale_length,
        precision=4,
        split_unit=False,
        compatible_unit=False,
    )


def range_text(low: float, high: float, scene: bpy.types.Scene | None = None) -> str:
    """Return two numbers in words, as lengths of a scene if one is given; their mean if they are close."""
    from bpy.app.translations import pgettext_rpt as rpt_

    unit, size = ("", 1.0) if scene is None else _unit_of(scene, high)
    if high <= 1.1 * low:  # beyond that two digits are enough to tell them apart
        low = high = (low + high) / 2.0
    texts = [f"{value / size:.2g}" for value in (low, high)]
    return (rpt_("{low} to {high}").format(low=texts[0], high=texts[1]) if low < high else texts[1]) + unit


def value_texts(scene: bpy.types.Scene, values: Sequence[float], unit: str = "LENGTH") -> list[str]:
    """Return values with their signs in words.

    LENGTH are all in the unit of the largest, ANGLE in degrees, and EDGES in mean edge lengths.
    """
    sign, size = {"ANGLE": "°"}.get(unit, ""), 1.0
    if unit == "LENGTH":
        sign, size = _unit_of(scene, max(map(abs, values)))
    # A true minus sign, as wide as a plus; and no zero has one.
    return [f"{'−' if value < 0.0 else ''}{three_digits(abs(value) / size)}{sign}" for value in values]


def three_digits(value: float) -> str:
    """Return a number of at least 0 with three digits that count; whole numbers have all of theirs.

    Examples
    --------
    >>> three_digits(0.12345), three_digits(1234.5), three_digits(2.0)
    ('0.123', '1234', '2')
    """
    return f"{value:.0f}" if 1e3 <= value < 1e6 else f"{value:.3g}"


def _unit_of(scene: bpy.types.Scene, length: float) -> tuple[str, float]:
    """Return the unit in which the scene shows a length, and its size in lengths of the scene.

    Without units, and for lengths that are too small for any, that is no unit.
    """
    import bpy

    units = scene.unit_settings
    found = re.fullmatch(r"([\d.]+)(.*)", length_text(scene, length))
    if units.system == "NONE" or found is None or (length and not float(found[1])):
        return "", 1.0
    unit = found[2]
    return unit, bpy.utils.units.to_value(units.system, "LENGTH", f"1{unit}") / units.scale_length
