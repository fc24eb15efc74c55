# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Print the oldest Blender, which the manifest states, and the newest one that is pinned, as JSON."""

import json
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def oldest_and_newest(root: Path = ROOT) -> list[str]:
    """Return both as "4.2" and the like; one if they are the same.

    Raises
    ------
    ValueError
        If the packages of the oldest one are not pinned.
    """
    manifest = (root / "blender_manifest.toml").read_text(encoding="utf-8")
    oldest = re.search(r'^blender_version_min = "(\d+\.\d+)', manifest, re.MULTILINE).group(1)
    files = (root / ".ci" / "requirements").glob("bpy-*.txt")
    pinned = sorted((path.stem[4:] for path in files), key=lambda name: tuple(map(int, name.split("."))))
    if oldest not in pinned:
        raise ValueError(f"Blender {oldest} has no packages in .ci/requirements; there are {pinned}.")
    return list(dict.fromkeys((oldest, pinned[-1])))


if __name__ == "__main__":
    print(json.dumps(oldest_and_newest()))
