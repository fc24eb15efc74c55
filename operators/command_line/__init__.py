# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `framelet denoise IN OUT` and `blender -c framelet denoise IN OUT`.

Each subcommand is one module with `add_command(subparsers)`; see `parser.COMMANDS`. Mesh files are read and
written by `operators.files`, which needs NumPy only; what Blender alone can read is worked on in a Blender of
its own, see `blender_process`. Nothing here imports Blender.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence


def main(argv: Sequence[str] | None = None, program: str = "framelet") -> int:
    """Run the command line.

    Parameters
    ----------
    argv : sequence of str, optional
        The arguments after the program's name; those of the process if not given.
    program : str
        The name of the program in help texts.

    Returns
    -------
    int
        Exit code: 0 if all went well, 2 for arguments that are not understood, 128 and the number of the
        signal that ended the run, 1 for everything else.
    """
    from ..files.signals import signals_as_interrupts
    from .messages import FAILURE, complain, unprinted
    from .parser import make_parser

    # A terminal that lacks a letter of the paper must not end a long run.
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        with signals_as_interrupts():
            arguments = make_parser(program).parse_args(sys.argv[1:] if argv is None else list(argv))
            arguments.run(arguments)
    except SystemExit as end:  # argparse, after --help and --version
        return int(end.code or 0)
    except BaseException as error:
        sentence, code = explained(error)
        complain(sentence)
        return code
    reason = unprinted()
    if reason is not None:
        complain(f"All was done, but what there is to say could not be printed: {reason}.")
        return FAILURE
    return 0


def explained(error: BaseException) -> tuple[str, int]:
    """Return why a run ended, in one sentence, and its exit code; raise what no user can be blamed for."""
    from ..files.mesh_file import FileError
    from ..files.signals import Interrupted
    from .messages import FAILURE, INTERRUPTED, CommandError

    if isinstance(error, CommandError):
        return str(error), error.exit_code
    if isinstance(error, FileError):
        return str(error), FAILURE
    if isinstance(error, Interrupted):
        return f"Interrupted; {', '.join(map(str, error.published))} had been written.", error.exit_code
    if isinstance(error, KeyboardInterrupt):
        return "Interrupted; nothing was written.", getattr(error, "exit_code", INTERRUPTED)
    if isinstance(error, MemoryError):
        return "There is not enough memory for this mesh; nothing was written.", FAILURE
    if isinstance(error, OSError):
        name = f"{error.filename}: " if error.filename else ""
        return f"{name}{error.strerror or error}; nothing was written.", FAILURE
    raise error
