# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Published filters that Framelet is compared with, written here from their papers, and Taubin's by a library."""
