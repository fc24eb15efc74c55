# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Where Blender and the virtual screen are: on this computer, or in a folder made by `make gui`."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / ".venv" / "gui"
"""Where `make gui` puts a small system with Blender, if there is none on the computer."""

ENTER = """
for name in proc sys dev; do mount --rbind "/$name" "$0/$name"; done
exec chroot "$0" "$@"
"""
"""Run in a mount namespace of its own, so that no mount stays behind."""


class NoWindow(Exception):
    """Why there is no real window on this computer, in one sentence."""


class Programs:
    """Starts programs, and translates paths of job folders between here and there.

    Parameters
    ----------
    blender : str
        Blender's executable, as the system below `folder` calls it.
    folder : Path or None
        The folder with a system of its own; None for the programs of this computer.
    """

    def __init__(self, blender: str, folder: Path | None = None) -> None:
        self.blender = blender
        self.folder = folder

    def make_job_folder(self) -> Path:
        """Make an empty folder that programs can see."""
        parent = None if self.folder is None else self.folder / "srv"
        return Path(tempfile.mkdtemp(prefix="framelet-", dir=parent))

    def path_inside(self, path: Path) -> str:
        """Return how programs call a path in a job folder."""
        return str(path) if self.folder is None else f"/{path.relative_to(self.folder)}"

    def start(
        self,
        command: Sequence[str],
        environment: Mapping[str, str],
        log: Path,
        pass_fds: Sequence[int] = (),
    ) -> subprocess.Popen:
        """Start a program whose output goes to a file; `environment` is added to a small one."""
        kept = {name: os.environ[name] for name in ("PATH", "LANG") if name in os.environ}
        if self.folder is not None:
            enter = ["unshare", "--mount", "--propagation", "private", "sh", "-ec", ENTER]
            command = [*enter, str(self.folder), *command]
        with open(log, "ab") as output:
            return subprocess.Popen(
                command,
                env={**kept, **environment},
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                pass_fds=pass_fds,
            )


def find_programs() -> Programs:
    """Return the programs of this computer, or else those of the folder.

    Raises
    ------
    NoWindow
        If neither is there or the folder cannot be used.
    """
    blender = os.environ.get("BLENDER") or shutil.which("blender")
    if blender and shutil.which(blender) and shutil.which("Xvfb"):
        return Programs(shutil.which(blender))
    folder = Path(os.environ.get("FRAMELET_GUI") or FOLDER).resolve()
    if not (folder / "usr/bin/blender").is_file():
        raise NoWindow(
            "needs Blender and Xvfb on PATH (or the variable BLENDER), or the folder that `make gui` makes"
        )
    if not sys.platform.startswith("linux") or os.geteuid() != 0 or not shutil.which("unshare"):
        raise NoWindow(f"needs Linux, root and the program unshare to use the folder {folder}")
    return Programs("/usr/bin/blender", folder)
