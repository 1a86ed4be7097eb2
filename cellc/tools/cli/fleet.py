"""The arguments and options of commands about many cells: which are meant, the tuples to try, and who does it."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import wraps
from itertools import product
from typing import TYPE_CHECKING, Any

import click

from cellc.contract.compute.fan import Fan

if TYPE_CHECKING:
    from cellc.mock.command.options import FolderOptions

Versions = Mapping[str, str]
"""Parts of the version tuple with other texts than a spec has."""


@dataclass(frozen=True, slots=True)
class Task:
    """A spec, and what of its version tuple is another than it says."""

    file: str
    versions: Versions = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class FleetOptions:
    """What is asked for beside the cells.

    Attributes:
        matrix: tuples to try each cell with, as parts that are replaced; one of nothing where the cells' own counts.
        as_json: the table as JSON, and nothing else.
    """

    matrix: tuple[Versions, ...]
    fan: Fan
    as_json: bool

    @property
    def moves(self) -> bool:
        """Whether cells are tried with other tuples than their own."""
        return self.matrix != ({},)

    def tasks(self, files: Sequence[str]) -> list[Task]:
        """Return each spec with each tuple."""
        return [Task(file, versions) for file in files for versions in self.matrix]


MATRIX = click.option(
    "--matrix",
    multiple=True,
    metavar="PART=TEXT,TEXT",
    help="Try each cell with these versions, such as ros=humble,jazzy; repeatable. Specs are not changed.",
)
_JOBS = click.option(
    "--jobs", type=click.IntRange(1, 1024), metavar="N", help="Number of processes; chosen automatically by default."
)
_CLUSTER = click.option(
    "--cluster", metavar="ADDRESS", help="Address of a Dask scheduler to use instead, such as tcp://10.0.0.7:8786."
)
_TABLE = click.option("--json", "as_json", is_flag=True, help="Write only the table of cells, as JSON.")


def fan_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options that say who does it; they come as one argument, ``fan``."""

    @_JOBS
    @_CLUSTER
    @wraps(command)
    def within(jobs: int | None, cluster: str | None, **others: Any) -> None:
        if jobs is not None and cluster is not None:
            raise click.UsageError("--jobs cannot be combined with --cluster, which uses all its workers.")
        command(fan=Fan(jobs, cluster), **others)

    return within


def fleet_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options of a command for many cells; they come as one argument, ``fleet``."""

    @MATRIX
    @fan_options
    @_TABLE
    @wraps(command)
    def within(matrix: tuple[str, ...], fan: Fan, as_json: bool, **others: Any) -> None:
        if as_json and others.get("output_format", "text") != "text":
            raise click.UsageError("--json cannot be combined with --format.")
        command(fleet=FleetOptions(read_matrix(matrix), fan, as_json), **others)

    return within


def read_matrix(given: Sequence[str]) -> tuple[Versions, ...]:
    """Return every combination of the texts that are given for each part of the tuple."""
    axes: dict[str, list[str]] = {}
    for option in given:
        part, _, texts = option.partition("=")
        if part in axes:
            raise click.UsageError(f"`--matrix` names `{part}` twice; write its texts in one, with commas.")
        axes[part] = list(dict.fromkeys(text.strip() for text in texts.split(",")))
        _refuse_unusable(part, axes[part])
    return tuple(dict(zip(axes, texts, strict=True)) for texts in product(*axes.values()))


def _refuse_unusable(part: str, texts: Sequence[str]) -> None:
    # Loads the models of the spec, which a command without a matrix gets later and in another process.
    from cellc.tools.review.moved_spec import unusable

    for text in texts:
        problem = unusable(part, text)
        if problem:
            raise click.UsageError(f"`--matrix`: {problem}.")


def folder_of(versions: Versions) -> str:
    """Return the folder that holds the packages of a tuple, such as ``ros-humble``; empty for the cells' own."""
    return "_".join(re.sub(r"[^A-Za-z0-9.+~-]", "-", f"{part}-{text}") for part, text in versions.items())


@dataclass(frozen=True, slots=True)
class Named:
    """What the arguments of a call name.

    Attributes:
        paths: generated folders; specs, or folders of them, where there is a matrix.
        table: whether a table of several is printed, and not the results of one folder.
    """

    paths: tuple[str, ...]
    table: bool


def named_by(arguments: tuple[str, ...], matrix: tuple[str, ...]) -> Named:
    """Return what is named; a pattern represents what it matches, and a folder of several all of them."""
    if matrix:
        return Named(arguments, table=True)
    if len(arguments) == 1 and os.path.exists(os.path.join(arguments[0], "contract.json")):
        return Named(arguments, table=False)  # what looks for others loads for longer than a folder is read
    from cellc.tools.cli.batch import matched, several_folders

    several = several_folders(arguments)
    return Named((next(matched(arguments)),), table=False) if several is None else Named(several, table=True)


_OF_ONE_FOLDER = {
    "rehearsals": "--rehearsal",
    "records": "--records",
    "journal": "--journal",
    "evidence": "--evidence",
    "stage": "--stage",
    "live": "--live",
    "physics": "--physics",
    "film": "--film",
}


def refuse_for_many(options: FolderOptions) -> None:
    """Raise UsageError for the first option that was given, each of which needs exactly one folder."""
    for name, option in _OF_ONE_FOLDER.items():
        if getattr(options, name, None):
            raise click.UsageError(f"{option} needs exactly one folder.")
