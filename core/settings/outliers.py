# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a spike is by default."""

SPIKE_LENGTH = 2.5
"""Edges of a spike, in lengths of those around."""

SPIKE_VERTICES = 8
"""Vertices of a spike at most."""
