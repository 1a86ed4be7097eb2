"""The options of every command that reads what others wrote: limits to raise, and where packages lie."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import click

from cellc.contract.limits import LimitError, in_force, raised
from cellc.robot.description.packages import on_package_path

_Command = TypeVar("_Command", bound=Callable[..., Any])


def _apply_packages(context: click.Context, _parameter: click.Parameter, given: Sequence[str]) -> None:
    folders = [folder for text in given for folder in text.split(os.pathsep) if folder]
    wrong = next((folder for folder in folders if not os.path.isdir(folder)), None)
    if wrong is not None:
        raise click.UsageError(f"`--package-path` must name folders, got `{wrong}`.")
    context.with_resource(on_package_path(folders))


def _apply_limits(context: click.Context, _parameter: click.Parameter, given: Sequence[str]) -> None:
    try:
        chosen = raised(given)
    except LimitError as problem:
        raise click.UsageError(f"{problem}.") from None
    context.with_resource(in_force(chosen))


_PACKAGE_PATH = click.option(
    "--package-path",
    multiple=True,
    metavar="FOLDERS",
    expose_value=False,
    callback=_apply_packages,
    help='Folders of packages, in the format of "$AMENT_PREFIX_PATH"; repeatable.',
)
_LIMIT = click.option(
    "--limit",
    multiple=True,
    metavar="NAME=VALUE",
    expose_value=False,
    callback=_apply_limits,
    help="Raise a limit of docs/limits.md; repeatable.",
)


def limit_option(command: _Command) -> _Command:
    """Add ``--limit`` and ``--package-path``, which hold for as long as the command runs."""
    return _PACKAGE_PATH(_LIMIT(command))
