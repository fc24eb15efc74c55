# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write numbers on meshes as colors, all with the same range."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..bands.band_values import BandValues, ColorRange, find_limit
from ..mesh_io import band_storage
from ..properties.region_values import as_typed

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def chosen_limit(properties: Any, values: Sequence[NDArray[np.floating]], fixed: str = "limit") -> float:
    """Return the value of the last color, as the properties of a `RangeMixin` ask for.

    `fixed` names the property that holds a value of one's own.

    Raises
    ------
    ValueError
        In one sentence, if that was given as something else than a number of at least 0.
    """
    if properties.range_rule != "FIXED":
        share = as_typed(properties.percentile) if properties.range_rule == "PERCENTILE" else 100.0
        return find_limit(values, share)
    limit = getattr(properties, fixed)
    if not 0.0 <= limit < float("inf"):
        kind = {"limit_angle": "an angle", "limit_edges": "a width"}.get(fixed, "a length")
        raise ValueError(f"The range is {limit:g}; it must be {kind}.")
    return as_typed(limit)


def color_objects(
    found: Sequence[BandValues],
    is_signed: bool,
    limit: float,
    name: str = band_storage.COLORS,
    domain: str = "POINT",
    tolerance: float = 0.0,
) -> ColorRange:
    """Write the colors of values to the meshes of their objects.

    Parameters
    ----------
    found : sequence of BandValues
        Values at the elements of `domain`.
    is_signed : bool
        From -limit to limit, or from 0.
    limit : float
        The value of the last color.
    name, domain : str
        See `band_storage.write_colors`.
    tolerance : float
        Values of at most this magnitude are green; 0 for none. The range is at least as large.
    """
    import numpy as np

    from .colormaps import DIVERGING, SEQUENTIAL, map_colors

    limit = max(limit, tolerance)
    # Where nothing differs from zero everything takes the color of zero.
    scale = 1.0 / limit if limit > 0.0 else 0.0
    within = tolerance * scale if tolerance > 0.0 else None
    colormap = DIVERGING if is_signed else SEQUENTIAL
    for obj, values in found:
        band_storage.write_colors(obj.data, map_colors(colormap, values * scale, within), name, domain)
    magnitudes = np.abs(np.concatenate([values for _, values in found]))
    shares = [float((magnitudes <= each).mean()) for each in (limit, tolerance)]
    return ColorRange(limit, float(magnitudes.max()), shares[0], tolerance, shares[1] if tolerance else 0.0)
