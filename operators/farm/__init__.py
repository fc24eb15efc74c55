# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches in many processes, here and on many machines: Dask, and a job type for Flamenco."""
