# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The choices of the setting `output`. Knows no Blender, for the command line."""

from ...core.settings.choices import Choice

IN_PLACE, SHAPE_KEY, NEW_OBJECT, MODIFIER = "IN_PLACE", "SHAPE_KEY", "NEW_OBJECT", "MODIFIER"

OUTPUTS = (
    Choice(
        MODIFIER,
        "Modifier",
        "The mesh stays as it is, and a modifier moves it: its amount and mask can be changed at any time, "
        "keyed, and taken away",
    ),
    Choice(IN_PLACE, "In Place", "The mesh itself is changed; with shape keys, the active one"),
    Choice(
        SHAPE_KEY,
        "Shape Key",
        "A new shape key holds the result; its value sets the amount, also later, and can be keyed",
    ),
    Choice(NEW_OBJECT, "New Object", "A copy of the object holds the result; the original stays as it is"),
)
"""The choices of the setting `output`."""
