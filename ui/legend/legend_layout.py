# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the parts of the legend go, in pixels. Knows neither bpy nor gpu, so that it needs no window."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

MARGIN = 20.0
"""Space around the legend, in pixels at a scale of 1, as all lengths here."""
PADDING = 10.0
BAR_WIDTH = 16.0
LARGEST_HEIGHT = 170.0
SMALLEST_HEIGHT = 60.0
"""A shorter bar has no room for its labels; then nothing is drawn."""
TICK_LENGTH = 4.0
GAP = 6.0
LINE_GAP = 11.0
"""Between the lines of text and the bar."""
N_STRIPES = 64
FONT_POINTS = 11.0


class Rectangle(NamedTuple):
    """A rectangle in pixels, from its lower left corner."""

    x: float
    y: float
    width: float
    height: float

    @property
    def right(self) -> float:
        """Its right border."""
        return self.x + self.width

    @property
    def top(self) -> float:
        """Its upper border."""
        return self.y + self.height


class Label(NamedTuple):
    """A line of text and the lower left corner of where it stands."""

    text: str
    x: float
    y: float


class LegendLayout(NamedTuple):
    """Everything that is drawn.

    `stripes` are from the lowest value up, and `values` are their places from 0, the lowest, to 1.
    """

    backdrop: Rectangle
    stripes: list[Rectangle]
    values: list[float]
    ticks: list[Rectangle]
    labels: list[Label]


Measure = Callable[[str], tuple[float, float]]
"""Width and height of a text in pixels."""


def free_area(region: Rectangle, others: Sequence[Rectangle]) -> Rectangle:
    """Return the part of a region that no region over it hides, relative to its lower left corner.

    Parameters
    ----------
    region : Rectangle
        The region that is drawn in.
    others : sequence of Rectangle
        Regions of the same area, in the same coordinates; those that touch the left or right border, as the
        toolbar and the sidebar, or the lower or upper one, as headers, take their part away.
    """
    left, bottom, right, top = region.x, region.y, region.right, region.top
    for other in others:
        is_over = other.x < right and other.right > left and other.y < top and other.top > bottom
        if not is_over or other.width <= 1 or other.height <= 1:
            continue
        if other.width >= 0.9 * region.width:
            if other.y <= region.y + 1:
                bottom = max(bottom, other.top)
            elif other.top >= region.top - 1:
                top = min(top, other.y)
        elif other.right >= region.right - 1:
            right = min(right, other.x)
        elif other.x <= region.x + 1:
            left = max(left, other.right)
    return Rectangle(left - region.x, bottom - region.y, max(right - left, 0.0), max(top - bottom, 0.0))


def tick_places(is_signed: bool) -> list[float]:
    """Return where labels stand along the bar: 0 is its lower end, 1 its upper one."""
    return [0.0, 0.25, 0.5, 0.75, 1.0] if is_signed else [0.0, 0.5, 1.0]


def tick_values(minimum: float, maximum: float, is_signed: bool) -> list[float]:
    """Return the numbers of the labels; the middle of a signed range is exactly 0."""
    # From both ends, so that the middle of a signed range is exactly 0 and its halves are mirror images.
    return [(1.0 - place) * minimum + place * maximum for place in tick_places(is_signed)]


def lay_out_legend(
    area: Rectangle, scale: float, title: str, texts: Sequence[str], note: str, measure: Measure
) -> LegendLayout | None:
    """Place a legend at the lower right of an area.

    Parameters
    ----------
    area : Rectangle
        Where there is room, in pixels.
    scale : float
        Pixels for each unit of the constants above; 2 on a screen with twice the resolution.
    title : str
        What is shown; the first line.
    texts : sequence of str
        The labels from the lowest value up, evenly spaced.
    note : str
        A line below the bar; empty for none.
    measure : callable
        Width and height of a text at this scale.

    Returns
    -------
    LegendLayout or None
        None where there is no room.
    """
    line = max(measure("0")[1], FONT_POINTS * scale * 0.7)
    step = line + LINE_GAP * scale
    text_width = max(measure(text)[0] for text in texts)
    bar_and_labels = (BAR_WIDTH + TICK_LENGTH + GAP) * scale + text_width
    width = max(bar_and_labels, measure(title)[0], measure(note)[0]) + 2 * PADDING * scale
    around = 2 * PADDING * scale + step + line + (step if note else 0.0)
    height = min(LARGEST_HEIGHT * scale, area.height - 2 * MARGIN * scale - around)
    if height < SMALLEST_HEIGHT * scale or width > area.width - 2 * MARGIN * scale:
        return None
    x = area.right - MARGIN * scale - width
    y = area.y + MARGIN * scale
    backdrop = Rectangle(x, y, width, height + around)
    left = x + PADDING * scale
    # The labels at the ends reach half a line beyond the bar.
    bottom = y + PADDING * scale + (step if note else 0.0) + 0.5 * line
    stripe = height / N_STRIPES
    stripes = [Rectangle(left, bottom + k * stripe, BAR_WIDTH * scale, stripe) for k in range(N_STRIPES)]
    values = [(k + 0.5) / N_STRIPES for k in range(N_STRIPES)]
    labels = [Label(title, left, backdrop.top - PADDING * scale - line)]
    ticks = []
    right = left + BAR_WIDTH * scale
    thickness = max(round(scale), 1)
    for number, text in enumerate(texts):
        place = bottom + height * number / (len(texts) - 1)
        ticks.append(Rectangle(right, place - 0.5 * thickness, TICK_LENGTH * scale, thickness))
        labels.append(Label(text, right + (TICK_LENGTH + GAP) * scale, place - 0.5 * line))
    if note:
        labels.append(Label(note, left, y + PADDING * scale))
    return LegendLayout(backdrop, stripes, values, ticks, labels)
