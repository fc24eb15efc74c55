# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What the documents refer to is there, and what they quote is what Framelet says."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\]\(([^)\s]+)\)|src=\"([^\"]+)\"")
PATH = re.compile(r"`((?:\.ci|core|docs|operators|tests|ui)/[^`* ]*)`")
HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)
ROW = re.compile(r"^\| ([^|]+) \|", re.MULTILINE)
VARIABLE = re.compile(
    r"‘[^’]*’|; |: |\.\.\.|\([^)]*\)|[\d.,]+ (?:GB|MB)|\d[\d,]*|\bfile\.blend\b|\bLINEAR_SPLINE\b"
    r"|\w+=\"\w+\"|\blambda_|\bmax_edges\b|(?<=engine )Automatic\b"
)
EMPTY_TABLE = re.compile(r"<!-- (\w+) -->\s*<!-- end of \1 -->")
NOT_QUOTED = {"Message", "---"}
LARGEST_PICTURE = 350_000
SCREENSHOTS = ("panel", "window_heat_map", "window_bands", "window_cancel")


def is_unmeasured(document):
    """Tell whether the tables of a benchmark wait for its first run, which also draws its picture."""
    return EMPTY_TABLE.search(document.read_text(encoding="utf-8")) is not None


def targets(document):
    """Return what a document links to, files of the project only."""
    found = [first or second for first, second in LINK.findall(document.read_text(encoding="utf-8"))]
    return [target for target in found if "://" not in target and not target.startswith("mailto:")]


def anchor(heading):
    """Return the anchor that a heading gets on the web."""
    kept = re.sub(r"[^\w\- ]", "", heading.lower())
    return kept.replace(" ", "-")


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(document):
    for target in targets(document):
        name, _, place = target.partition("#")
        path = (document.parent / name).resolve() if name else document
        assert path.exists() or (path.suffix == ".png" and is_unmeasured(document)), target
        if place and path.suffix == ".md":
            headings = HEADING.findall(path.read_text(encoding="utf-8"))
            assert place in {anchor(heading) for heading in headings}, target


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_files_that_are_named_are_there(document):
    for name in PATH.findall(document.read_text(encoding="utf-8")):
        is_made = name.endswith(".csv") and is_unmeasured(document)
        assert (ROOT / name).exists() or is_made, name


def test_pages_can_be_found_from_the_index():
    index = ROOT / "docs" / "README.md"
    reached, waiting = set(), [ROOT / "README.md", index]
    while waiting:
        page = waiting.pop()
        if page in reached:
            continue
        reached.add(page)
        linked = [(page.parent / target.partition("#")[0]).resolve() for target in targets(page)]
        waiting += [path for path in linked if path.suffix == ".md"]
    assert [str(page) for page in DOCUMENTS if page not in reached] == []


def test_pictures_are_used_and_small():
    used = {
        (document.parent / target).resolve()
        for document in DOCUMENTS
        for target in targets(document)
        if target.endswith(".png")
    }
    pictures = set((ROOT / "docs" / "images").glob("*.png"))
    assert sorted(path.name for path in pictures - used) == []
    assert [path.name for path in pictures if path.stat().st_size > LARGEST_PICTURE] == []


def test_screenshots_are_there_at_both_scales():
    images = ROOT / "docs" / "images"
    wanted = [f"{name}{ending}.png" for name in SCREENSHOTS for ending in ("", "_2x")]
    assert [name for name in wanted if not (images / name).is_file()] == []


def spoken_texts():
    """Return all texts in the code, with a gap where values are filled in."""
    texts = []
    for folder in ("core", "operators", "ui"):
        for path in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Constant) and isinstance(node.value, str):
                    texts.append(node.value)
    return "\n".join(texts)


def test_troubleshooting_quotes_what_framelet_says():
    spoken = spoken_texts()
    page = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
    messages = [row for row in ROW.findall(page) if row.strip("- ") and row not in NOT_QUOTED]
    assert len(messages) > 20
    assert [message for message in messages if not is_spoken(message, spoken)] == []


def is_spoken(message, spoken):
    """Tell whether a sentence is made of texts of the code, which values and halves of sentences divide."""
    pieces = [piece.strip(" :;.") for piece in VARIABLE.split(message)]
    words = [piece.split() for piece in pieces if len(piece) > 12]
    triples = [" ".join(each[i : i + 3]) for each in words for i in range(max(len(each) - 2, 1))]
    return not triples or sum(triple in spoken for triple in triples) > 0.6 * len(triples)


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        ("Select at least one mesh object", True),
        ("Choose at most one curve object of this scene", False),
    ],
)
def test_what_is_not_said_is_found_out(message, expected):
    assert is_spoken(message, spoken_texts()) is expected
