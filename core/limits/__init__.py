# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run may not do, for every method: masks, feature lines, displacements, volume, folds."""
