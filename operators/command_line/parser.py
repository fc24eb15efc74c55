# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parser of the command line: the program, its subcommands, errors in one sentence."""

from __future__ import annotations

import argparse
from typing import NoReturn

from . import bands, batch, denoise, equalize, report
from .messages import USAGE_ERROR, CommandError
from .version import framelet_version

COMMANDS = (denoise, batch, report, equalize, bands)
"""Modules with a function `add_command(subparsers)`, in the order of the help text."""


class Parser(argparse.ArgumentParser):
    """A parser that raises CommandError instead of printing its usage and leaving."""

    def error(self, message: str) -> NoReturn:
        """Raise, with a hint at the help text."""
        raise CommandError(f"{message.rstrip('.')} (see '{self.prog} --help').", USAGE_ERROR)


def make_parser(program: str) -> Parser:
    """Make the parser of the whole command line.

    Parameters
    ----------
    program : str
        How the program was called: ``framelet`` or ``blender -c framelet``.

    Returns
    -------
    Parser
        The namespace it returns has a function `run`, which takes the namespace.
    """
    parser = Parser(
        prog=program,
        description="Clean noisy surfaces with tight wavelet frames.",
        epilog=f"'{program} COMMAND --help' describes a command.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"Framelet {framelet_version()}")
    subparsers = parser.add_subparsers(
        title="commands", metavar="COMMAND", dest="command", required=True, parser_class=Parser
    )
    for command in COMMANDS:
        command.add_command(subparsers)
    return parser
