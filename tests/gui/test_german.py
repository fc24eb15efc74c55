# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""German in a Blender that was built with translations, as the module bpy is not."""

import pytest
from blender_window.pixels import changed

CHOOSE = """
view = bpy.context.preferences.view
names = [item.identifier for item in view.bl_rna.properties["language"].enum_items]
view.language = next(name for name in names if language in (name, name.partition("_")[0]))
for name in ("use_translate_interface", "use_translate_tooltips", "use_translate_reports"):
    if hasattr(view, name):
        setattr(view, name, language != "en_US")
for area in window().screen.areas:
    for each in area.regions:
        each.tag_redraw()
"""

LOOK_UP = """
from bpy.app.translations import pgettext_iface, pgettext_rpt, pgettext_tip
ours = next(module for name, module in sys.modules.items() if name.endswith(".framelet.ui.translations"))
entries = ours.TRANSLATIONS["de"]
kept = sum(pgettext_iface(text, context) == german for (context, text), german in entries.items())
result = {
    "button": pgettext_iface("Denoise", "Operator"),
    "label": pgettext_iface("Smoothing λ"),
    "tooltip": pgettext_tip("How far each vertex moved, whatever the direction"),
    "report": pgettext_rpt("Showing {names} before denoising").format(names="‘Ball’"),
    "share": kept / len(entries),
}
"""

POLL = """
with override():
    try:
        bpy.ops.object.framelet_heat_map()
    except RuntimeError as error:
        result = str(error)
"""


@pytest.fixture
def german(ball):
    """The session in German."""
    ball.run("import sys\n" + CHOOSE, language="de")
    ball.settle(1.0)
    yield ball
    ball.run(CHOOSE, language="en_US")
    ball.settle(0.5)


def test_the_sidebar_speaks_german(german):
    shown = german.part("UI")
    german.run(CHOOSE, language="en_US")
    german.settle(1.0)
    assert changed(shown, german.part("UI")) > 0.01


def test_every_kind_of_text_is_looked_up(german):
    found = german.run("import sys\n" + LOOK_UP)
    # A few words Blender has itself; its own translation then comes first.
    assert found.pop("share") > 0.8
    assert found == {
        "button": "Entrauschen",
        "label": "Glättung λ",
        "tooltip": "Wie weit sich jeder Punkt bewegte, gleich in welcher Richtung",
        "report": "Zustand von ‘Ball’ vor dem Entrauschen",
    }


def test_a_gray_button_says_why_in_german(german):
    assert "Zuerst ein ausgewähltes Netz entrauschen" in german.run(POLL)
