# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A report as one page for any browser, with pictures in it, those that need a look first."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from html import escape
from typing import Any

from .progress import duration
from .rows import DONE
from .summary import Look, by_need, defects_of, noise_of

_STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 72rem; padding: 0 1rem;
  color: #222; background: #fff }
article { display: flex; flex-wrap: wrap; gap: 1rem; border-top: 1px solid #ddd; padding: 1rem 0 }
.pictures { display: flex; gap: 1rem; max-width: 100% }
figure { margin: 0; text-align: center; color: #666; font-size: 13px }
figure img { display: block; width: 240px; max-width: 100%; border: 1px solid #eee; box-sizing: border-box }
h2 { font-size: 1rem; margin: 0 0 .3rem; overflow-wrap: anywhere }
.text { flex: 1; min-width: min(18rem, 100%) }
.why { color: #8a5300; margin: .2rem 0; overflow-wrap: anywhere }
.failed h2, .failed .why { color: #b00020 }
table { border-collapse: collapse; font-size: 14px }
td { padding: .05rem 1rem .05rem 0; vertical-align: top; overflow-wrap: anywhere }
td:first-child { color: #666; white-space: nowrap } td:last-child { padding-right: 0 }
"""

Pictures = Callable[[dict[str, Any]], tuple[bytes, bytes] | None]


def page(rows: Sequence[dict[str, Any]], pictures: Pictures, n_pictures: int) -> str:
    """Return a page of HTML that needs no other file and runs no script.

    Parameters
    ----------
    rows : sequence of dict
        The rows of a report, one a result.
    pictures : callable
        Returns PNG files of a row before and after, or None.
    n_pictures : int
        How many results have pictures at most: those that need a look most.

    Examples
    --------
    >>> row = {"status": "failed", "input": "/a", "output": "<b>.ply", "error": "It is <empty>."}
    >>> text = page([row], lambda row: None, 0)
    >>> "<b>" in text, "&lt;b&gt;.ply" in text, "&lt;empty&gt;" in text
    (False, True, True)
    """
    n_done = sum(row["status"] == DONE for row in rows)
    articles, n_drawn = [], 0
    for row, look in by_need(rows):
        drawn = pictures(row) if row["status"] == DONE and n_drawn < n_pictures else None
        n_drawn += drawn is not None
        articles.append(_article(row, look, drawn))
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        # Nothing that a name may contain can load or run anything.
        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; img-src data:; '
        "style-src 'unsafe-inline'\">"
        f"<title>Framelet: {len(rows)} files</title><style>{_STYLE}</style></head><body>\n"
        f"<h1>{len(rows):,} files: {n_done:,} done, {len(rows) - n_done:,} failed</h1>\n"
        "<p>Those that need a look come first.</p>\n" + "\n".join(articles) + "\n</body></html>\n"
    )


def _article(row: dict[str, Any], look: Look, drawn: tuple[bytes, bytes] | None) -> str:
    figures = ""
    for data, caption in zip(drawn or (), ("before", "after"), strict=False):
        source = base64.b64encode(data).decode("ascii")
        figures += (
            f'<figure><img alt="{caption}" src="data:image/png;base64,{source}">'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    if figures:
        figures = f'<div class="pictures">{figures}</div>'
    why = "".join(f'<p class="why">{_text(reason)}</p>' for reason in look.reasons)
    cells = "".join(f"<tr><td>{name}</td><td>{_text(value)}</td></tr>" for name, value in _facts(row))
    kind = "done" if row["status"] == DONE else "failed"
    return (
        f'<article class="{kind}">{figures}<div class="text"><h2>{_text(row["output"])}</h2>{why}'
        f"<table>{cells}</table></div></article>"
    )


def _facts(row: dict[str, Any]) -> list[tuple[str, str]]:
    """Return names and values of what is told about a row."""
    facts = [("Input", str(row.get("input", "")))]
    if row["status"] != DONE:
        return facts
    noise = noise_of(row)
    volume = row.get("volume_change")
    return [
        *facts,
        ("Size", f"{row['n_vertices']:,} vertices, {row['n_faces']:,} faces"),
        ("Defects", defects_of(row) or "none"),
        ("Noise", "not measured" if noise is None else f"{noise:.3g} edges"),
        ("Moved", f"{row['displacement_rms']:.4g} rms, {row['displacement_max']:.4g} at most "
                  f"({row['displacement_max_edges']:.3g} edges)"),
        ("Folded faces", f"{row['folded_faces_before']:,} before, {row['folded_faces']:,} after"),
        ("Volume", "open" if volume is None else f"{volume:+.3%}"),
        ("Preset", row.get("preset", "").lower().replace("_", "-")),
        ("Time", duration(sum(row.get("seconds", {}).values()))),
    ]  # fmt: skip


def _text(value: Any) -> str:
    """Return a value as text of a page, whatever is in it."""
    return escape(str(value).encode("utf-8", "replace").decode("utf-8"))
