# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and settings that nobody would think of, made at random; a failure here becomes a test elsewhere."""
