"""The command ``cellc``: one thin file per subcommand, imported only when it runs."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial
from importlib import import_module
from keyword import iskeyword

import click

from cellc.contract.printing import Stream, progress, run_to_end, show
from cellc.version import __version__

# Command → module; the function in it has the command's name. In the order in which a cell comes to need them.
_COMMANDS = {
    "init": "Write a new cell from device names.",
    "import": "Make a device folder of a robot as its vendor ships it.",
    "catalog": "List the devices of the catalog, find some, or show one.",
    "check": "Find what is wrong before anything moves.",
    "explain": "Explain a diagnostic code.",
    "show": "Show a resolved value and its source.",
    "format": "Put files of cells and devices into their canonical form.",
    "build": "Check cells and write their artifacts.",
    "watch": "Check cells, and build them, whenever a file is saved.",
    "mock": "Execute the rehearsals of a generated folder.",
    "campaign": "Run every fault at every step of them.",
    "sweep": "Draw what is uncertain, and tell how often they succeed.",
    "replay": "Make one run of a campaign or a sweep again.",
    "gates": "Judge the gates that the mock can judge.",
    "view": "Write one HTML page of a cell: 3D, rehearsals, findings.",
    "audit": "Print versions, expectations, command paths and open questions.",
    "diff": "Tell what changed in a cell, and what that means.",
    "compare": "Put cells beside each other: what motion rests on, who has which duty.",
    "upgrade": "Tell what another distribution of ROS 2 would change.",
    "diagnose": "Tell what a symptom may mean, and what to look at.",
    "lsp": "Answer an editor: the language server of cells and devices.",
    "schema": "Print or write the JSON schemas.",
    "completion": "Print the completion script of a shell.",
}

_WAITING = ("lsp", "watch")
"""Commands that wait for somebody for most of their time; what they do then has progress of its own."""


class _LazyGroup(click.Group):
    """A group that imports a subcommand's module when it is asked for, so that `check` never pays for `mock`."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return None
        name = f"{cmd_name}_" if iskeyword(cmd_name) else cmd_name
        command = getattr(import_module(f"cellc.tools.cli.{name}"), name)
        assert isinstance(command, click.Command)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(_COMMANDS.items()))


@click.group(cls=_LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="cellc")
@click.pass_context
def cellc(context: click.Context) -> None:
    """Compile a declarative robot cell: check it, write its ROS 2 package, rehearse it on a mock.

    Exit codes: 0 good, 1 findings, 2 usage, 70 cellc or a disk under it failed, 128 + N ended by signal N. cellc never
    enables real motion.
    """
    command = context.invoked_subcommand
    if command is not None and command not in _WAITING:
        context.with_resource(progress(command))


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and leave with its exit code.

    Args:
        arguments: those of the process if None.
    """
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit code."""
    return run_to_end(partial(_run, None if arguments is None else list(arguments)))


def _run(arguments: list[str] | None) -> int:
    try:
        # Outside standalone mode click returns the code of an Exit, and what a finished command returned: None.
        return cellc.main(args=arguments, prog_name="cellc", standalone_mode=False) or 0
    except click.ClickException as problem:
        _show_usage(problem)
        return 2
    except click.Abort:  # what click makes of Ctrl-C
        raise KeyboardInterrupt from None


def _show_usage(problem: click.ClickException) -> None:
    """Print what click says of a wrong call, in click's own form; what the user wrote stays on its line."""
    context = problem.ctx if isinstance(problem, click.UsageError) else None
    if context is not None:
        hint = f"Try '{context.command_path} {context.help_option_names[0]}' for help."
        show(*context.get_usage().split("\n"), hint, "", to=Stream.ERR)
    error = f"Error: {problem.format_message()}"
    # Click lists the choices of a parameter that is missing, one a line.
    show(*(error.split("\n") if isinstance(problem, click.MissingParameter) else [error]), to=Stream.ERR)
