"""How much cellc reads, expands and simulates before it refuses: one table, which every reader asks.

The files are untrusted. A bound is far above what a real cell needs, and keeps a hostile one from costing more
than seconds and some hundred megabytes. `docs/limits.md` is this table. What a large cell may need more of (time,
memory, meshes, files, runs) `--limit NAME=VALUE` raises for one call; the other bounds are fixed.

The table in force belongs to the process, as a locale does: every stage would otherwise pass it on to the next one.
The command line alone changes it, for the time of a command, and hands it to the processes that it starts.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field, fields, replace
from typing import TypeVar

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass

KIB = 1024
MIB = 1024 * KIB
_Work = TypeVar("_Work")


class LimitError(CellcError, ValueError):
    """An option names no limit, or not a value that it can have; the text says which there are."""


@dataclass(frozen=True, slots=True)
class Row:
    """What the table says of one limit beside its default.

    Args:
        unit: what is counted.
        bounds: what it bounds, for people.
        highest: the largest value that the option takes; above it the program itself would fail. None where the bound
            is fixed.
    """

    unit: str
    bounds: str
    highest: int | None


def _adjustable(default: int, unit: str, highest: int, bounds: str) -> int:
    return _row(default, Row(unit, bounds, highest))


def _fixed(value: int, unit: str, bounds: str) -> int:
    return _row(value, Row(unit, bounds, None))


def _row(default: int, row: Row) -> int:
    limit: int = field(default=default, metadata={"row": row})
    return limit


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """The limits in force; a field is a row of the table, with dashes for underscores in its name."""

    spec_files: int = _adjustable(32, "files", 128, "files that belong to one spec")
    plant_cells: int = _adjustable(64, "cells", 512, "cells of one plant")
    xml_bytes: int = _adjustable(
        8 * MIB, "bytes", 256 * MIB, "one URDF, SRDF or xacro file, and one expansion of xacro"
    )
    xacro_elements: int = _adjustable(50_000, "elements", 5_000_000, "elements that one expansion of xacro evaluates")
    xacro_seconds: int = _adjustable(10, "s", 3600, "processor time of one expansion of xacro")
    xacro_seconds_together: int = _adjustable(30, "s", 36_000, "processor time of all expansions of one spec")
    xacro_memory: int = _adjustable(1024 * MIB, "bytes", 64 * 1024 * MIB, "memory of one expansion of xacro")
    mesh_shapes: int = _adjustable(1000, "shapes", 20_000, "mesh shapes of one description")
    mesh_bytes: int = _adjustable(64 * MIB, "bytes", 1024 * MIB, "one mesh file")
    mesh_bytes_together: int = _adjustable(256 * MIB, "bytes", 4096 * MIB, "all mesh files of one description")
    mesh_triangles: int = _adjustable(200_000, "triangles", 5_000_000, "one mesh")
    mesh_triangles_together: int = _adjustable(
        500_000, "triangles", 20_000_000, "all meshes of one description, each once for each scale"
    )
    mesh_seconds: int = _adjustable(24, "s", 3600, "processor time of reading all meshes of one description")
    mesh_memory: int = _adjustable(1024 * MIB, "bytes", 64 * 1024 * MIB, "memory of reading them")
    robot_pairs: int = _adjustable(
        20_000,
        "pairs",
        1_000_000,
        "pairs of collision shapes of robots that can reach each other, with what is in their reach",
    )
    planning_seconds: int = _adjustable(
        60, "s", 36_000, "processor time of what poses and goals of one cell lead to, and of its pairs of links"
    )
    command_seconds: int = _adjustable(
        3600, "s", 360_000, "processor time of one spec or page, and of all of a call of `check`, `build` or `mock`"
    )
    log_bytes: int = _adjustable(256 * MIB, "bytes", 1024 * 1024 * MIB, "logs of one call, from the begin of each file")
    folder_bytes: int = _adjustable(4 * MIB, "bytes", 64 * MIB, "one file of a generated folder")
    folder_entries: int = _adjustable(
        10_000, "entries", 100_000, "one list or mapping in JSON of a generated folder, and files of a git revision"
    )
    folder_total_bytes: int = _adjustable(
        256 * MIB, "bytes", 16 * 1024 * MIB, "all files of a generated folder together"
    )
    mock_samples: int = _adjustable(
        10_000_000, "values", 10_000_000_000, "update cycles of one run times their joints, and what a buffer keeps"
    )
    rehearsal_seconds: int = _adjustable(
        600, "s", 360_000, "processor time of a rehearsal, and of those of one generated folder, one after the other"
    )
    campaign_runs: int = _adjustable(10_000, "runs", 1_000_000, "runs of a campaign, and pairs and processes asked for")
    mock_events: int = _adjustable(1_000_000, "events", 1_000_000_000, "images, messages and timers of one run")

    spec_bytes: int = _fixed(2 * MIB, "bytes", "one file of a spec, or of YAML beside it")
    spec_depth: int = _fixed(64, "levels", "nesting of values in YAML")
    spec_values: int = _fixed(200_000, "values", "values of a spec with every alias and include written out")
    xml_depth: int = _fixed(64, "levels", "nesting of elements in XML")
    xacro_includes: int = _fixed(32, "files", "nesting of includes in xacro")
    xacro_macros: int = _fixed(100, "calls", "nesting of macros in xacro")
    xacro_yaml_bytes: int = _fixed(MIB, "bytes", "one YAML file that xacro reads")
    xacro_text: int = _fixed(64 * KIB, "characters", "a text in an expression of xacro")
    xacro_items: int = _fixed(10_000, "items", "a list in an expression of xacro")
    robot_links: int = _fixed(1000, "links", "links of one device, and of robots that can reach each other")
    robot_joints: int = _fixed(200, "joints", "joints that move, of one device and of robots that can reach each other")
    cell_links: int = _fixed(20_000, "links", "links of the URDF of a generated folder")
    cell_joints: int = _fixed(4000, "joints", "joints of it that move")
    folder_depth: int = _fixed(32, "levels", "nesting of values in JSON and parameters of a generated folder")
    folder_values: int = _fixed(400_000, "values", "values of one JSON file of a generated folder")
    mock_seconds: int = _fixed(86_400, "s", "a duration in a generated folder")
    mock_rate: int = _fixed(20_000, "Hz", "a rate in a generated folder")
    mock_stop_cycles: int = _fixed(20_000, "cycles", "update cycles that a stop of a trajectory takes")
    message_bytes: int = _fixed(16 * MIB, "bytes", "one message of an editor to the language server")
    open_documents: int = _fixed(1000, "documents", "documents that an editor has open with the language server")
    sweep_runs: int = _fixed(10_000_000, "runs", "runs of a sweep, each of which is kept with about 100 bytes")


class BudgetError(CellcError):
    """The pieces of work took what they may take together."""


class Budget:
    """Seconds that several pieces of work may take together."""

    def __init__(self, seconds: float, clock: Callable[[], float]) -> None:
        """Begin to count."""
        self._end_s = clock() + seconds
        self._clock = clock

    @property
    def left_s(self) -> float:
        """What is left, 0 where nothing is."""
        return max(0.0, self._end_s - self._clock())

    def empty(self) -> None:
        """Leave nothing: one piece of work took all that it may."""
        self._end_s = self._clock()

    def over(self, work: Iterable[_Work]) -> Iterator[_Work]:
        """Yield piece after piece; raise BudgetError before one for which nothing is left."""
        for piece in work:
            if not self.left_s:
                raise BudgetError
            yield piece


def children_seconds() -> float:
    """Return the processor time of the children of this process that have ended."""
    times = os.times()
    return times.children_user + times.children_system


DEFAULTS = Limits()
_in_force = DEFAULTS


def limits() -> Limits:
    """Return the limits in force."""
    return _in_force


def use(chosen: Limits) -> None:
    """Put limits in force for the rest of the process: for one that was started with them."""
    global _in_force
    _in_force = chosen


@contextmanager
def in_force(chosen: Limits) -> Iterator[None]:
    """Put limits in force for a while."""
    before = limits()
    use(chosen)
    try:
        yield
    finally:
        use(before)


def rows() -> Mapping[str, Row]:
    """Return the rows of the table by their names with dashes, in its order."""
    return {each.name.replace("_", "-"): each.metadata["row"] for each in fields(Limits)}


def adjustable() -> Mapping[str, int]:
    """Return the largest value of each limit that the option raises, by its name."""
    return {name: row.highest for name, row in rows().items() if row.highest is not None}


def default(name: str) -> int:
    """Return the default of a row."""
    return _value(DEFAULTS, name)


def option(name: str) -> str:
    """Return the option that raises a limit, for the help of a message."""
    assert name in adjustable(), name
    return f"`--limit {name}=N` raises it"


def raised(given: Sequence[str]) -> Limits:
    """Return the limits with what options raise.

    Args:
        given: each ``NAME=VALUE``; the last of a name counts.

    Raises:
        LimitError: a name is unknown, or a value is below the default or above what the program can take.
    """
    changed: dict[str, int] = {}
    largest = adjustable()
    for text in given:
        name, _, value = text.partition("=")
        if name not in largest:
            raise LimitError(f"no limit `{name[:60]}` can be raised; those that can are {', '.join(largest)}")
        least, most = default(name), largest[name]
        number = int(value) if value.isascii() and value.isdigit() and len(value) <= 20 else -1
        if not least <= number <= most:
            raise LimitError(f"`{name}` must be a whole number from {least} to {most}, got `{value[:60]}`")
        changed[name.replace("-", "_")] = number
    return replace(DEFAULTS, **changed)


def as_options(chosen: Limits) -> list[str]:
    """Return what of some limits is not at its default, as the option takes it."""
    return [f"{name}={_value(chosen, name)}" for name in adjustable() if _value(chosen, name) != default(name)]


def _value(of: Limits, name: str) -> int:
    value: int = getattr(of, name.replace("-", "_"))
    return value
