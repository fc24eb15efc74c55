# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What the documents refer to is there, and they stay small."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\]\(([^)\s]+)\)|src=\"([^\"]+)\"")
PATH = re.compile(r"`((?:\.ci|core|docs|operators|tests|ui)/[^`* ]*)`")
HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)
PICTURES = (".png", ".webp")
LARGEST_PICTURES = 1_500_000
"""Bytes of all pictures together."""

MOST_WORDS = 30_000


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
        assert path.exists(), target
        if place and path.suffix == ".md":
            headings = HEADING.findall(path.read_text(encoding="utf-8"))
            assert place in {anchor(heading) for heading in headings}, target


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_files_that_are_named_are_there(document):
    for name in PATH.findall(document.read_text(encoding="utf-8")):
        assert (ROOT / name).exists(), name


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
        if target.endswith(PICTURES)
    }
    pictures = set((ROOT / "docs" / "images").iterdir())
    assert sorted(path.name for path in pictures - used) == []
    assert sum(path.stat().st_size for path in pictures) < LARGEST_PICTURES


def test_documents_are_short():
    n_words = {path.relative_to(ROOT): len(path.read_text(encoding="utf-8").split()) for path in DOCUMENTS}
    assert sum(n_words.values()) < MOST_WORDS, n_words
