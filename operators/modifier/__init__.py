# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results that stay adjustable: vectors stored as attributes, which a Geometry Nodes modifier adds.

`node_groups` makes the groups, `inputs` reads and sets their inputs on a modifier, `stack` puts modifiers on
objects, `attributes` stores vectors. On top of these `displacement` keeps what denoising moved, and
`live_equalizer` the scales of a mesh.
"""
