"""G1 of the staged promotion gates: axis, limit, TCP, collision and frame of the model, offline.

What a drawing, a marker or the robot itself would have to confirm stays UNKNOWN.
"""

from __future__ import annotations

import hashlib
import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass

from cellc.mock.gates.gate import GateCheck, failed, judged, passed, unknown
from cellc.mock.gates.runs import Testimony

_MOVABLE = ("revolute", "continuous", "prismatic")


@dataclass(frozen=True, slots=True)
class DescribedJoint:
    """A joint as the URDF has it; limits in rad or m, None where there is none.

    Attributes:
        axis_length: length of the axis as written; 1 where none is.
    """

    name: str
    kind: str
    parent: str
    child: str
    axis_length: float
    lower: float | None
    upper: float | None
    velocity: float | None

    @property
    def moves(self) -> bool:
        """Tell whether it has a degree of freedom."""
        return self.kind in _MOVABLE


@dataclass(frozen=True, slots=True)
class Description:
    """Links, joints, and the plugin of each hardware component."""

    links: tuple[str, ...]
    joints: tuple[DescribedJoint, ...]
    plugins: dict[str, str]

    def roots(self) -> tuple[str, ...]:
        """Return the links that no joint carries."""
        carried = {joint.child for joint in self.joints}
        return tuple(link for link in self.links if link not in carried)

    def unreached(self, root: str) -> tuple[str, ...]:
        """Return the links that cannot be reached from a root, cycles included."""
        children: dict[str, list[str]] = {}
        for joint in self.joints:
            children.setdefault(joint.parent, []).append(joint.child)
        reached, waiting = set[str](), [root]
        while waiting:
            link = waiting.pop()
            if link not in reached:
                reached.add(link)
                waiting += children.get(link, [])
        return tuple(link for link in self.links if link not in reached)


def read_description(urdf: str) -> Description:
    """Read a URDF that the mock has loaded before, so that it is known to be well-formed."""
    root = ElementTree.fromstring(urdf)
    return Description(
        links=tuple(link.get("name", "") for link in root.findall("link")),
        joints=tuple(_joints(root)),
        plugins={
            component.get("name", ""): (component.findtext("hardware/plugin") or "").strip()
            for component in root.findall("ros2_control")
        },
    )


def _joints(root: ElementTree.Element) -> Iterator[DescribedJoint]:
    for joint in root.findall("joint"):
        axis, limit = joint.find("axis"), joint.find("limit")
        yield DescribedJoint(
            name=joint.get("name", ""),
            kind=joint.get("type", ""),
            parent=_link(joint, "parent"),
            child=_link(joint, "child"),
            axis_length=1.0 if axis is None else math.hypot(*map(float, axis.get("xyz", "1 0 0").split())),
            lower=_number(limit, "lower"),
            upper=_number(limit, "upper"),
            velocity=_number(limit, "velocity"),
        )


def _link(joint: ElementTree.Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _number(limit: ElementTree.Element | None, name: str) -> float | None:
    text = None if limit is None else limit.get(name)
    return None if text is None else float(text)


_UNIT = 1e-6
"""By which the length of an axis may differ from 1: URDF has six digits of it."""


def model_checks(testimony: Testimony) -> Iterator[GateCheck]:
    """Yield the lines of G1."""
    description = read_description(testimony.folder.urdf)
    yield _generated(testimony)
    yield _one_tree(description)
    yield _axes(description)
    yield unknown("Axes turn as those of the robot do", "a person who compares them with drawing and robot")
    yield _limits(testimony, description)
    yield _tool_points(testimony)
    yield _collision(testimony)
    yield unknown("Collision shapes enclose the real parts", "a person who compares them with drawing and robot")
    yield _frames(testimony)
    for name, frame in testimony.contract.frames.items():
        if frame.calibration is not None:
            text = f"Frame {name} agrees with its physical marker (calibration {frame.calibration})"
            yield unknown(text, "a measurement in the cell")


def _generated(testimony: Testimony) -> GateCheck:
    text = "The package is as it was generated, under one configuration id"
    if testimony.folder.notes:
        return failed(text, testimony.folder.notes)
    digest = hashlib.sha256(testimony.folder.urdf.encode()).hexdigest()
    name = testimony.contract.files.urdf_mock
    return passed(
        text,
        (f"manifest.json: every hash agrees, {testimony.contract.configuration_id}", f"{name}: sha256 {digest[:16]}"),
    )


def _one_tree(description: Description) -> GateCheck:
    text = "The robot description is one tree"
    roots = description.roots()
    if len(roots) != 1:
        return failed(text, [f"roots: {', '.join(roots) or 'none'}"])
    unreached = description.unreached(roots[0])
    if unreached:
        return failed(text, [f"link {link} cannot be reached from {roots[0]}" for link in unreached])
    return passed(text, [f"{len(description.links)} links hang from {roots[0]}"])


def _axes(description: Description) -> GateCheck:
    moving = [joint for joint in description.joints if joint.moves]
    bad = [
        f"the axis of joint {joint.name} has the length {joint.axis_length:g}"
        for joint in moving
        if abs(joint.axis_length - 1.0) > _UNIT
    ]
    good = [f"{len(moving)} moving joints"] if moving else []
    return judged("Axes are of unit length", good, bad, "a joint that moves")


def _limits(testimony: Testimony, description: Description) -> GateCheck:
    """Compare the limits of the cell with those of the description: never wider, and never reversed."""
    described = {joint.name: joint for joint in description.joints}
    limits = testimony.contract.joint_limits
    bad = [problem for name in limits for problem in _wider(testimony, name, described.get(name))]
    good = [f"{len(limits)} joints: position and velocity limits of contract and description agree"] if limits else []
    return judged("Limits of the cell are within those of the description", good, bad, "a joint with limits")


def _wider(testimony: Testimony, name: str, described: DescribedJoint | None) -> Iterator[str]:
    limit = testimony.contract.joint_limits[name]
    if described is None:
        yield f"joint {name} is not in the description"
        return
    if limit.lower is not None and limit.upper is not None and limit.lower > limit.upper:
        yield f"joint {name}: lower {limit.lower:g} is above upper {limit.upper:g}"
    if described.velocity is not None and limit.velocity > described.velocity:
        yield f"joint {name}: velocity {limit.velocity:g}, {described.velocity:g} in the description"
    if described.kind == "continuous":
        return
    if described.lower is not None and (limit.lower is None or limit.lower < described.lower):
        yield f"joint {name}: lower {limit.lower}, {described.lower:g} in the description"
    if described.upper is not None and (limit.upper is None or limit.upper > described.upper):
        yield f"joint {name}: upper {limit.upper}, {described.upper:g} in the description"


def _tool_points(testimony: Testimony) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for name, group in testimony.contract.groups.items():
        known = group.tip_frame in testimony.contract.frames
        (good if known else bad).append(f"group {name} places frame {group.tip_frame}" + ("" if known else ", unknown"))
    return judged("Each group has its TCP in the tree", good, bad, "a planning group")


def _collision(testimony: Testimony) -> GateCheck:
    """Judge by the plans of undisturbed runs, each of which was checked against the scene."""
    good: list[str] = []
    bad: list[str] = []
    for witness in testimony.undisturbed():
        for attempt in witness.result.attempts:
            if attempt.plan_result == "success":
                good.append(f"{witness.name}: {attempt.step}")
            elif attempt.plan_result is not None:
                bad.append(f"{witness.name}: {attempt.step}: {attempt.plan_result}")
    text = "Every motion of the rehearsals is planned free of collision"
    return judged(text, good, bad, "a rehearsal without faults that moves")


def _frames(testimony: Testimony) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for witness in testimony.undisturbed():
        observe = [stage for stage in witness.result.bringup if stage.stage == "observe"]
        bad += [f"{witness.name}: {problem}" for stage in observe for problem in stage.problems]
        bad += [f"{witness.name}: {finding}" for finding in witness.result.findings if "two authorities" in finding]
        if observe and all(stage.passed for stage in observe):
            good.append(f"{witness.name}: all fixed frames and links were looked up at bring-up")
    return judged("Every frame is found and has one authority", good, bad, "a rehearsal without faults")
