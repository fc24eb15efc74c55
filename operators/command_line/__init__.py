# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `framelet denoise IN OUT` and `blender -c framelet denoise IN OUT`.

Each subcommand is one module with `add_command(subparsers)`; see `parser.COMMANDS`. Nothing here imports
Blender before a subcommand needs it, so that help and errors in the options come at once.
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
        Exit code: 0 if all went well, 2 for arguments that are not understood, 1 for everything else.
    """
    from .messages import FAILURE, INTERRUPTED, CommandError, complain
    from .parser import make_parser

    # A terminal that lacks a letter of the paper must not end a long run.
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        arguments = make_parser(program).parse_args(sys.argv[1:] if argv is None else list(argv))
        arguments.run(arguments)
    except CommandError as error:
        complain(str(error))
        return error.exit_code
    except KeyboardInterrupt:
        complain("Interrupted; nothing was written.")
        return INTERRUPTED
    except MemoryError:
        complain("There is not enough memory for this mesh; nothing was written.")
        return FAILURE
    except SystemExit as end:  # argparse, after --help and --version
        return int(end.code or 0)
    return 0
