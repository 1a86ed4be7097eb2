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
    "init": "Write a new cell from names of devices.",
    "import": "Create a device folder from a vendor's robot description.",
    "catalog": "List, find or show devices of the catalog.",
    "check": "Check cells, devices and robot descriptions.",
    "explain": "Explain a diagnostic code.",
    "show": "Show a resolved value and its source.",
    "format": "Format the files of cells and devices.",
    "build": "Check cells and write their ROS 2 packages.",
    "hook": "Check form, errors and generated folders before a commit.",
    "watch": "Check cells, and build them, each time a file is saved.",
    "mock": "Run the rehearsals of a generated folder on the mock.",
    "campaign": "Inject every fault at every step of the rehearsals.",
    "sweep": "Estimate success rates of rehearsals by random draws.",
    "replay": "Repeat single runs of a campaign or a sweep.",
    "gates": "Check the gates that the mock can check.",
    "evidence": "List the evidence of the gates, what is missing and who signs.",
    "attempt": "Read the record of an attempt from its bags.",
    "view": "Write one HTML page of a cell with 3D view, rehearsals and findings.",
    "audit": "Print versions, expectations, command paths and open questions.",
    "diff": "Show what changed in a cell, and what that means.",
    "compare": "Compare the motion contracts and duties of several cells.",
    "upgrade": "Show what another ROS 2 distribution would change.",
    "diagnose": "List possible causes of a symptom, and what to check.",
    "lsp": "Run the language server for editors.",
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

    Exit codes: 0 success, 1 findings, 2 usage error, 70 internal or disk error, 128 + N ended by signal N. cellc never
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
