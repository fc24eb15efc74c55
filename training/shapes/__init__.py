# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean procedural meshes, made in code, for training.

Needs numpy, scipy, scikit-image, manifold3d, pymeshlab, and Blender 4.5 as a module (bpy), thus Python 3.11.
"""

# Blender's module must be loaded before pymeshlab: both bring a library of one name, and only
# Blender's has all that Blender looks for.
from . import blender as blender
