# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Published filters to compare with: two of normals, written here from their papers, and Taubin's."""
