# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be set: methods, frames, presets, their ranges and words."""

from .choices import METHODS
from .denoise_settings import DEFAULT_PRESET, INFOS, PRESETS, DenoiseSettings, check_setting, used_settings
from .effects import check_effect, check_used, replaced_by
from .setting_info import SettingInfo

__all__ = [
    "DEFAULT_PRESET",
    "INFOS",
    "METHODS",
    "PRESETS",
    "DenoiseSettings",
    "SettingInfo",
    "check_effect",
    "check_setting",
    "check_used",
    "replaced_by",
    "used_settings",
]
