# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes as arrays and back: positions, topology, attributes, shape keys, masks."""
