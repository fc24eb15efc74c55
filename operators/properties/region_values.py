# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender properties to the options of a region, and which of them have an effect.

Nothing here refers to bpy, for the reason given in `setting_values`.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from .region_options import RegionOptions

REGION_NAMES = tuple(item.name for item in fields(RegionOptions))


def to_region_options(properties: Any) -> RegionOptions:
    """Return the options that properties stand for.

    Parameters
    ----------
    properties : RegionMixin
        Scene settings or an operator.

    Raises
    ------
    ValueError
        In one sentence, if a value is not allowed.
    """
    return RegionOptions(**{name: as_typed(getattr(properties, name)) for name in REGION_NAMES})


def as_typed(value: Any) -> Any:
    """Return the number that was typed: properties hold single precision, 0.3 as 0.30000001."""
    return float(f"{value:.7g}") if isinstance(value, float) else value


def shown_region_names(properties: Any) -> list[str]:
    """Return the options that have an effect with the others as they are."""
    needs = {
        "invert_group": bool(properties.vertex_group),
        "max_edges": properties.limit == "EDGES",
        "max_length": properties.limit == "LENGTH",
        "weld_distance": properties.weld,
        "straighten_borders": properties.boundary != "FIXED",
    }
    return [name for name in REGION_NAMES if needs.get(name, True)]
