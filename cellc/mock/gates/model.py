"""G1 of the staged promotion gates: axis, limit, TCP, collision and frame of the model, offline.

What a drawing, a marker or the robot itself would have to confirm stays UNKNOWN.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator

from cellc.mock.gates.gate import GateCheck, failed, judged, passed, unknown
from cellc.mock.gates.runs import GateEvidence
from cellc.robot.description.model import Description, Joint, JointLimit

_UNIT = 1e-6
"""By which the length of an axis may differ from 1: URDF has six digits of it."""


def model_checks(evidence: GateEvidence) -> Iterator[GateCheck]:
    """Yield the lines of G1."""
    description = evidence.folder.description
    yield _generated(evidence)
    yield _one_tree(description)
    yield _axes(description)
    yield unknown("Axes turn as those of the robot do", "a person who compares them with drawing and robot")
    yield _limits(evidence, description)
    yield _tool_points(evidence)
    yield _collision(evidence)
    yield unknown("Collision shapes enclose the real parts", "a person who compares them with drawing and robot")
    yield _frames(evidence)
    for name, frame in evidence.contract.frames.items():
        if frame.calibration is not None:
            text = f"Frame {name} agrees with its physical marker (calibration {frame.calibration})"
            yield unknown(text, "a measurement in the cell")


def _generated(evidence: GateEvidence) -> GateCheck:
    text = "The package is as it was generated, under one configuration ID"
    if evidence.folder.notes:
        return failed(text, evidence.folder.notes)
    digest = hashlib.sha256(evidence.folder.urdf.encode()).hexdigest()
    name = evidence.contract.files.urdf_mock
    return passed(
        text,
        (f"manifest.json: every hash agrees, {evidence.contract.configuration_id}", f"{name}: sha256 {digest[:16]}"),
    )


def _one_tree(description: Description) -> GateCheck:
    text = "The robot description is one tree"
    roots = description.roots()
    if len(roots) != 1:
        return failed(text, [f"roots: {', '.join(roots) or 'none'}"])
    unreached = description.unreached(roots[0])
    if unreached:
        return failed(text, [f"link {link} cannot be reached from {roots[0]}" for link in unreached])
    return passed(text, [f"{len(description.links)} links below {roots[0]}"])


def _axes(description: Description) -> GateCheck:
    moving = [joint for joint in description.joints if joint.movable]
    lengths = {joint.name: math.hypot(*joint.axis) for joint in moving}
    bad = [
        f"the axis of joint {name} has the length {length:g}"
        for name, length in lengths.items()
        if abs(length - 1.0) > _UNIT
    ]
    good = [f"{len(moving)} moving joints"] if moving else []
    return judged("Axes are of unit length", good, bad, "a joint that moves")


def _limits(evidence: GateEvidence, description: Description) -> GateCheck:
    """Compare the limits of the cell with those of the description: never wider, and never reversed."""
    described = {joint.name: joint for joint in description.joints}
    limits = evidence.contract.joint_limits
    bad = [problem for name in limits for problem in _wider(evidence, name, described.get(name))]
    good = [f"{len(limits)} joints: position and velocity limits of contract and description agree"] if limits else []
    return judged("Limits of the cell are within those of the description", good, bad, "a joint with limits")


def _wider(evidence: GateEvidence, name: str, joint: Joint | None) -> Iterator[str]:
    limit = evidence.contract.joint_limits[name]
    if joint is None:
        yield f"joint {name} is not in the description"
        return
    described = joint.limit or JointLimit(None, None, None, None)
    if limit.lower is not None and limit.upper is not None and limit.lower > limit.upper:
        yield f"joint {name}: lower {limit.lower:g} is above upper {limit.upper:g}"
    if described.velocity is not None and limit.velocity > described.velocity:
        yield f"joint {name}: velocity {limit.velocity:g}, {described.velocity:g} in the description"
    if joint.type == "continuous":
        return
    if described.lower is not None and (limit.lower is None or limit.lower < described.lower):
        yield f"joint {name}: lower {limit.lower}, {described.lower:g} in the description"
    if described.upper is not None and (limit.upper is None or limit.upper > described.upper):
        yield f"joint {name}: upper {limit.upper}, {described.upper:g} in the description"


def _tool_points(evidence: GateEvidence) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for name, group in evidence.contract.groups.items():
        known = group.tip_frame in evidence.contract.frames
        (good if known else bad).append(f"group {name} places frame {group.tip_frame}" + ("" if known else ", unknown"))
    return judged("Each group has its TCP in the tree", good, bad, "a planning group")


def _collision(evidence: GateEvidence) -> GateCheck:
    """Judge by the plans of undisturbed runs, each of which was checked against the scene."""
    good: list[str] = []
    bad: list[str] = []
    for run in evidence.undisturbed():
        for attempt in run.result.attempts:
            if attempt.plan_result == "success":
                good.append(f"{run.name}: {attempt.step}")
            elif attempt.plan_result is not None:
                bad.append(f"{run.name}: {attempt.step}: {attempt.plan_result}")
    bad += [f"{link}: its mesh is missing, so planning ignored the link" for link in _unseen(evidence)]
    text = "Every motion of the rehearsals is planned free of collision"
    return judged(text, good, bad, "a rehearsal without faults that moves")


def _unseen(evidence: GateEvidence) -> dict[str, None]:
    return dict.fromkeys(link for run in evidence.undisturbed() for link in run.result.unseen)


def _frames(evidence: GateEvidence) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for run in evidence.undisturbed():
        observe = [stage for stage in run.result.bringup if stage.stage == "observe"]
        bad += [f"{run.name}: {problem}" for stage in observe for problem in stage.problems]
        bad += [f"{run.name}: {finding}" for finding in run.result.findings if "two authorities" in finding]
        if observe and all(stage.passed for stage in observe):
            good.append(f"{run.name}: all fixed frames and links were looked up at bring-up")
    return judged("Every frame is found and has one authority", good, bad, "a rehearsal without faults")
