# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Framelet: clean noisy surfaces in Blender with tight wavelet frames.

Blender is imported on registration only, so that ``framelet.core`` can be
used and tested where there is none.
"""

import atexit

from .core.processors import set_default_threads
from .operators.machine import available_processors

set_default_threads(available_processors())  # the mathematics does not ask the system


def register() -> None:
    """Add the operators, settings and panels to Blender."""
    from . import operators, ui

    operators.register()
    ui.register()
    # A class that is registered as Python ends keeps Blender 4.5 from ending, and crashes 4.2.
    atexit.register(unregister)


def unregister() -> None:
    """Take away all that `register` added, in reverse order."""
    from . import operators, ui

    atexit.unregister(unregister)
    ui.unregister()
    operators.unregister()
