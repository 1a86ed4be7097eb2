"""A plugin of pytest for the repository of a node: the fixture `cellc_cell` plays the cell around it on a ROS graph.

What is played is configured as docs/mock.md has it. pytest loads this file in every session in which
cellc is installed, so that what is heavy is imported by the fixture alone.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal

import pytest

from cellc.contract.frozen import dataclass

if TYPE_CHECKING:
    from cellc.contract.rehearsals import FaultEntry
    from cellc.mock.cell import MockCell
    from cellc.mock.result import RehearsalResult
    from cellc.mock.ros.asked import AmongNodes

_OPTIONS = {
    "folder": "the generated folder, from the folder of the configuration file on",
    "without": "nodes under test, such as task or task,perception",
    "launch": "command that starts them for each rehearsal; {rehearsal} is its name",
    "python": "Python with rclpy; /usr/bin/python3 by default",
    "domain": "ROS domain of the graph, 100 by default; workers of pytest-xdist take those below it",
    "pace": "times real time; lockstep by default",
    "patience": "seconds of the host for which lockstep waits for an answer; 5 by default",
}
_WORKER = "PYTEST_XDIST_WORKER"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of the fixture."""
    for name, text in _OPTIONS.items():
        parser.addini(f"cellc_{name}", text, default="")


@dataclass(frozen=True, slots=True)
class Ended:
    """The end of a rehearsal around the nodes under test.

    Attributes:
        result: with the attempts and what the nodes did against the contract.
        notes: what depends on the host.
    """

    result: RehearsalResult
    notes: tuple[str, ...]
    wall_time_s: float

    def expect(self, outcome: str = "", *, within_s: float | None = None) -> None:
        """Require an outcome, and that no node under test broke the contract.

        Args:
            outcome: such as ``stale_state``; that of the rehearsal where it is empty.
            within_s: simulated time from the effect of the fault on in which it must come.

        Raises:
            AssertionError: it ended otherwise; says what `cellc mock` says.
        """
        from cellc.contract.vocabulary import AttemptOutcome
        from cellc.mock.command.rehearsals import TimedResult, to_lines

        known = [each.value for each in AttemptOutcome]
        if outcome and outcome not in known:
            raise ValueError(f"`{outcome}` is no outcome; outcomes are {', '.join(known)}")
        expected = AttemptOutcome(outcome) if outcome else self.result.expected
        bound = self.result.within_s if within_s is None else within_s
        result = replace(self.result, expected=expected, within_s=bound)
        if not result.passed:
            raise AssertionError("\n".join(to_lines([TimedResult(result, self.wall_time_s)], self.notes)))


class CellUnderTest:
    """A cell that is played around nodes under test: a rehearsal is a call, and so is a fault of the next one."""

    def __init__(self, cell: MockCell, asked: AmongNodes) -> None:
        """Bind the cell; nothing is on a graph yet."""
        self._cell, self._asked = cell, asked
        self._faults: list[FaultEntry] = []

    def inject(
        self,
        kind: str,
        target: str,
        *,
        step: int | None = None,
        when: Literal["started", "accepted", "moving"] = "started",
        **more: float,
    ) -> None:
        """Inject a fault into the next rehearsal.

        Args:
            kind: as in a spec, such as ``freeze``.
            target: what it hits, by its ROS name.
            step: number of the step that begins it, from 1.
            when: how far that step has come.
            more: further fields of an entry of ``rehearsals.json``: ``at_s`` in the place of a step, ``delay_s``.
        """
        from pydantic import ValidationError

        from cellc.contract.rehearsals import FaultEntry

        event = {} if step is None else {"event": {"step": step, "when": when}}
        try:
            self._faults.append(FaultEntry.model_validate({"kind": kind, "target": target, **event, **more}))
        except ValidationError as error:
            problems = (f"`{'.'.join(map(str, each['loc']))}`: {each['msg']}" for each in error.errors())
            raise ValueError(f"fault `{kind}` cannot be injected: {'; '.join(problems)}") from None

    def run(self, rehearsal: str) -> Ended:
        """Run a rehearsal of the folder with the faults that were injected since the last one."""
        from cellc.mock.errors import MockError
        from cellc.mock.ros.session import rehearse_among

        faults, self._faults = self._faults, []
        began_s = perf_counter()
        try:
            entry = self._cell.entry(rehearsal)
            entry = entry.model_copy(update={"faults": (*entry.faults, *faults)})
            judged = rehearse_among(self._cell, entry, 0, self._asked)
        except MockError as error:
            pytest.fail(str(error), pytrace=False)
        return Ended(judged.result, judged.notes, perf_counter() - began_s)


@pytest.fixture(scope="session")
def _cellc_loaded(pytestconfig: pytest.Config) -> tuple[MockCell, AmongNodes]:
    from cellc.mock import load
    from cellc.mock.errors import MockError

    options = {name: str(pytestconfig.getini(f"cellc_{name}")) for name in _OPTIONS}
    asked = asked_with(options, os.environ.get(_WORKER, "gw0"))
    try:
        return load(Path(pytestconfig.rootpath, options["folder"])), asked
    except MockError as error:
        pytest.fail(str(error), pytrace=False)


def asked_with(options: Mapping[str, str], worker: str) -> AmongNodes:
    """Return what a configuration asks for, with a domain of its own for each worker; fail where it cannot be used."""
    from cellc.mock.ros.asked import OWN_DOMAIN, AmongNodes, Timing, usual_interpreter

    for name in ("folder", "without"):
        if not options[name]:
            pytest.fail(f"`cellc_{name}` must be set in the configuration of pytest: {_OPTIONS[name]}", pytrace=False)
    timing = Timing(
        _number("pace", options["pace"]) if options["pace"] else None, _number("patience", options["patience"] or "5")
    )
    domain = int(_number("domain", options["domain"] or str(OWN_DOMAIN))) - int(worker.removeprefix("gw"))
    nodes = tuple(options["without"].replace(",", " ").split())
    return AmongNodes(nodes, options["python"] or usual_interpreter(), timing, domain, options["launch"])


def _number(name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not value > 0.0:
        pytest.fail(f"`cellc_{name}` must be a number greater than 0, got `{text}`", pytrace=False)
    return value


@pytest.fixture
def cellc_cell(_cellc_loaded: tuple[MockCell, AmongNodes]) -> CellUnderTest:
    """Play the cell around the nodes under test."""
    return CellUnderTest(*_cellc_loaded)
