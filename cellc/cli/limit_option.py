"""The option that raises limits, of every command that reads what others wrote."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import click

from cellc.limits import LimitError, in_force, raised

_Command = TypeVar("_Command", bound=Callable[..., Any])


def limit_option(command: _Command) -> _Command:
    """Add ``--limit``, which holds for as long as the command runs."""
    return click.option(
        "--limit",
        multiple=True,
        metavar="NAME=VALUE",
        expose_value=False,
        callback=_apply,
        help="Raise a limit of docs/limits.md; repeatable.",
    )(command)


def _apply(context: click.Context, _parameter: click.Parameter, given: Sequence[str]) -> None:
    try:
        chosen = raised(given)
    except LimitError as problem:
        raise click.UsageError(f"{problem}.") from None
    context.with_resource(in_force(chosen))
