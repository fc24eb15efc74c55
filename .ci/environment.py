# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Make the environments of development, and run commands in them.

    python3 .ci/environment.py path core
    python3 .ci/environment.py run bpy-4.5 --timeout 600 -- -m pytest tests/blender

Each environment is a virtual environment ``.venv/<name>`` with the pinned packages
of ``.ci/requirements/<name>.txt``; it is made on first use and remade when the pins
change. A missing Python is looked for in the usual places, then fetched with uv.

This file starts everything else: it needs the standard library only and keeps to
syntax that Python 3.8 understands.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VENVS = ROOT / ".venv"
UV_PYTHONS = VENVS / "uv-pythons"

# A bpy wheel works with one version of Python only.
PYTHONS = {
    "core": ("3.11", "3.12", "3.13", "3.14"),
    "hunt": ("3.11", "3.12", "3.13", "3.14"),
    "hunt-bpy": ("3.11",),
    "benchmarks": ("3.11", "3.12", "3.13", "3.14"),
    "bpy-4.2": ("3.11",),
    "bpy-4.5": ("3.11",),
    "bpy-5.2": ("3.13",),
    "numpy-1.26": ("3.11", "3.12"),
    "speed": ("3.11", "3.12", "3.13"),
    "training": ("3.11",),
}

# Folders that hold Pythons but are often missing from PATH; {v} is a version like 3.11.
USUAL_PLACES = (
    "~/.local/bin/python{v}",
    "~/.local/share/uv/python/cpython-{v}.*/bin/python{v}",
    "/usr/bin/python{v}",
    "/usr/local/bin/python{v}",
    "/opt/homebrew/bin/python{v}",
    "/opt/local/bin/python{v}",
    "/Library/Frameworks/Python.framework/Versions/{v}/bin/python{v}",
    "~/AppData/Local/Programs/Python/Python{v_digits}/python.exe",
)

TIMED_OUT = 124  # as in coreutils `timeout`


class EnvironmentProblem(Exception):
    """What is wrong, in one sentence for people."""


def main() -> int:
    """Parse the command line, do it, and return the exit code."""
    parser = argparse.ArgumentParser(description="Make the environments of development.")
    commands = parser.add_subparsers(dest="command", required=True)
    path_parser = commands.add_parser("path", help="print the path of the environment's Python")
    run_parser = commands.add_parser("run", help="run the environment's Python with arguments")
    for subparser in (path_parser, run_parser):
        subparser.add_argument("name", choices=PYTHONS)
    run_parser.add_argument("--timeout", type=float, help="seconds after which the run is killed")
    run_parser.add_argument("arguments", nargs="+", help="arguments of Python, after --")
    options = parser.parse_args()
    try:
        python = make_environment(options.name)
    except EnvironmentProblem as problem:
        log(str(problem))
        return 1
    if options.command == "run":
        return run(options.name, [str(python), *options.arguments], options.timeout)
    print(python)
    return 0


def make_environment(name: str) -> Path:
    """Return the Python of an environment, which is made first if it has to be."""
    folder = VENVS / name
    python = interpreter(folder)
    requirements = ROOT / ".ci" / "requirements" / f"{name}.txt"
    stamp = folder / "framelet-stamp"
    packages = b"".join(path.read_bytes() for path in with_included(requirements))
    wanted = hashlib.sha256(packages + " ".join(PYTHONS[name]).encode()).hexdigest()
    if python.exists() and stamp.is_file() and stamp.read_text() == wanted:
        return python

    base = find_python(PYTHONS[name])
    log(f"making {name} with {base}")
    shutil.rmtree(folder, ignore_errors=True)
    if not succeeds([base, "-m", "venv", str(folder)]):
        raise EnvironmentProblem(f"{base} cannot make the virtual environment {folder}.")
    install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", str(requirements)]
    if not succeeds([str(python), *install]):
        raise EnvironmentProblem(
            f"Installing the packages of {requirements} failed: see pip's message above."
        )
    # Last, so that a half-made environment carries no stamp.
    stamp.write_text(wanted)
    return python


def with_included(requirements: Path) -> list[Path]:
    """Return a file of requirements, and those that it takes in by ``-r``."""
    lines = [line.split() for line in requirements.read_text(encoding="utf-8").splitlines()]
    included = [requirements.parent / words[1] for words in lines if words[:1] == ["-r"]]
    return [requirements, *(path for each in included for path in with_included(each))]


def find_python(versions: tuple[str, ...]) -> str:
    """Return a working Python of one of the versions, best version first."""
    tried = set()
    for version in versions:
        for candidate in candidates(version):
            if candidate not in tried:
                tried.add(candidate)
                if python_version(candidate) in versions:
                    return candidate
    for candidate in fetch_with_uv(versions[0]):
        if python_version(candidate) in versions:
            return candidate
    raise EnvironmentProblem(
        f"No Python {' or '.join(versions)} was found, and uv could not fetch one: install it and try again."
    )


def candidates(version: str):
    """Yield paths that may be a Python of this version, the likeliest first."""
    yield sys.executable
    # All of PATH, not the first hit: the first one may be a pyenv shim that refuses to run.
    for folder in os.get_exec_path():
        # An environment must not be built on itself or on a sibling.
        if folder and VENVS not in Path(folder).parents:
            for name in (f"python{version}", "python3", "python"):
                found = shutil.which(name, path=folder)
                if found:
                    yield found
    pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv") / "versions"
    yield from matches(pyenv, f"{version}*/bin/python")
    yield from fetched_pythons(version)
    for place in USUAL_PLACES:
        path = Path(place.format(v=version, v_digits=version.replace(".", ""))).expanduser()
        yield from matches(Path(path.anchor), str(path.relative_to(path.anchor)))


def matches(folder: Path, pattern: str) -> list[str]:
    """Return the existing paths below a folder that match, newest version first."""
    return [str(path) for path in sorted(folder.glob(pattern), reverse=True)] if folder.is_dir() else []


def python_version(python: str) -> str | None:
    """Return "3.11" and the like for a Python that runs and can make environments."""
    code = "import sys, venv, ensurepip; print('%d.%d' % sys.version_info[:2])"
    try:
        result = subprocess.run(
            [python, "-c", code], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return result.stdout.strip() if result.returncode == 0 else None


def fetch_with_uv(version: str) -> list[str]:
    """Fetch a Python below ``.venv`` with uv, itself installed there if it is missing."""
    log(f"no Python {version} on this computer, trying uv")
    uv = shutil.which("uv")
    if uv is None:
        folder = VENVS / "uv"
        python = interpreter(folder)
        uv = str(python.with_name("uv" + python.suffix))
        if not Path(uv).exists() and not (
            succeeds([sys.executable, "-m", "venv", str(folder)])
            and succeeds([str(python), "-m", "pip", "install", "--quiet", "uv"])
        ):
            return []
    # Kept below .venv, so that `make clean` takes it away and nothing else sees it.
    places = {"UV_PYTHON_INSTALL_DIR": str(UV_PYTHONS), "UV_PYTHON_INSTALL_BIN": "0"}
    succeeds([uv, "python", "install", version], {**os.environ, **places})
    return fetched_pythons(version)


def fetched_pythons(version: str) -> list[str]:
    """Return the Pythons of this version that uv has fetched for us."""
    name = "python.exe" if os.name == "nt" else f"bin/python{version}"
    return matches(UV_PYTHONS, f"cpython-{version}.*/{name}")


def interpreter(folder: Path) -> Path:
    """Return the path of a virtual environment's Python."""
    return folder / "Scripts" / "python.exe" if os.name == "nt" else folder / "bin" / "python"


def succeeds(command: list[str], environment: dict[str, str] | None = None) -> bool:
    """Run a command with its output on stderr, where it does not mix with our answer."""
    try:
        return subprocess.call(command, stdin=subprocess.DEVNULL, stdout=sys.stderr, env=environment) == 0
    except OSError:
        return False


def run(name: str, command: list[str], timeout: float | None) -> int:
    """Run a command from the repository root and return its exit code.

    Blender's preferences and caches of the user are out of reach of the command.
    After `timeout` seconds it is killed with all its children.
    """
    with tempfile.TemporaryDirectory(prefix="framelet-") as user_folder:
        environment = {**os.environ, "PYTHONNOUSERSITE": "1"}
        if "bpy" in name:
            # In these environments a failed import of bpy is an error, never a skipped test.
            environment.update(FRAMELET_REQUIRE_BLENDER="1", BLENDER_USER_RESOURCES=user_folder)
        process = subprocess.Popen(
            command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, start_new_session=True
        )
        try:
            code = process.wait(timeout)
        except subprocess.TimeoutExpired:
            kill(process)
            log(f"killed after {timeout:g} seconds: {' '.join(command)}")
            return TIMED_OUT
        except BaseException:
            kill(process)
            raise
    # A negative code is the signal that ended the process; shells report it as 128 + signal.
    return code if code >= 0 else 128 - code


def kill(process: subprocess.Popen) -> None:
    """Kill a process and the children it started."""
    if os.name == "nt":
        process.kill()
    else:
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def log(message: str) -> None:
    """Write a line to stderr."""
    print(f"environment: {message}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
