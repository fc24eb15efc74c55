# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be set: methods, frames, presets, their ranges and words."""

from .denoise_settings import DEFAULT_PRESET, PRESETS, DenoiseSettings

__all__ = ["DEFAULT_PRESET", "PRESETS", "DenoiseSettings"]
