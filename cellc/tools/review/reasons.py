"""Why a change of a value is dangerous, by the pattern of its row, where the row itself does not say so."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from cellc.contract.contract import Contract
from cellc.contract.grading import OTHER_LOAD
from cellc.contract.vocabulary import UNKNOWN, Gravity, Loop
from cellc.tools.review.facts import Facts
from cellc.tools.review.leaves import Delta
from cellc.tools.review.rules import Row

_REASONS: Mapping[str, str] = {
    "contract approvals safety": "somebody else approves what protects people",
    "spec safety stop independent_of": "the stop may fail together with what it must stop",
    "spec safety stop evidence": "nothing proves that the stop works",
    "interface {interface} kind": "an end that does not change with it receives nothing",
    "interface {interface} type": "an end that does not change with it receives nothing",
    "interface {interface} frame": "its coordinates are read in another frame",
    "interface {interface} unit": "its figures are read in another unit",
    "interface {interface} owner": "it has no owner",
    "interface {interface} on_stale": "what moves with old data is handled otherwise",
    "interface {interface} on_timeout": "what moves is handled otherwise after a timeout",
    "controller {controller} plugin": "another program commands the joints",
    "controller {controller} behavior": "the joints are commanded otherwise",
    "controller {controller} targets": "it is loaded where it was not, or no longer where it was",
    "controller {controller} joints": "commands reach other joints",
    "controller {controller} on_violation": "a joint out of its tolerance is handled otherwise",
    "manager {manager} switches {switch} ...": "other controllers hold the joints after the switch",
    "step real {step} proof": "the step no longer waits for it",
    "step real {step} effect": "nothing checks any more that the step did it",
    "contract version_tuple {part}": "the version that runs is not known",
    "contract root_frame": "every pose in the root frame is read from another place",
    "contract calibrations {calibration} revision": "an older measurement is used again",
    "contract calibrations {calibration} owner": "it has no owner",
    "contract frames {frame} calibration": "the pose rests on no measurement",
    "contract devices {device} model": "its body and behavior are those of another device",
    "contract devices {device} architecture": "commands reach the joints by another path",
    "contract groups {group} tip_frame": "another point is moved to each goal",
    "contract groups {group} ...": "other joints move to the goal",
    "contract goals {goal} group": "other joints move to the goal",
    "contract responsibilities {responsibility}": "it has no owner",
    "contract approvals {area}": "changes of the area have no approver",
    "contract safety stop_authority": "another device decides on the stop, and no test of it counts yet",
    "contract safety stop_path": "by another path the stop may come later, or not at all",
    "contract safety recovery_states": "motion may resume from such a state without a recovery",
    "contract safety acknowledge": "somebody else lets motion resume",
    "contract safety on_reconnect": "an old goal may resume by itself",
    "contract attempt_fields": "an attempt can no longer be explained from its record",
    "spec safety stop ...": "the stop may fail together with what it must stop, or nothing proves it",
    "spec safety recovery states": "motion may resume from such a state without a recovery",
    "spec safety recovery owner": "somebody else is responsible for what lets motion resume",
    "spec safety recovery observer": "somebody else sees why motion stopped",
    "spec safety recovery ...": "motion may resume without a person who sees why it stopped",
    "spec safety risk_assessment ...": "more may be allowed than the assessment covers",
    "spec nodes {node} owner": "it has no owner",
    "spec bringup gates": "what the gate proves is proved nowhere",
    "frame {frame} reference_points": "fewer points show that the frame is still where it was measured",
    "device {device} payload_limit_kg": "a load that was allowed may be too heavy",
    "watch {watch} ...": "controllers may stay active though their device stopped",
    "check thresholds {device}": "a contact is noticed at another force",
    "check joint_impedance {device}": "the joint yields by another amount, or swings",
    "check tool_impedance {device}": "the tool yields by another amount, or presses harder",
    "spec surroundings {part} none": "an arm may meet what this says is not there",
    "spec surroundings {part} ...": "an arm may meet what is no longer stated",
    "file config/frames.yaml calibrations {calibration} residual_m": "the same measurement is said to be less exact",
    "real joint {joint} type": "the joint moves otherwise, or not at all",
    "real joint {joint} mimic ...": "the joint follows another one, or otherwise",
    "parameters {_} {node} ros__parameters goal_tolerance": "the joint may end further from its goal",
    "parameters {_} {node} ros__parameters enforce_command_limits": "commands beyond the limits are handled otherwise",
    "parameters {_} {node} ros__parameters hardware_components_initial_state ...": "hardware is enabled earlier",
    "real hardware {component} plugin": "another driver commands the hardware",
    "mock hardware {component} plugin": "what is started as the mock may reach hardware",
    "matrix {part}": "nothing says any more that the versions work together",
    "spec targets {target} {what}": "the target starts something else",
    "spec mock_statements ...": "what is started as the mock may reach hardware",
    "step real {step} request parts": "another version may run unnoticed",
    "step real {step} after": "it may start before what it rests on",
    "step real {step} request controllers": "other controllers may move the hardware",
    "step real {step} observed controllers": "what it published is no longer there",
    "step real {step} ...": "hardware is asked for something else",
    "spec bringup commissioning stages": "a stage before full speed is gone",
    "file config/uncertainty.json tolerances {goal}": "a worse end counts as a success",
    "file config/uncertainty.json expected {rehearsal} success": "fewer successes suffice",
    "file config/uncertainty.json expected {rehearsal} confidence": "the success rate may rest on chance",
}


def with_reason(row: Row) -> Row:
    """Return a row with the reason for its danger: that of its field, else the one above."""
    return row if row.grade.why else Row(row.pattern, row.grade._replace(why=_REASONS.get(row.pattern, "")))


def as_held(why: str, device: str, contract: Contract) -> str:
    """Return the reason of another load with what it does to a device, by what holds its joints."""
    law = contract.devices[device].law if why == OTHER_LOAD and device in contract.devices else None
    if law is None:
        return why
    if law.loop is Loop.POSITION:
        return f"{why}: it stops by itself, or notices a contact later"
    if law.loop is Loop.UNKNOWN:
        return f"{why}: how far the arm sags is not known"
    if law.gravity is Gravity.COMPENSATED:
        return f"{why}: the arm sags, or rises"
    return "the springs of the joints hold another load: the arm droops by another amount"


_RESPONSIBLE = ("contract", "responsibilities")


def owner_without_approval(deltas: Sequence[Delta], sides: tuple[Facts, Facts]) -> str:
    """Return that a new owner approves nothing in the cell, so that changes of it ask somebody else; else nothing."""
    named = [delta for delta in deltas if delta.path[-1] == "owner" or delta.path[:2] == _RESPONSIBLE]
    owners = {str(delta.after) for delta in named if delta.after not in (None, UNKNOWN)}
    approving = {owner for side in sides for owner in side.contract.approvals.values()}
    strangers = sorted(owners - approving)
    return f"{' and '.join(f'`{name}`' for name in strangers)} approves nothing in this cell" if strangers else ""
