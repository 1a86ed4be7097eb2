"""What a fault hits and what it waits for is bound, and told in one line where it does not exist."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.cell.motion import Fault, Rehearsal, StepEvent
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.faults import FaultKind
from tests.cells import linked, linking, spec_text, written


def _written(folder: Path, rehearsal: str) -> Path:
    head, rest = spec_text("ur5e_pick").split("\nrehearsals:", 1)
    comment, others = rest.split("\n", 1)
    return written(folder, f"{head}\nrehearsals:{comment}\n  {rehearsal}\n{others}")


def bound(folder: Path, rehearsal: str) -> Rehearsal:
    """Return a rehearsal that is written into the chapter's cell."""
    return linked(_written(folder, rehearsal)).rehearsals[0]


def fault(folder: Path, inject: str) -> Fault:
    """Return the one fault of a rehearsal."""
    (found,) = bound(folder, f"odd: {{use: pick_and_place, inject: {inject}, expect: timeout}}").faults
    return found


def refused(folder: Path, inject: str) -> Diagnostic:
    """Return the one thing that is wrong with a fault."""
    rehearsals = f"odd: {{use: pick_and_place, inject: {inject}, expect: timeout}}"
    (problem,) = linking(_written(folder, rehearsals)).diagnostics
    return problem


@pytest.mark.parametrize(
    ("inject", "kind", "name", "field", "value"),
    [
        ("{jump_clock: control_pc, by: -250 ms, at: 1 s}", "jump_clock", "control_pc", "amount", -0.25),
        ("{jump_clock: camera, by: 1 s, at: 1 s}", "jump_clock", "camera", "amount", 1.0),
        ("{slow: arm/elbow_joint, to: 180 deg/s, at: 1 s}", "slow", "arm_elbow_joint", "amount", 3.141592653589793),
        ("{displace: arm/elbow_joint, by: 0.3 rad, at: 1 s}", "displace", "arm_elbow_joint", "amount", 0.3),
        ("{scale_speed: arm, to: 25 %, at: 1 s}", "scale_speed", "arm", "amount", 0.25),
        ("{delay: camera, by: 300 ms, at: 1 s}", "delay", "camera", "amount", 0.3),
        ("{skip_cycles: 7, at: 1 s}", "skip_cycles", "", "cycles", 7),
        ("{restart_driver: arm, at: 1 s, lasting: 2 s}", "restart_driver", "arm", "lasting_s", 2.0),
        ("{double_frame: camera/color_optical, at: 1 s}", "double_frame", "camera_color_optical_frame", "at_s", 1.0),
        ("{mismatch_qos: /tf, at: 0.5 s}", "mismatch_qos", "/tf", "at_s", 0.5),
    ],
)
def test_fault_is_bound_in_si_units_and_names_of_the_graph(
    tmp_path: Path, inject: str, kind: str, name: str, field: str, value: float
) -> None:
    found = fault(tmp_path, inject)
    assert (found.kind, found.name, getattr(found, field)) == (kind, name, value)


def test_event_takes_the_place_of_a_time(tmp_path: Path) -> None:
    found = fault(tmp_path, "{freeze: camera, at: {step: 3, when: accepted, after: 100 ms}}")
    assert (found.at_s, found.event) == (None, StepEvent(3, "accepted", 0.1))


def test_event_without_more_is_the_start_of_the_step(tmp_path: Path) -> None:
    assert fault(tmp_path, "{freeze: camera, at: {step: 2}}").event == StepEvent(2, "started", 0.0)


def test_acknowledge_step_names_who_acknowledges(tmp_path: Path) -> None:
    found = bound(tmp_path, "odd: {steps: [move: home, acknowledge: operator]}")
    assert [(step.kind, step.name) for step in found.steps] == [("move", "home"), ("acknowledge", "operator")]


@pytest.mark.parametrize(
    ("inject", "code", "message", "help_"),
    [
        ("{freeze: camra, at: 1 s}", "unknown-device", "there is no camera or device with joints `camra`", "`camera`"),
        ("{freeze: nobody, at: 1 s}", "unknown-device", "`nobody`", "use one of the cameras or devices with joints of"),
        ("{jump_clock: contrl_pc, by: 1 s, at: 1 s}", "unknown-clock", "there is no clock `contrl_pc`", "`control_pc`"),
        ("{mismatch_qos: /object_pos, at: 1 s}", "unknown-interface", "no interface `/object_pos`", "`/object_pose`"),
        ("{unresponsive: movegroup, at: 1 s}", "unknown-node", "there is no server `movegroup`", "`move_group`"),
        ("{second_commander: joint_states, at: 1 s}", "unknown-controller", "no controller with an action", ""),
        (
            "{scale_speed: gripper, to: 0 %, at: 1 s}",
            "unknown-device",
            "no device with speed scaling `gripper`",
            "`arm`",
        ),
        (
            "{stale_set_points: camera, at: 1 s}",
            "unknown-device",
            "there is no device with a program that set points pass through `camera`",
            "one of the devices with a program that set points pass through of this cell: `arm`",
        ),
        ("{wrong_payload: gripper, at: 1 s}", "unknown-device", "there is no arm `gripper`", ""),
        ("{switch: to_efort, at: 1 s}", "unknown-controller", "there is no switch or controller `to_efort`", ""),
        ("{freeze: camera, at: {step: 8}}", "event-never-comes", "there is no step 8: the rehearsal has 7", "1 to 7"),
        (
            "{freeze: camera, at: {step: 2, when: moving}}",
            "event-never-comes",
            "step 2 is a `detect`, which sends no goal, so that it is never `moving`",
            "1, 3, 4, 5, 6, 7",
        ),
        (
            "{freeze: camera, at: {step: 3, when: acepted}}",
            "not-a-choice",
            "at.when` must be one of its choices, got the text `acepted`",
            "`accepted`",
        ),
        ("{freeze: camera, at: {stp: 3}}", "unknown-key", "has no key `stp`", "`step`"),
        ("{freeze: camera, at: 3}", "missing-unit", "with its unit", "`s`"),
        ("{emergncy_stop: arm, at: 1 s}", "fault-kind-missing", "has none of the keys", "`emergency_stop`"),
        ("{slow: arm/elbow_joint, at: 1 s}", "missing-key", "has no `to`", "its speed"),
    ],
)
def test_fault_that_cannot_happen_is_reported_with_what_can(
    tmp_path: Path, inject: str, code: str, message: str, help_: str
) -> None:
    found = refused(tmp_path, inject)
    assert found.code == code
    assert message in found.message
    assert help_ in found.help


@pytest.mark.parametrize("kind", [kind for kind in FaultKind if kind not in ("cancel", "skip_cycles")])
def test_a_name_that_is_not_in_the_cell_is_reported_for_every_fault(tmp_path: Path, kind: FaultKind) -> None:
    by = "" if kind.by is None else f", {kind.by.amount.key}: {kind.by.example}"
    found = refused(tmp_path, f"{{{kind}: zzz{by}, at: 1 s}}")
    assert (found.code.partition("-")[0], found.yaml_path[-1]) == ("unknown", kind)
    assert f"there is no {kind.hits.target.noun} `zzz`" in found.message


def test_the_only_gripper_needs_no_name(tmp_path: Path) -> None:
    (step,) = bound(tmp_path, "odd: {steps: [{grip: open}], expect: succeeded}").steps
    assert (step.kind, step.name, step.command) == ("grip", "gripper", "open")


def test_a_gripper_that_is_not_there_is_named_where_it_is_written(tmp_path: Path) -> None:
    path = _written(tmp_path, "odd: {steps: [{grip: open, device: griper}], expect: succeeded}")
    (problem,) = linking(path).diagnostics
    assert (problem.code, problem.help) == ("unknown-device", "did you mean `gripper`?")
    assert problem.yaml_path == ("rehearsals", "odd", "steps", 0, "device")
    line = path.read_text(encoding="utf-8").splitlines()[problem.span.line - 1]
    assert line[problem.span.column - 1 :].startswith("griper")
