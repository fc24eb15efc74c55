# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising on the field of face normals, where creases are jumps and survive."""
