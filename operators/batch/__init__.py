# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many mesh files: what is to be done, what was done, and the processes that do it.

Nothing here knows how a mesh is denoised or imports Blender; `command_line.batch` puts the pieces together.
"""
