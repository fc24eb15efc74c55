# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every property has a label, a unit, and a tooltip that says what larger does."""

import re

import bpy
import framelet.ui
import pytest
from framelet.operators import registration
from translatable import own_properties, rna_of

RESULTS = {kind.__name__ for owner, _, kind in registration.POINTERS if owner is bpy.types.WindowManager}
RESULTS |= {"FrameletNoise"}
"""What a run found, which nobody sets."""

LARGER = re.compile(r"\b(larger|higher|more|another number)\b", re.IGNORECASE)
UNIT = re.compile(
    r"edge lengths|units of|scene units|megabytes|share|factor|degrees|without unit|unit normals|seconds",
    re.IGNORECASE,
)


def cases(*, results):
    """Return the classes with properties and the names of these."""
    return [
        pytest.param(each, name, id=f"{each.__name__}.{name}")
        for each in registration.classes
        if results or each.__name__ not in RESULTS
        for name in own_properties(each)
    ]


def test_the_classes_have_properties():
    names = {case.id for case in cases(results=False)}
    assert {
        "FrameletSettings.lambda_",
        "OBJECT_OT_framelet_denoise.mu",
        "FrameletHeatMap.percentile",
    } <= names


@pytest.mark.parametrize(("each", "name"), cases(results=True))
def test_every_property_has_a_label_and_a_tooltip(each, name):
    prop = rna_of(each).properties[name]
    assert prop.name and prop.name[0].isupper() and "_" not in prop.name
    assert len(prop.description) > 10 and prop.description[0].isupper()
    assert not prop.description.endswith((".", " "))
    for item in getattr(prop, "enum_items", ()):
        assert item.name and item.description and not item.description.endswith("."), item.identifier


@pytest.mark.parametrize(("each", "name"), cases(results=False))
def test_numbers_say_what_larger_does_and_in_which_unit(each, name):
    prop = rna_of(each).properties[name]
    if prop.type not in {"INT", "FLOAT"}:
        return
    assert LARGER.search(prop.description), prop.description
    if prop.type == "FLOAT":
        has_unit = prop.unit != "NONE" or prop.subtype == "PERCENTAGE"
        assert has_unit or UNIT.search(prop.description), prop.description


@pytest.mark.parametrize(
    "each", [*registration.classes, *framelet.ui.classes], ids=lambda each: each.__name__
)
def test_every_class_says_what_it_is_for(each):
    if issubclass(each, bpy.types.Operator):
        rna = rna_of(each)
        assert rna.name == each.bl_label and len(rna.description) > 20
        assert not rna.description.endswith(".")
    elif issubclass(each, (bpy.types.Panel, bpy.types.Menu)):
        assert each.bl_label
    assert each.__doc__
