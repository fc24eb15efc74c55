# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Run in a Blender without window: install the extension, and save preferences that suit tests.

    blender -b --python first_start.py -- framelet.zip SCALE OVERLAP

With OVERLAP 1 it looks as users know it; 0 is faster with software OpenGL.
"""

import sys

import bpy

ZIP, SCALE, OVERLAP = sys.argv[sys.argv.index("--") + 1 :]


def main() -> None:
    """Install, enable, and save."""
    done = bpy.ops.extensions.package_install_files(filepath=ZIP, repo="user_default", enable_on_install=True)
    assert done == {"FINISHED"}, done
    preferences = bpy.context.preferences
    preferences.view.show_splash = False
    preferences.view.show_tooltips = False
    preferences.view.smooth_view = 0
    # Without this a move of the mouse over the sidebar draws the viewport below it, several times.
    preferences.system.use_region_overlap = OVERLAP == "1"
    preferences.system.viewport_aa = "8" if OVERLAP == "1" else "OFF"
    preferences.view.ui_scale = float(SCALE)
    preferences.use_preferences_save = False
    preferences.filepaths.use_auto_save_temporary_files = False
    bpy.ops.wm.save_userpref()


try:
    main()
except BaseException as error:
    sys.stdout.write(f"{type(error).__name__}: {error}\n")
    sys.exit(1)
