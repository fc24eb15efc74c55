# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write docs/scripts/operators.md, the signatures of all operators, from what Blender knows of them.

Run it on any supported Blender: the page is the same on all. A test compares the two.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

PAGE = Path(__file__).resolve().parents[1] / "scripts" / "operators.md"

INTRODUCTION = """\
# Operators

<!-- Written by docs/demo/operator_page.py; do not edit by hand. -->

What stands on Framelet's buttons and in its menus can be called from Python. Every argument is optional and
has its name; called from Python, an operator finishes before the call returns. It returns `{'FINISHED'}`, or
raises `RuntimeError` with one sentence that says why nothing was done. [The cookbook](cookbook.md) shows them
at work.

Operators take what they need from their arguments and nothing from the sidebar. Arguments of
`object.framelet_denoise` that are not given are those of the preset. The default preset, `AUTO`, uses few of
them; a value that the engine does not use is named in a warning, and the run goes on without it. Lengths in
*edge lengths* are in units of the mean edge length of the mesh.
"""


def page() -> str:
    """Return the text of the page."""
    import bpy
    from framelet.operators.registration import classes

    parts = [INTRODUCTION]
    described: dict[tuple[str, str], str] = {}
    for each in classes:
        if issubclass(each, bpy.types.Operator) and "INTERNAL" not in each.bl_options:
            parts.append(section(each.bl_idname, described))
    return "\n".join(parts)


def section(idname: str, described: dict[tuple[str, str], str]) -> str:
    """Return what the page says of one operator; what it said before, it says once."""
    import bpy

    group, _, name = idname.partition(".")
    rna = getattr(getattr(bpy.ops, group), name).get_rna_type()
    properties = [prop for prop in rna.properties if prop.identifier != "rna_type"]
    properties.sort(key=lambda prop: prop.identifier != "preset")  # the one that most people need comes first
    lines = [
        f"## {rna.name}",
        "",
        f"`bpy.ops.{idname}({'...' if properties else ''})`",
        "",
        f"{rna.description}.",
        "",
    ]
    if properties:
        lines += ["| Argument | Default | Values | What it is |", "|---|---|---|---|"]
        lines += [_row(prop, described.setdefault(_words(prop), rna.name), rna.name) for prop in properties]
        lines.append("")
    return "\n".join(lines)


def _row(prop: Any, first: str, here: str) -> str:
    """Return the line of one argument; `first` is the operator that had it first."""
    values, text = _words(prop)
    if first != here:
        values, text = "", f"As in [{first}](#{first.lower().replace(' ', '-')})"
    return f"| `{prop.identifier}` | `{_default(prop)}` | {values} | {text} |"


def _words(prop: Any) -> tuple[str, str]:
    """Return the values of an argument, and what it is."""
    text = prop.description.replace("|", "\\|")
    return _values(prop), f"{prop.name}. {text}"


def _default(prop: Any) -> str:
    """Return the default as it would be typed."""
    if prop.type == "FLOAT":
        # Properties hold single precision.
        return repr(float(f"{prop.default:.6g}"))
    return repr(prop.default)


def _values(prop: Any) -> str:
    """Return which values an argument may have."""
    if prop.type == "ENUM":
        return ", ".join(f"`{item.identifier}`" for item in prop.enum_items)
    if prop.type == "BOOLEAN":
        return "`True`, `False`"
    if prop.type == "STRING":
        return "text"
    kind = "whole number" if prop.type == "INT" else "radians" if prop.unit == "ROTATION" else "number"
    low, high = (f"{float(f'{end:.6g}'):g}" for end in (prop.hard_min, prop.hard_max))
    if prop.hard_max >= (2**31 - 1 if prop.type == "INT" else 1e30):
        return f"{kind}, {low} or more"
    return f"{kind}, {low} to {high}"


def main() -> None:
    """Write the page."""
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    from checkout import load_framelet

    load_framelet()
    import framelet

    framelet.register()
    try:
        PAGE.write_text(page(), "utf-8")
    finally:
        # An operator that is registered when Python exits hangs some versions of Blender.
        framelet.unregister()


if __name__ == "__main__":
    main()
