# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Kernels of learned frame shrinkage: scales, features, the net, the fit of the vertices."""
