# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where and how far vertices may move, and what is mended in a result: volume and folds."""
