# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Print what the changelog says of a release, and refuse tags that do not fit the manifest and the changelog.

python3 .ci/release_notes.py v0.2.0
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def notes(tag: str, manifest: str, changelog: str) -> str:
    """Return the section of a version.

    Parameters
    ----------
    tag : str
        Such as v0.2.0.
    manifest, changelog : str
        The texts of both files.

    Raises
    ------
    ValueError
        In one sentence, if the manifest has another version, or the changelog no section with a date for it.
    """
    version = re.search(r'^version = "(.*)"', manifest, re.MULTILINE).group(1)
    if tag != f"v{version}":
        raise ValueError(f"The tag is {tag}, but the manifest has version {version}; they must be the same.")
    section = re.search(
        rf"^## \[{re.escape(version)}\] - (.*)\n((?:(?!^## ).*\n?)*)", changelog, re.MULTILINE
    )
    if section is None or not re.fullmatch(r"\d{4}-\d\d-\d\d", section.group(1)):
        raise ValueError(f"The changelog has no section of {version} with the day of its release; write it.")
    return section.group(2).strip() + "\n"


def main() -> int:
    """Print the notes and return the exit code."""
    texts = [(ROOT / name).read_text(encoding="utf-8") for name in ("blender_manifest.toml", "CHANGELOG.md")]
    try:
        print(notes(sys.argv[1], *texts), end="")
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
