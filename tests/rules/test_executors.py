"""How long a sample waits in a node follows from executor, groups and times; figures by hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.graph.data_flow import age_chains
from cellc.compiler.graph.executors import Response, response
from tests.cells import diagnose, linked, spec_text, written

IMAGE, POSE = "/camera/color/image_raw", "/object_pose"
_NODE = "lifecycle: true, host: control_pc, owner: perception"


def _spec(tmp_path: Path, said: str, *edits: tuple[str, str]) -> Path:
    text = spec_text("ur5e_pick").replace(_NODE, f"{_NODE}, {said}", 1)
    for before, after in edits:
        assert before in text
        text = text.replace(before, after, 1)
    return written(tmp_path, text)


def _response(spec: Path) -> Response:
    cell = linked(spec)
    return response(cell, next(node for node in cell.nodes if node.name == "perception"), IMAGE)


_TWO = f"callbacks: {{{IMAGE}: {{takes: 10 ms}}, publish: {{takes: 5 ms, period: 50 ms}}}}"


@pytest.mark.parametrize(
    ("said", "bound_s"),
    [
        # Busy for 15 ms at most: both come at once, and neither comes again before.
        (f"executor: single_threaded, {_TWO}", 0.015),
        (f"executor: multi_threaded, threads: 1, {_TWO}", 0.015),
        (f"executor: multi_threaded, threads: 2, {_TWO}", 0.015),
        (f"executor: multi_threaded, threads: 2, {_TWO.replace('10 ms', '10 ms, group: images')}", 0.010),
        # 30 ms each 33.3 ms and 4 ms each 50 ms: busy for 34, then 64, 68, and 98 ms, before either comes again.
        (
            f"executor: multi_threaded, threads: 2, {_TWO.replace('10 ms', '30 ms').replace('5 ms,', '4 ms,')}",
            0.098,
        ),
    ],
)
def test_bound_of_a_response(said: str, bound_s: float, tmp_path: Path) -> None:
    assert _response(_spec(tmp_path, said)).bound_s == pytest.approx(bound_s)


@pytest.mark.parametrize(
    ("said", "why"),
    [
        (_TWO, "`executor` is not stated"),
        (f"executor: events, {_TWO}", "an events executor takes events as they come, any number of one callback"),
        ("executor: single_threaded", f"`takes` of `{IMAGE}` is not stated"),
        (f"executor: single_threaded, {_TWO.replace('takes: 5 ms, ', '')}", "`takes` of `publish` is not stated"),
        (f"executor: multi_threaded, {_TWO}", "a thread for each of 1 callback groups is not stated"),
        (
            f"executor: multi_threaded, threads: 2, {_TWO.replace('10 ms', '30 ms').replace('takes: 5', 'takes: 20')}",
            "its group has more to execute than time",
        ),
    ],
)
def test_unknown_says_why(said: str, why: str, tmp_path: Path) -> None:
    assert _response(_spec(tmp_path, said)) == Response(None, why)


_SERVED = (
    "\ninterfaces:\n",
    "\ninterfaces:\n  /reset: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s,"
    " on_timeout: error}\n",
)


@pytest.mark.parametrize(
    ("takes", "depth", "bound_s"),
    [
        ("10 ms", 1, 2 * 0.015),  # of a set that was just missed, and as much in the next
        ("10 ms", 3, 2 * 0.015),  # read faster than it is filled
        ("30 ms", 1, 2 * 0.035),
        ("30 ms", 3, 4 * 0.035),  # two may be before it in the queue
    ],
)
def test_without_a_rate_of_all_sets_of_ready_callbacks_are_counted(
    takes: str, depth: int, bound_s: float, tmp_path: Path
) -> None:
    said = f"executor: single_threaded, callbacks: {{{IMAGE}: {{takes: {takes}}}, /reset: {{takes: 5 ms}}}}"
    plain = "{perception: {reliability: best_effort, depth: 1}}"
    deep = (plain, plain.replace("depth: 1", f"depth: {depth}"))
    assert _response(_spec(tmp_path, said, _SERVED, deep)).bound_s == pytest.approx(bound_s)


def test_the_node_between_two_topics_is_in_the_chain(tmp_path: Path) -> None:
    chains = age_chains(linked(_spec(tmp_path, f"executor: single_threaded, {_TWO}")))
    assert [share.topic for share in chains[IMAGE]] == [IMAGE, "perception"]
    assert [share.topic for share in chains[POSE]] == [IMAGE, "perception", POSE]
    # 33.3 + 8 ms of the camera, 15 ms in the node, a period of 100 ms.
    assert sum(share.total_s for share in chains[POSE]) == pytest.approx(0.15633, abs=1e-5)


@pytest.mark.parametrize(("age", "reported"), [("157 ms", False), ("156 ms", True)])
def test_the_budget_counts_what_executors_take(age: str, reported: bool, tmp_path: Path) -> None:
    said = f"executor: single_threaded, {_TWO}"
    spec = _spec(tmp_path, said, ("max_age: 200 ms", f"max_age: {age}"))
    codes = {finding.code for finding in diagnose(spec)}
    assert ("age-budget-exceeded" in codes) is reported


@pytest.mark.parametrize(
    ("said", "deadlock"),
    [
        ("executor: single_threaded, callbacks: {ROW}", True),
        ("executor: events, callbacks: {ROW}", True),
        ("callbacks: {ROW}", True),  # the default group is mutually exclusive in any executor
        ("executor: multi_threaded, threads: 1, callbacks: {ROW, /move_action: {group: moves}}", True),
        ("executor: multi_threaded, threads: 2, callbacks: {ROW, /move_action: {group: moves}}", False),
        ("executor: multi_threaded, threads: 2, callbacks: {ROW, /move_action: {}}", True),
    ],
)
def test_who_waits_for_itself(said: str, deadlock: bool, tmp_path: Path) -> None:
    said = said.replace("ROW", "/object_pose: {takes: 1 ms, waits_for: [/move_action]}")
    node = "task: {run: cell_tasks/pick_place, host: control_pc, owner: integration}"
    text = spec_text("ur5e_pick").replace(node, f"{node[:-1]}, {said}}}", 1)
    codes = {finding.code for finding in diagnose(written(tmp_path, text))}
    assert ("callback-waits-for-itself" in codes) is deadlock
