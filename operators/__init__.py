# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All that knows Blender but does not draw: operators, settings, reports and the command line.

Blender is imported on registration only: the console command says in a sentence where it is missing.
"""


def register() -> None:
    """Register the classes, the pointers to them and the command."""
    from . import registration

    registration.register()


def unregister() -> None:
    """Take everything away in reverse order."""
    from . import registration

    registration.unregister()
