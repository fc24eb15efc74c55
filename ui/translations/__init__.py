# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender shows for Framelet in other languages.

Blender looks texts up by context: *Operator* for the names of operators and the texts on their buttons, * for
everything else. A text without an entry is shown in English; `make translations` lists them.
"""

import bpy

from ...core.settings.choices import BOUNDARIES, FRAMES
from ...operators.properties.settings import CONTEXT
from . import (
    german_bands,
    german_modifier,
    german_operators,
    german_region,
    german_reports,
    german_settings,
)

OWN_WORDS = ("Boundary", "Frame", *(choice.label for choice in (*BOUNDARIES, *FRAMES)))
"""Words whose meaning here Blender's own dictionaries do not know: the properties with `CONTEXT`."""

_GERMAN = (
    german_operators,
    german_settings,
    german_bands,
    german_modifier,
    german_region,
    german_reports,
)

TRANSLATIONS = {
    # The language without a country serves all countries.
    "de": {
        **{
            ("Operator", text): german
            for module in (german_operators, german_modifier)
            for text, german in module.NAMES.items()
        },
        **{
            (CONTEXT, text): module.TEXTS[text]
            for module in _GERMAN
            for text in OWN_WORDS
            if text in module.TEXTS
        },
        **{("*", text): german for module in _GERMAN for text, german in module.TEXTS.items()},
    }
}


def register() -> None:
    """Add the translations to Blender's."""
    bpy.app.translations.register(__package__, TRANSLATIONS)


def unregister() -> None:
    """Take them away."""
    bpy.app.translations.unregister(__package__)
