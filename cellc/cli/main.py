"""The command ``cellc``: one thin file per subcommand, imported only when it runs."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Sequence
from importlib import import_module

import click

from cellc.signals import CLOSED_PIPE, drop_output
from cellc.version import __version__

# Command → module; the function in it has the command's name.
_COMMANDS = {
    "audit": "Print versions, expectations, command paths and open questions.",
    "build": "Check cells and write their artifacts.",
    "check": "Find what is wrong before anything moves.",
    "completion": "Print the completion script of a shell.",
    "diagnose": "Tell what a symptom may mean, and what to look at.",
    "explain": "Explain a diagnostic code.",
    "init": "Write a new cell from device names.",
    "mock": "Execute the rehearsals of a generated folder.",
    "schema": "Print or write the JSON schemas.",
    "show": "Show a resolved value and where it came from.",
}


class _LazyGroup(click.Group):
    """A group that imports a subcommand's module when it is asked for, so that `check` never pays for `mock`."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return None
        command = getattr(import_module(f"cellc.cli.{cmd_name}"), cmd_name)
        assert isinstance(command, click.Command)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(sorted(_COMMANDS.items()))


@click.group(cls=_LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="cellc")
def cellc() -> None:
    """Compile a declarative robot cell: check it, write its ROS 2 package, rehearse it on a mock.

    Exit codes: 0 good, 1 findings, 2 usage, 128 + N ended by signal N. cellc never enables real motion.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and leave with its exit code.

    Args:
        arguments: those of the process if None.
    """
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit code; a closed pipe or a full disk end without a traceback."""
    _prepare_streams()
    try:
        given = None if arguments is None else list(arguments)
        # Outside standalone mode click returns the code of an Exit, and what a finished command returned: None.
        code = cellc.main(args=given, prog_name="cellc", standalone_mode=False)
        sys.stdout.flush()
    except click.ClickException as problem:
        problem.show()
        code = 2
    except BrokenPipeError:
        # The reader of our output went away (`cellc show … | head`).
        drop_output()
        code = CLOSED_PIPE
    except OSError as error:
        # What a command expects of the disk it reports itself: this is a full disk under the output, and the like.
        drop_output()
        place = f"{error.filename}: " if error.filename else ""
        print(f"error: {place}{(error.strerror or 'unknown reason').lower()}", file=sys.stderr)
        code = 1
    return int(code or 0)


def _prepare_streams() -> None:
    # Python gives None where who started us closed the descriptor.
    sys.stdout = sys.stdout or _nowhere()
    sys.stderr = sys.stderr or _nowhere()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # A spec may quote what the terminal's encoding cannot: show it escaped instead of failing.
            stream.reconfigure(errors="backslashreplace")


def _nowhere() -> io.TextIOWrapper:
    return io.TextIOWrapper(io.FileIO(os.devnull, "w"))
