# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of translations have the form of their texts, and Blender finds them."""

from string import Formatter

import bpy
import pytest
import translatable
from framelet.operators.properties.settings import CONTEXT, OWN_WORDS
from framelet.ui import translations

LANGUAGES = list(translations.TRANSLATIONS)


def test_the_search_for_texts_finds_them():
    found = translatable.messages()
    assert {
        ("Operator", "Denoise"),
        ("Operator", "Heat Map"),
        ("*", "Engine"),
        ("*", "Select at least one mesh object"),
        ("*", "Showing {names} before denoising"),
        (CONTEXT, "Box Spline"),
        ("*", "Result"),
        ("*", "Smoothing λ"),
        ("*", "Open mesh"),
        ("*", "{:.3f} edge lengths"),
    } <= found
    assert not [text for _, text in found if text.startswith(("OBJECT_", "VIEW3D_"))]


@pytest.mark.parametrize("language", LANGUAGES)
def test_translations_have_the_same_fields_and_form(language):
    for (_, text), translated in translations.TRANSLATIONS[language].items():
        fields = [
            [part[1:3] for part in Formatter().parse(each) if part[1] is not None]
            for each in (text, translated)
        ]
        assert sorted(fields[0]) == sorted(fields[1]), text
        assert translated and translated == translated.strip()


def test_entries_are_what_blender_wants():
    for language, entries in translations.TRANSLATIONS.items():
        assert language.islower() and len(language) == 2
        for (context, text), translated in entries.items():
            assert (
                context in {"*", "Operator", CONTEXT}
                and isinstance(text, str)
                and isinstance(translated, str)
            )


@pytest.mark.skipif(
    not bpy.app.build_options.international, reason="this Blender was built without translations"
)
def test_blender_looks_the_texts_up():
    preferences = bpy.context.preferences.view
    before = preferences.language
    languages = [item.identifier for item in preferences.bl_rna.properties["language"].enum_items]
    try:
        preferences.language = next(each for each in languages if each.partition("_")[0] == "de")
        preferences.use_translate_interface = True
        # Where Blender has a word itself, as for "Engine", its own translation comes first.
        assert bpy.app.translations.pgettext_iface("Smoothing λ") == "Glättung λ"
        assert bpy.app.translations.pgettext_iface("Denoise", "Operator") == "Entrauschen"
    finally:
        preferences.language = before


def test_words_that_mean_something_else_in_blender_have_a_context_of_their_own():
    entries = translations.TRANSLATIONS["de"]
    for owner in (bpy.context.scene.framelet.bl_rna, bpy.ops.object.framelet_denoise.get_rna_type()):
        for name in OWN_WORDS:
            prop = owner.properties[name]
            assert prop.translation_context == CONTEXT
            for text in (prop.name, *(item.name for item in prop.enum_items)):
                assert (CONTEXT, text) in entries, text
    assert entries[CONTEXT, "Boundary"] == "Rand"
