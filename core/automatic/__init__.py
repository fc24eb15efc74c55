# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising without a parameter: measure the noise, try recipes on parts of the mesh, run the best one."""
