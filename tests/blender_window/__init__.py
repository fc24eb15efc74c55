# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Drives a real Blender window on a virtual screen, for `tests/gui` and for screenshots."""
