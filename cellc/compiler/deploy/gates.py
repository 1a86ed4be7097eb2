"""Gates G0 to G7 and layers L1 to L6 for a cell: the prose of ``gates.yaml`` with what the cell fills in."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from string import Formatter
from typing import Annotated, cast

from pydantic import Field, Strict, field_validator, model_validator

from cellc.compiler.catalog.catalog_model import CatalogModel, Text
from cellc.compiler.catalog.read_model import read_model
from cellc.compiler.deploy.enabling import all_early, commands_from_its_start, enabled_early
from cellc.compiler.deploy.gate_subjects import CELL, FIELDS, ROWS, Row, cell_row
from cellc.compiler.formats.escape import code, shell_word
from cellc.compiler.formats.header import Header
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.frozen import dataclass
from cellc.contract.gates import GateSetting
from cellc.contract.vocabulary import GateCode, RobotSetting

_FIELD = re.compile(r"`\{(\w+)\}`|\{(\w+)\}")
_COMMANDS = ("build", "cancel", "command", "host", "record", "secrets", "start_mock")
"""Fields that are commands; every other is one word of a command."""

_SETTINGS: Mapping[str, RobotSetting] = {
    "loaded_device": "payload",
    "tool_center": "tcp",
    "tool_connector": "tool_voltage",
    "first_motion": "first_motion",
}
"""Subjects that are set or tried in a robot; a vendor's step names what it sets itself."""
_UNSTATED = (*_COMMANDS, "gate", "sets", "device", "and_inertia", "name", "si", "entry", "rotation", "same")
"""Fields that say how, when or on which device, or repeat another."""

FILE = Path(__file__).with_name("gates.yaml")
_STARTS = ("ros2 launch ", "ros2 bag record ")


@dataclass(frozen=True, slots=True)
class Check:
    """One line to tick; ``commands`` read and never change anything at the cell, or start what its gate releases.

    ``setting`` is what it has set in a robot. ``traced`` commands are printed above their answers, which tells these
    apart.
    """

    text: str
    commands: tuple[str, ...] = ()
    setting: GateSetting | None = None
    traced: bool = False

    @property
    def starts(self) -> bool:
        """Whether it starts a part of the cell that stays in its shell, rather than reads and ends."""
        return any(command.startswith(_STARTS) for command in self.commands)


@dataclass(frozen=True, slots=True)
class Gate:
    """One gate of a cell.

    Args:
        shows: what the passed gate proves, in one phrase.
        state: state that the robot or its drives are in.
        evidence: name of the file that people and commands write their notes to; `left_by` has all that it leaves.
        owner: who signs, from the spec.
        stop: conditions that stop the gate.
        measured: values that are measured or read back, and recorded.
        closed: whether it must not be passed, because nothing moves the cell on the real target.
    """

    code: GateCode
    title: str
    shows: str
    state: str
    checks: tuple[Check, ...]
    evidence: str
    owner: str
    stop: tuple[str, ...]
    measured: tuple[str, ...] = ()
    closed: bool = False

    @property
    def key_command(self) -> str:
        """The first line of commands that reads and has no pipe; empty for a gate without one."""
        read = (command for check in self.checks if not check.starts for command in check.commands)
        return next((command.splitlines()[0] for command in read if "|" not in command), "")


class Line(CatalogModel):
    """A text that is written once for each subject, with its commands.

    Where ``first`` is stated, it is a line with the commands of all of them, before their texts: one for each ``where``
    of subjects that have it. What several subjects say the same is one line.
    """

    of: str = CELL
    first: Text | None = None
    text: Text
    each: str | None = None
    run: tuple[Text, ...] = ()

    @field_validator("of", "each")
    @classmethod
    def _exists(cls, subject: str | None) -> str | None:
        if subject is not None and subject not in FIELDS:
            raise ValueError(f"expected one of {', '.join(FIELDS)}, got `{subject}`")
        return subject

    @model_validator(mode="after")
    def _names_its_subject(self) -> Line:
        of_text = {*FIELDS[CELL], *FIELDS[self.of]}
        of_commands = {*of_text, *FIELDS[self.each or CELL]}
        texts = ((self.first or "", {*FIELDS[CELL], *({"where"} & of_text)}), (self.text, of_text))
        for text, known in (*texts, *((command, of_commands) for command in self.run)):
            unknown = {name for _, name, _, _ in Formatter().parse(text) if name is not None} - known
            if unknown:
                raise ValueError(f"`{self.of}` has no {', '.join(sorted(unknown))}")
        return self


class GateText(CatalogModel):
    """The prose of a gate; ``signed_by`` names the field of the spec with its owner.

    ``real`` gates are of real hardware. ``powered`` is the state of a device whose stop is tested before its driver
    starts, ``commanded`` what else is true where that start takes command of it.
    """

    code: Annotated[GateCode, Strict(False)]
    title: Text
    shows: Text
    state: Text
    real: bool = False
    powered: Text | None = None
    commanded: Text | None = None
    evidence: Text
    signed_by: Text
    checks: tuple[Line, ...] = Field(min_length=1)
    stop: tuple[Line, ...] = Field(min_length=1)
    measured: tuple[Line, ...] = ()


class PageText(CatalogModel):
    """What the page of several gates begins with."""

    title: Text
    text: Text


class GateTexts(CatalogModel):
    """All gates: from the powered-off manifest to a trajectory, and from the cable to the command path.

    ``usage`` is on each page below its own text, ``result`` the line that ends each gate, ``closed`` the one line of a
    gate of real hardware where the real target is closed, ``simulated`` what a run in a simulator proves.
    """

    pages: Mapping[str, PageText]
    usage: Text
    result: Text
    simulated: Text
    closed: Text
    promotion: tuple[GateText, ...]
    network: tuple[GateText, ...]


@cache
def gate_texts() -> GateTexts:
    """Return the prose of all gates.

    Raises:
        ValueError: the file of the package is not what its model says; tests hold that it is.
    """
    read = read_model(FILE, FILE.name, GateTexts)
    if read.value is None:
        raise ValueError("; ".join(f"{diagnostic.span}: {diagnostic.message}" for diagnostic in read.diagnostics))
    return read.value[0]


def promotion_gates(graph: CellGraph, header: Header) -> tuple[Gate, ...]:
    """Return gates G0 to G7 in order."""
    return tuple(_gate(text, graph, header) for text in gate_texts().promotion)


def network_gates(graph: CellGraph, header: Header) -> tuple[Gate, ...]:
    """Return layers L1 to L6 in order."""
    return tuple(_gate(text, graph, header) for text in gate_texts().network)


def _gate(text: GateText, graph: CellGraph, header: Header) -> Gate:
    base = cell_row(graph.cell, header, text.code)
    closed = tuple(_closed(graph, base)) if text.real else ()
    return Gate(
        code=text.code,
        title=text.title,
        shows=text.shows,
        state=_state(text, graph),
        checks=closed or tuple(check for line in text.checks for check in _checks(line, graph, base)),
        evidence=text.evidence,
        owner=_owners(graph)[text.signed_by],
        stop=tuple(check.text for line in text.stop for check in _checks(line, graph, base)),
        measured=() if closed else tuple(check.text for line in text.measured for check in _checks(line, graph, base)),
        closed=bool(closed),
    )


def _closed(graph: CellGraph, base: Row) -> Iterator[Check]:
    """Yield the line of a gate of real hardware in a cell that nothing moves there."""
    yield from (Check(_said(gate_texts().closed, {**base, **row})) for row in _rows("unmoved", graph, base["gate"]))


def _state(text: GateText, graph: CellGraph) -> str:
    """Return the state of the drives in a gate, with the devices that differ from the rest."""
    early = enabled_early(graph)
    if text.powered is None or text.commanded is None or not early:
        return text.state
    commanded = [device.name for device in graph.cell.devices if commands_from_its_start(device)]
    states = ((text.powered, early), (text.commanded, commanded))
    differs = (f"{state}: {', '.join(names)}" for state, names in states if names)
    return "; ".join((*(() if all_early(graph) else (text.state,)), *differs))


def _owners(graph: CellGraph) -> Mapping[str, str]:
    owners = graph.cell.owners
    return {
        **{f"approvals.{name}": owner for name, owner in owners.approvals},
        **{f"responsibilities.{name}": owner for name, owner in owners.responsibilities},
        "recovery.observer": graph.cell.safety.recovery.observer,
    }


def _checks(line: Line, graph: CellGraph, base: Row) -> Iterator[Check]:
    checks = tuple(_each(line, graph, base))
    places: dict[str, dict[str, None]] = {}
    for where, check in checks:
        places.setdefault(where, {}).update(dict.fromkeys(check.commands))
    if line.first is None or sum(map(len, places.values())) < 2:
        yield from (check for _, check in checks)
        return
    for where, commands in places.items():
        yield Check(_said(line.first, {**base, "where": where}), tuple(commands), traced=True)
    yield from {check.text: replace(check, commands=()) for _, check in checks}.values()


def _each(line: Line, graph: CellGraph, base: Row) -> Iterator[tuple[str, Check]]:
    """Yield each line after the place that it is for; an empty one where its subject has none."""
    repeated = tuple(_rows(line.each or CELL, graph, base["gate"]))
    for row in _rows(line.of, graph, base["gate"]) if repeated else ():
        filled = {**base, **row}
        words = ({name: _word(name, value) for name, value in {**filled, **other}.items()} for other in repeated)
        commands = (command.format_map(known) for known in words for command in line.run)
        run = tuple(command for command in commands if command)
        yield row.get("where", ""), Check(_said(line.text, filled), run, _setting(base["gate"], line.of, row))


def _setting(gate: str, subject: str, row: Row) -> GateSetting | None:
    sets = row.get("sets") or _SETTINGS.get(subject)
    if sets is None:
        return None
    device = row.get("device") or row["joint"].partition("/")[0]
    stated = {name: value for name, value in row.items() if value and name not in _UNSTATED}
    if "si" in row:
        stated["max_delta"] += f" ({row['si']})"
    return GateSetting(gate=GateCode(gate), sets=cast("RobotSetting", sets), device=device, values=stated)


def _said(text: str, row: Row) -> str:
    """Return a text with its fields filled in; text between backticks is code."""
    return _FIELD.sub(lambda found: code(row[found[1]]) if found[1] else row[found[2]], text)


def _word(field: str, value: str) -> str:
    return value if field in _COMMANDS else shell_word(value)


def _rows(subject: str, graph: CellGraph, gate: str) -> Iterator[Row]:
    """Yield what a subject fills in, once for each of it; the cell itself is one, and people act gate by gate."""
    if subject == CELL:
        yield {}
        return
    for values in graph.once(_listed(subject)):
        row = dict(zip(FIELDS[subject], values, strict=True))
        if row.get("gate", gate) == gate:
            yield row


@cache
def _listed(subject: str) -> Callable[[CellGraph], tuple[tuple[str, ...], ...]]:
    """Return what lists a subject; the lines of all gates ask for the same few."""
    return lambda graph: tuple(ROWS[subject](graph))
