# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A layout that records what panels and menus draw."""

import bpy


class Layout:
    """Records what a panel draws, checking that properties and operators exist."""

    def __init__(self, record=None, active=True, alert=False):
        kinds = (
            "prop",
            "label",
            "operator",
            "icon",
            "grayed",
            "menu",
            "pressed",
            "prop_enum",
            "progress",
            "alert",
            "slider",
        )
        self.record = record or {kind: [] for kind in kinds}
        self.active, self.alert = active, alert

    def row(self, **_options):
        return Layout(self.record, self.active, self.alert)

    column = split = row

    def progress(self, text="", **_options):
        self.record["progress"].append(text)

    def separator(self, **_options):
        pass

    def menu(self, name, **_options):
        assert issubclass(getattr(bpy.types, name), bpy.types.Menu)
        self.record["menu"].append(name)

    def prop(self, data, name, slider=False, **_options):
        # A custom property of Blender's is drawn by its key.
        assert name in data.bl_rna.properties or name[2:-2] in data
        self.record["prop"].append(name)
        if slider:
            self.record["slider"].append(name)
        if not self.active:
            self.record["grayed"].append(name)

    def prop_enum(self, data, name, identifier, **_options):
        assert identifier in data.bl_rna.properties[name].enum_items
        self.record["prop_enum"].append((name, identifier))

    def prop_search(self, data, name, source, collection, **_options):
        assert collection in source.bl_rna.properties
        self.prop(data, name)

    def label(self, text="", icon="NONE", translate=True):
        self.record["label"].append(text)
        if not self.active:
            self.record["grayed"].append(text)
        if self.alert:
            self.record["alert"].append(text)
        if icon != "NONE":
            self.record["icon"].append((text, icon))

    def operator(self, idname, depress=False, **_options):
        group, name = idname.split(".")
        assert getattr(bpy.types, f"{group.upper()}_OT_{name}").bl_rna
        self.record["operator"].append(idname)
        if depress:
            self.record["pressed"].append(idname)
        values = type("Values", (), {"preset": None})()
        self.record["values"] = values
        self.record[idname] = values
        return values


def draw(drawn):
    """Call the draw function of a panel or menu, or a function that draws, with a recording layout."""
    layout = Layout()
    getattr(drawn, "draw", drawn)(type("Drawn", (), {"layout": layout})(), bpy.context)
    return layout.record
