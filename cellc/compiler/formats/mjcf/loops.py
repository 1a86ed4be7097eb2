"""What moves the joints, and who holds them against gravity: the control law of the real target, and defaults.

A joint behind a spring has the figures of the spring. A position loop of a device's own has no public figures: the one
here is critically damped at ``LOOP_RAD_S`` with the robot stretched out, and faster otherwise. MuJoCo brakes the motion
itself, so that a set point that moves is followed with a lag of 2 / ``LOOP_RAD_S``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device, DeviceJoint, Gripper
from cellc.compiler.formats.mjcf.elements import is_possible, numbers
from cellc.compiler.formats.mjcf.tree import Body
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.graph.control_laws import control_laws
from cellc.contract.control_law import ControlLaw
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Gravity, Loop
from cellc.robot.description.model import Inertial, Joint

LOOP_RAD_S = 100.0
"""Of a position loop without public figures."""
_FULL_FORCE = 0.1
"""Share of the way of jaws before their command at which they press with all their force."""
_STUCK = {"solreffriction": "0.004 1", "solimpfriction": "0.9999 0.9999 0.001"}
"""Friction of MuJoCo lets a joint that it holds creep: with its usual figures by millirads in a second."""
_LIGHTEST = 1e-6
"""kg or kg m^2 that a joint carries at least."""


@dataclass(frozen=True, slots=True)
class Actuator:
    """A position servo: N m or N for each rad or m from the command, and for each rad/s or m/s; ``force`` at most.

    Its figures are ``assumed`` where none are stated; it ``grips`` where it moves fingers.
    """

    joint: DeviceJoint
    kp: float
    kv: float
    force: float | None
    assumed: bool
    grips: bool = False

    def attributes(self) -> dict[str, str]:
        """Return its attributes in MJCF; it has the name of its joint."""
        joint, found = self.joint, {"name": self.joint.name, "joint": self.joint.name}
        found |= {"kp": shortest(self.kp), "kv": shortest(self.kv)}
        if joint.type != "continuous" and joint.lower is not None and joint.upper is not None:
            found["ctrlrange"] = numbers((joint.lower, max(joint.upper, joint.lower + 1e-6)))
        return found | ({} if self.force is None else {"forcerange": numbers((-self.force, self.force))})


class Loops:
    """The actuators of a cell, and the share of its weight that each link need not be held with."""

    def __init__(self, cell: Cell, world: Body) -> None:
        """Decide them for a cell and its bodies."""
        self.laws = control_laws(cell)
        self._cell = cell
        self._carried = _carried(world)
        self._compensation = {name: share for device in cell.devices for name, share in self._shares(device)}

    def actuators(self, device: Device) -> Iterator[Actuator]:
        """Yield an actuator for each joint of a device that is commanded and follows no other."""
        law = self.laws.get(device.name)
        for joint in device.actuated_joints:
            if joint.mimics is None:
                yield self._actuator(device, joint, law)

    def compensated(self, device: Device | None) -> float:
        """Return the share of the weight of a device's links that a robot's own controller takes, that it tells of."""
        return 0.0 if device is None else self._compensation.get(device.name, 0.0)

    def driven(self, device: Device, joint: str) -> dict[str, str]:
        """Return what the drive of a joint adds to it, as attributes of MJCF."""
        drives, names = device.control.drives, [each.name for each in driven_joints(device)]
        if drives is None or joint not in names:
            return {}
        number = names.index(joint)
        figures = {"armature": drives.armature, "damping": drives.damping, "frictionloss": drives.friction}
        found = {key: shortest(of[number]) for key, of in figures.items() if number < len(of)}
        return found | (_STUCK if "frictionloss" in found else {})

    def finger_damping(self, device: Device, joint: str) -> float | None:
        """Return what lets a gripper run at its own speed under all its force, N m s/rad; None of other joints."""
        gripper = device.gripper
        if gripper is None or gripper.joint != joint or not gripper.max_velocity:
            return None
        return _digits(_joint_force(gripper) / gripper.max_velocity, 6)

    def finger_armature(self, device: Device, joint: str) -> float | None:
        """Return what the drive of a gripper adds to a joint that it moves, kg m^2 or kg; None of other joints.

        Its loop is as fast as any other: fingers without the inertia of their motor would bounce off a part. All joints
        that move together share it, each by the square of its factor.
        """
        gripper, moved = device.gripper, self._moved(device)
        if gripper is None or joint not in moved:
            return None
        return _digits(self._stiffness(gripper) / LOOP_RAD_S**2 / sum(factor**2 for factor in moved.values()))

    def _moved(self, device: Device) -> dict[str, float]:
        """Return the joints that the drive of a gripper moves, with their factors."""
        leader = "" if device.gripper is None else device.gripper.joint
        joints = device.body.description.with_direct_mimics().joints
        follow = {each.name: each.mimic.multiplier for each in joints if each.mimic and each.mimic.joint == leader}
        return {leader: 1.0, **follow}

    def _stiffness(self, gripper: Gripper) -> float:
        return _digits(_joint_force(gripper) / (_FULL_FORCE * abs(gripper.open - gripper.closed)), 6)

    def _actuator(self, device: Device, joint: DeviceJoint, law: ControlLaw | None) -> Actuator:
        spring = law.joints.get(joint.name) if law is not None and law.loop is Loop.SPRING else None
        if spring is not None:
            return Actuator(joint, spring.stiffness, spring.damping, joint.effort or None, assumed=False)
        carried = self._leading(device, joint.name)
        if device.gripper is not None and device.gripper.joint == joint.name:
            force = _digits(_joint_force(device.gripper), 6)
            kp = self._stiffness(device.gripper)
            return Actuator(joint, kp, _digits(2.0 * math.sqrt(kp * carried)), force, assumed=True, grips=True)
        kp = _digits(LOOP_RAD_S**2 * carried)
        return Actuator(joint, kp, _digits(2.0 * kp / LOOP_RAD_S, 6), joint.effort or None, assumed=True)

    def _leading(self, device: Device, name: str) -> float:
        """Return what a joint carries with all that follow it, each by the square of its factor."""
        joints = device.body.description.with_direct_mimics().joints
        follow = ((each.name, each.mimic) for each in joints if each.mimic is not None and each.mimic.joint == name)
        more = sum(mimic.multiplier**2 * self._carried.get(follower, 0.0) for follower, mimic in follow)
        return max(self._carried.get(name, 0.0) + more, _LIGHTEST)

    def _shares(self, device: Device) -> Iterator[tuple[str, float]]:
        """Yield a device whose joints are held on a path, and what it carries, until something else is held."""
        law = self.laws.get(device.name)
        if law is None:
            return
        of_tools = 1.0
        if law.loop is Loop.SPRING:
            if law.gravity is not Gravity.COMPENSATED:
                return
            tool_kg, payload = self._cell.carried_mass_kg(device), device.robot.payload
            of_tools = 0.0 if payload is None or tool_kg <= 0.0 else round(payload.mass_kg / tool_kg, 6)
        yield device.name, 1.0
        yield from ((name, of_tools) for name in _tools(self._cell, device) if name not in self.laws)


def driven_joints(device: Device) -> tuple[DeviceJoint, ...]:
    """Return the joints of a device that motors of its own turn, apart from its fingers."""
    finger = "" if device.gripper is None else device.gripper.joint
    return tuple(joint for joint in device.actuated_joints if joint.mimics is None and joint.name != finger)


def _tools(cell: Cell, device: Device) -> Iterator[str]:
    seen, waiting = {device.name}, list(device.mount.carries)
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            yield name
            waiting += cell.device(name).mount.carries


def _joint_force(gripper: Gripper) -> float:
    """Return what the joint of a gripper gives for the force of its jaws, N m or N, over the whole way of both."""
    stated = gripper.max_force if gripper.grip_force is None else gripper.grip_force
    way = abs(gripper.open - gripper.closed)
    return stated * gripper.stroke_m / way if way > 0.0 else stated


def _digits(value: float, digits: int = 2) -> float:
    """Return an assumed figure: of two digits few changes of a mass change any, and no machine does."""
    return float(f"{value:.{digits}g}")


def _carried(world: Body) -> dict[str, float]:
    """Return the largest moment of inertia that each joint may carry, or the mass where it slides."""
    found: dict[str, float] = {}
    joints: list[tuple[Joint, float]] = []

    def add(body: Body) -> None:
        before = list(joints)
        away = math.hypot(*body.pose.position) + _slides_by(body)
        joints[:] = [(joint, distance + away) for joint, distance in joints]
        if body.joint is not None:
            joints.append((body.joint, 0.0))
        for placed in body.placed:
            if placed.link is not None and placed.link.inertial is not None and is_possible(placed.link.inertial):
                for joint, distance in joints:
                    amount = _about(joint, distance + math.hypot(*placed.pose.position), placed.link.inertial)
                    found[joint.name] = found.get(joint.name, 0.0) + amount
        for other in body.bodies:
            add(other)
        joints[:] = before

    add(world)
    return found


def _slides_by(body: Body) -> float:
    if body.joint is None or not body.joint.slides or body.limits is None:
        return 0.0
    return max(abs(body.limits.lower or 0.0), abs(body.limits.upper or 0.0))


def _about(joint: Joint, distance: float, body: Inertial) -> float:
    """Return the most that a body has about a joint; about any axis of its own that is half the trace of its tensor."""
    if joint.slides:
        return body.mass
    lever = distance + math.hypot(*body.pose.position)
    return 0.5 * (body.ixx + body.iyy + body.izz) + body.mass * lever**2


def unknown_laws(laws: Mapping[str, ControlLaw]) -> Iterator[tuple[str, str]]:
    """Yield each device whose law is not known, and why."""
    yield from ((name, law.because) for name, law in laws.items() if law.loop is Loop.UNKNOWN)
