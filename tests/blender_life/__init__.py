# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Days in the life of a Blender file: random sequences of what people do, checked after each step.

`world` looks at the file and says what must always hold, `steps` has what can be done.
"""
