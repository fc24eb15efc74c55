# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds every text that Blender shows for Framelet: in registered classes, and in the source."""

import ast
import functools
from pathlib import Path

import bpy
import framelet.ui
from framelet.operators import registration

ROOT = Path(__file__).resolve().parents[1]
MARKERS = ("n_", "rpt_", "iface_", "tip_")
DRAWN = {"label": "*", "prop": "*", "menu": "*", "prop_search": "*", "operator": "Operator"}
"""Methods of layouts, and the context in which Blender looks up their argument `text`."""

TABLES = {"draw_value": (1, 2), "draw_lengths": (2,)}
"""Functions of `ui.panels.layouts`, and which of their arguments are shown as labels."""


@functools.cache
def messages():
    """Return all texts as pairs of context and message, a frozen set; the source is read once."""
    found = set()
    for each in (*registration.classes, *framelet.ui.classes):
        found |= _of_class(each)
    for folder in ("operators", "ui"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            found |= _of_source(path)
    # A name may be empty, and what has no letters is the same in every language.
    return frozenset((context, text) for context, text in found if any(map(str.isalpha, text)))


def rna_of(each):
    """Return what Blender knows of a registered class; of operators that is another type."""
    if not issubclass(each, bpy.types.Operator):
        return each.bl_rna
    group, _, name = each.bl_idname.partition(".")
    return getattr(getattr(bpy.ops, group), name).get_rna_type()


def own_properties(each):
    """Return the names of the properties that a class or its mixins define, but not Blender's."""
    names = {}
    for base in reversed(each.__mro__):
        if base.__module__.startswith("framelet"):
            names |= dict.fromkeys(vars(base).get("__annotations__", ()))
    return list(names)


def _of_class(each):
    """Return the texts of a registered class: its name and description, and those of its own properties."""
    rna = rna_of(each)
    found = set()
    if issubclass(each, bpy.types.Operator):
        found |= {("Operator", rna.name), ("*", rna.description)}
    elif issubclass(each, (bpy.types.Panel, bpy.types.Menu)):
        found.add(("*", each.bl_label))
    for name in own_properties(each):
        prop = rna.properties[name]
        context = prop.translation_context
        found |= {(context, prop.name), ("*", prop.description)}
        for item in getattr(prop, "enum_items", ()):
            found |= {(context, item.name), ("*", item.description)}
    return found


def _of_source(path):
    """Return the texts that a source file marks or draws."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if not isinstance(node, ast.Call):
            continue
        name = getattr(node.func, "id", None) or getattr(node.func, "attr", "")
        if name in MARKERS:
            context = node.args[1].value if len(node.args) > 1 else "*"
            found |= {(context, text) for text in _constants(node.args[0])}
        elif name in TABLES:
            for place in TABLES[name]:
                if place < len(node.args):
                    found |= {("*", text) for text in _constants(node.args[place])}
        elif name in DRAWN and isinstance(node.func, ast.Attribute):
            for keyword in node.keywords:
                if keyword.arg == "text":
                    found |= {(DRAWN[name], text) for text in _constants(keyword.value)}
    return found


def _constants(node):
    """Return the texts that an expression may be."""
    if isinstance(node, ast.Constant):
        return [node.value] if isinstance(node.value, str) else []
    if isinstance(node, ast.IfExp):
        return _constants(node.body) + _constants(node.orelse)
    if isinstance(node, ast.BoolOp):
        return [text for value in node.values for text in _constants(value)]
    return []
