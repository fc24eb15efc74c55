# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh as arrays: connectivity, one-rings, geometry, numbering, welding."""
