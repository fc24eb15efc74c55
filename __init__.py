# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Framelet: clean noisy surfaces in Blender with tight wavelet frames.

Nothing is imported here but on registration, so that ``framelet.core`` can be
used and tested where there is no Blender.
"""


def register() -> None:
    """Add the operators, settings and panels to Blender."""
    from . import operators, ui

    operators.register()
    ui.register()


def unregister() -> None:
    """Take away all that `register` added, in reverse order."""
    from . import operators, ui

    ui.unregister()
    operators.unregister()
