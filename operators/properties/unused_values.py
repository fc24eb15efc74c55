# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments of a script that a run does not use, in sentences, so that no value is ignored in silence."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from ...core.settings import METHODS, PRESETS, replaced_by
from .region_values import REGION_NAMES, as_typed, shown_region_names
from .setting_values import CUSTOM, SETTING_NAMES, has_effect

if TYPE_CHECKING:
    from ...core.settings import DenoiseSettings

REGION_NEEDS = {
    "invert_group": "vertex_group",
    "max_edges": 'limit="EDGES"',
    "max_length": 'limit="LENGTH"',
    "weld_distance": "weld=True",
    "straighten_borders": 'boundary="ALONG"',
}
"""Options of a region, and the argument without which they have no effect."""


def unused_sentences(operator: Any, settings: DenoiseSettings) -> list[str]:
    """Return a sentence for each reason why arguments have no effect; none if all have.

    Parameters
    ----------
    operator : SettingsMixin and RegionMixin
        The operator as it was called, before its other properties are filled.
    settings : DenoiseSettings
        What it is about to run with.
    """
    rna = operator.properties
    # A preset fills all properties, and Blender's own record of a call names all, without anybody's wish.
    # A custom combination does not say which preset it came from.
    presets = PRESETS.values() if rna.preset == CUSTOM else [PRESETS[rna.preset]]
    changed = [
        name
        for name in SETTING_NAMES
        if rna.is_property_set(name)
        and as_typed(getattr(rna, name)) not in [getattr(preset.settings, name) for preset in presets]
    ]
    sentences = []
    unused = [name for name in changed if not has_effect(settings.method, name)]
    if unused:
        label = next(each.label for each in METHODS if each.identifier == settings.method)
        sentences.append(
            rpt_("The engine {engine} does not use {names}; give {argument} for one that does.").format(
                engine=iface_(label), names=", ".join(unused), argument=_remedy(operator, unused)
            )
        )
    for name in changed:
        entry = replaced_by(settings, name)
        if entry is not None:
            argument = f'{entry.beside}="{getattr(settings, entry.beside)}"'
            sentences.append(
                rpt_("{name} has no effect with {argument}.").format(name=name, argument=argument)
            )
    shown = shown_region_names(operator)
    for name in REGION_NAMES:
        default = rna.bl_rna.properties[name].default
        if name not in shown and rna.is_property_set(name) and getattr(rna, name) != default:
            sentences.append(
                rpt_("{name} has no effect without {argument}.").format(
                    name=name, argument=REGION_NEEDS[name]
                )
            )
    return sentences


def _remedy(operator: Any, names: list[str]) -> str:
    """Return the argument that leads to an engine which uses most of some settings."""

    def count(method: str) -> int:
        return sum(has_effect(method, name) for name in names)

    if operator.preset == CUSTOM:
        return f'method="{max((each.identifier for each in METHODS), key=count)}"'
    # Positions is the plainest of the presets that use λ and μ.
    first = ("AUTO", "POSITIONS")
    keys = (*first, *(key for key in PRESETS if key not in first))
    return f'preset="{max(keys, key=lambda key: count(PRESETS[key].settings.method))}"'
