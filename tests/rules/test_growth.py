"""Linking, rules, deployment and emitters do at most a little more than twice the work for a cell of twice the size."""

from __future__ import annotations

import cProfile
import json
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, TypeAlias

import pytest

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.deployment import Deployment, plan_deployment
from cellc.compiler.deploy.gate_subjects import ROWS
from cellc.compiler.emit import cell_picture, simulation
from cellc.compiler.emit.emit_all import EMITTERS
from cellc.compiler.graph.cell_graph import CellGraph, build_graph
from cellc.compiler.pipeline import check, emit_cell
from cellc.compiler.rules.run import ALL_RULES
from cellc.contract.diagnostics import Severity
from tests.cells import there
from tests.rules.halls import HALLS, of_groups

if TYPE_CHECKING:
    from _typeshed import TraceFunction

Emitter: TypeAlias = Callable[[CellGraph, Deployment], Iterator[Artifact]]
_FIRST, _MANY, _MOST = 8, 250, 2.15


def _cell(size: int) -> str:
    names = range(size)
    topic = {
        "topic": "geometry_msgs/msg/PoseStamped", "wants": "newest", "frame": "world", "rate": "10 Hz",
        "max_age": "200 ms", "on_stale": "reject_goal",
    }  # fmt: skip
    trajectory = {
        "type": "scaled_joint_trajectory", "goal_time": "1 s", "path_tolerance": "0.2 rad", "goal_tolerance": "0.01 rad"
    }  # fmt: skip
    places = [f"{1.5 * (name // 8)} {1.5 * (name % 8)} 0 m" for name in names]
    spec = {
        "format": 1,
        "cell": "large",
        "versions": {"ros": "jazzy"},
        "devices": {f"d{n}": {"model": "ur5e", "mount": {"parent": "world", "xyz": places[n]}} for n in names},
        "nodes": {f"n{n}": {"run": "tasks/node", "owner": "team", "lifecycle": n % 2 == 1} for n in names},
        "interfaces": {
            f"/t{n}": {**topic, "from": {f"n{n}": {"depth": 1}}, "to": {f"n{(n + 1) % size}": {"depth": 1}}}
            for n in names
        },
        "control": {
            "update_rate": "500 Hz",
            "controllers": {"joint_states": {"type": "joint_state_broadcaster"}}
            | {f"c{n}": {**trajectory, "device": f"d{n}", "client": f"n{n}"} for n in names},
        },
    }
    return json.dumps(spec)


def _stands(size: int) -> str:
    """Return the cell with a device without joints or controllers in the place of each arm."""
    spec = json.loads(_cell(size))
    for device in spec["devices"].values():
        device["model"] = "pedestal"
    spec["control"]["controllers"] = {"joint_states": {"type": "joint_state_broadcaster"}}
    return json.dumps(spec)


def _calls(text: str, folder: Path, work: Callable[[Path], object]) -> int:
    file = folder / "cell.yaml"
    file.write_text(text, encoding="utf-8")
    assert work(file) is not None  # and what is loaded and kept once is
    profile = cProfile.Profile(builtins=False)
    profile.runcall(work, file)
    calls = ((entry.code, entry.callcount) for entry in profile.getstats())
    return sum(
        number
        for code, number in calls
        if not isinstance(code, str) and "/cellc/" in code.co_filename.replace("\\", "/")
    )


def test_work_grows_with_the_cell_and_not_with_its_square(tmp_path: Path) -> None:
    once, twice = (
        _calls(_cell(size), tmp_path, lambda file: emit_cell(check(file)).value) for size in (_FIRST, 2 * _FIRST)
    )
    assert twice <= _MOST * once, f"{once} and {twice} calls"


def test_a_check_of_many_devices_grows_with_their_number(tmp_path: Path) -> None:
    # Few calls for each device, and many devices: what looks at all of them for each one is most of the work.
    once, twice = (_calls(_stands(size), tmp_path, lambda file: check(file).graph) for size in (_MANY, 2 * _MANY))
    assert twice <= _MOST * once, f"{once} and {twice} calls"


def _steps(work: Callable[[CellGraph], Iterator[object]], cell: Cell) -> int:
    """Count the steps of the interpreter within cellc, once what is kept of the graph is there."""
    graph, counted = build_graph(cell), 0
    list(work(graph))

    def within(_: FrameType, event: str, __: object) -> TraceFunction:
        nonlocal counted
        counted += event == "opcode"
        return within

    def enter(frame: FrameType, _: str, __: object) -> TraceFunction | None:
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        return within if "/cellc/" in frame.f_code.co_filename.replace("\\", "/") else None

    before = sys.gettrace()
    sys.settrace(enter)
    try:
        list(work(graph))
    finally:
        sys.settrace(before)
    return counted


WORK = {rule.code: rule.check for rule in ALL_RULES} | dict(ROWS)
_TWICE = 2.3


SPECS = pytest.mark.parametrize("spec", [_cell, _stands, *HALLS], ids=lambda spec: spec.__name__.strip("_"))


@SPECS
def test_no_rule_and_no_line_of_a_gate_searches_the_cell_for_each_of_its_things(
    spec: Callable[[int], str], tmp_path: Path
) -> None:
    cells = _of_three_sizes(spec, 8, tmp_path)
    assert _grown({name: [_steps(work, cell) for cell in cells] for name, work in WORK.items()}) == {}


OF_THE_WHOLE = {
    simulation.emit: "a keyframe has all joints, and pairs without contact are listed",
    cell_picture.emit: "names are set beside each other in one picture",
}
"""Emitters whose files, or drawings, have all things of the cell beside each thing."""


@SPECS
def test_no_emitter_searches_the_cell_for_each_of_its_things(spec: Callable[[int], str], tmp_path: Path) -> None:
    cells = _of_three_sizes(spec, 4, tmp_path)
    plans = [plan_deployment(build_graph(cell)) for cell in cells]
    steps = {
        emit.__module__: [_steps(partial(_emitted, emit, plan), cell) for cell, plan in zip(cells, plans, strict=True)]
        for emit in EMITTERS
        if emit not in OF_THE_WHOLE
    }
    assert _grown(steps) == {}


def _emitted(emit: Emitter, plan: Deployment, graph: CellGraph) -> Iterator[Artifact]:
    return emit(graph, plan)


def _of_three_sizes(spec: Callable[[int], str], first: int, folder: Path) -> list[Cell]:
    """Return cells of a size, of twice and of four times that."""
    cells = []
    first = 3 if spec is of_groups else first  # goals take long to find
    for size in (first, 2 * first, 4 * first):
        (folder / "cell.yaml").write_text(spec(size), encoding="utf-8")
        checked = check(folder / "cell.yaml")
        assert checked.ok, [each.message for each in checked if each.severity is Severity.ERROR]
        cells.append(there(checked.graph).cell)
    return cells


def _grown(steps: dict[str, list[int]]) -> dict[str, tuple[int, int]]:
    """Return what grew with the square; the constant part drops out of three sizes.

    Twice the things that are added are twice the steps, or four times.
    """
    grown = {name: (twice - once, fourfold - twice) for name, (once, twice, fourfold) in steps.items()}
    return {name: added for name, added in grown.items() if added[1] > _TWICE * added[0] + 100}
