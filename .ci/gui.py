# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Provide a Blender application and a virtual screen for the tests of the window.

    python3 .ci/gui.py

Does nothing where both are installed. Else, on Linux and as root, it makes a small Debian system with both in
`.venv/gui` (2 GB, a few minutes); nothing is installed on the computer but debootstrap, if it is missing.
Elsewhere it says what to install; the tests are then skipped.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / ".venv" / "gui"
SUITE = "sid"
"""The suite of Debian that has a Blender we support."""

PACKAGES = (
    "blender",
    "xvfb",
    "libgl1-mesa-dri",
    "python3-numpy",
    # Blender's own extensions system needs these two.
    "python3-cattr",
    "python3-requests",
)
ENTER = """
for name in proc sys dev; do mount --rbind "/$name" "$0/$name"; done
export DEBIAN_FRONTEND=noninteractive
exec chroot "$0" "$@"
"""


def main() -> int:
    """Make the folder if it is needed and possible; return the exit code."""
    blender = os.environ.get("BLENDER") or shutil.which("blender")
    if blender and shutil.which(blender) and shutil.which("Xvfb"):
        print(f"gui: using {shutil.which(blender)} and {shutil.which('Xvfb')}")
        return 0
    folder = Path(os.environ.get("FRAMELET_GUI") or FOLDER).resolve()
    stamp = folder / "framelet-stamp"
    if stamp.is_file() and stamp.read_text() == " ".join((SUITE, *PACKAGES)):
        print(f"gui: using {folder}")
        return 0
    if not sys.platform.startswith("linux") or os.geteuid() != 0:
        print(
            "gui: no Blender and Xvfb on PATH, and a folder with both can be made on Linux and by root only. "
            "Install both (the variable BLENDER may name the executable); until then the tests are skipped."
        )
        return 0
    return make_folder(folder, stamp)


def make_folder(folder: Path, stamp: Path) -> int:
    """Make a small Debian with Blender in a folder."""
    print(f"gui: making {folder}, which takes a few minutes", flush=True)
    log = folder.with_suffix(".log")
    folder.parent.mkdir(parents=True, exist_ok=True)
    commands = []
    if shutil.which("debootstrap") is None:
        commands += [["apt-get", "update", "-q"], ["apt-get", "install", "-y", "-q", "debootstrap"]]
    if not (folder / "usr/bin/apt-get").exists():
        commands.append(["debootstrap", "--variant=minbase", SUITE, str(folder)])
    # The mounts are those of a namespace of its own, so that none stays behind.
    enter = ["unshare", "--mount", "--propagation", "private", "sh", "-ec", ENTER, str(folder)]
    commands.append([*enter, "apt-get", "install", "-y", "-q", "--no-install-recommends", *PACKAGES])
    commands.append([*enter, "blender", "--version"])
    with open(log, "w") as output:
        for command in commands:
            output.flush()
            if subprocess.call(command, stdin=subprocess.DEVNULL, stdout=output, stderr=output) != 0:
                print(f"gui: {command[0]} failed; its messages are in {log}")
                return 1
    stamp.write_text(" ".join((SUITE, *PACKAGES)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
