# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/scripts/operators.md says what Blender knows of the operators, on every version."""

import importlib.util
import re
from pathlib import Path

import bpy
from framelet.operators import registration

DOCS = Path(__file__).resolve().parents[2] / "docs"


def load_program():
    spec = importlib.util.spec_from_file_location("operator_page", DOCS / "demo" / "operator_page.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_up_to_date():
    written = (DOCS / "scripts" / "operators.md").read_text("utf-8")
    assert written == load_program().page(), "run docs/demo/operator_page.py with Blender's Python"


def test_every_operator_and_argument_is_on_it():
    text = (DOCS / "scripts" / "operators.md").read_text("utf-8")
    for each in registration.classes:
        if not issubclass(each, bpy.types.Operator) or "INTERNAL" in each.bl_options:
            continue
        name = each.bl_idname.partition(".")[2]
        section = re.search(rf"^## {re.escape(each.bl_label)}\n.*?(?=^## |\Z)", text, re.S | re.M).group()
        assert f"`bpy.ops.{each.bl_idname}(" in section
        arguments = set(re.findall(r"^\| `(\w+)` \|", section, re.M))
        rna = getattr(bpy.ops.object, name).get_rna_type()
        assert arguments == {prop.identifier for prop in rna.properties} - {"rna_type"}


def test_defaults_can_be_passed_as_they_stand_there():
    text = (DOCS / "scripts" / "operators.md").read_text("utf-8")
    for line in re.findall(r"^\| `\w+` \| `[^`]*` \|", text, re.M):
        name, default = re.match(r"\| `(\w+)` \| `([^`]*)` \|", line).groups()
        assert repr(eval(default, {})) == default, name
