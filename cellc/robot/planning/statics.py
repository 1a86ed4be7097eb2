"""What holds a robot still: the torques and forces of its joints against gravity, and where springs let it stand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pinocchio

from cellc.contract.control_law import ControlLaw, LinkMass
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Gravity
from cellc.robot.planning.model import PinModel, RobotModel
from cellc.robot.planning.problem import Array

_STEPS = 60
"""Of the search for a balance; each brings it nearer by the share of the stiffness that gravity changes by."""
_STILL = 1e-12
_FARTHEST = 1.0
"""Rad or m from the command beyond which joints are held by nothing: a spring so weak gives way."""


class Weights:
    """The torques and forces of joints against the weight of a robot, or of some masses on its links alone."""

    def __init__(
        self,
        robot: RobotModel,
        joints: Sequence[str],
        masses: Sequence[LinkMass] = (),
        *,
        others: Mapping[str, float] | None = None,
        robot_too: bool = True,
    ) -> None:
        """Bind the joints that are asked about, in their order.

        Args:
            masses: what links have besides their own mass; a mass below zero is taken away.
            others: where the other joints are, rad or m.
            robot_too: whether the robot's own links weigh.

        Raises:
            ModelError: a joint or link does not exist.
        """
        self.joints = tuple(joints)
        self._model = _with_masses(robot, masses, robot_too=robot_too)
        self._data = robot.scratch  # which the joints shape, not the masses
        known = {joint: value for joint, value in (others or {}).items() if joint in robot.joints}
        self._configuration = robot.configuration(known)
        self._robot = robot
        self._rows = np.array([self._model.idx_vs[robot.joint_of(joint)] for joint in joints], dtype=np.intp)
        widths = [self._model.nqs[robot.joint_of(joint)] for joint in joints]
        self._plain = np.array([self._model.idx_qs[robot.joint_of(joint)] for joint in joints], dtype=np.intp)
        followed = {mimic.leader for mimic in robot.mimics}
        self._direct = all(width == 1 for width in widths) and followed.isdisjoint(joints)
        self._others = known

    def efforts(self, positions: Array) -> Array:
        """Return what each joint must give, Nm or N, with the joints at ``positions``."""
        if self._direct:
            self._configuration[self._plain] = positions
        else:
            placed = dict(zip(self.joints, positions.tolist(), strict=True))
            self._configuration = self._robot.configuration({**self._others, **placed})
        return np.asarray(pinocchio.computeGeneralizedGravity(self._model, self._data, self._configuration))[self._rows]


def _with_masses(robot: RobotModel, masses: Sequence[LinkMass], *, robot_too: bool) -> PinModel:
    model = robot.kinematics.copy()
    if not robot_too:
        for joint in range(model.njoints):
            model.inertias[joint] = pinocchio.Inertia.Zero()
    moments: dict[int, list[tuple[float, Array]]] = {}
    for mass in masses:
        frame = model.frames[robot.frame_of(mass.link)]
        center = np.asarray(frame.placement.act(np.array(mass.center)))
        moments.setdefault(int(frame.parentJoint), []).append((mass.mass_kg, center))
    for joint, added in moments.items():
        own = model.inertias[joint]
        added.append((own.mass, np.array(own.lever)))
        total = sum(mass for mass, _ in added)
        # A body of no mass has no center: a pair of masses that cancel is held by two bodies, one of them here.
        total = total if abs(total) > _STILL else _STILL
        lever = sum((mass * center for mass, center in added), np.zeros(3)) / total
        model.inertias[joint] = pinocchio.Inertia(total, lever, np.zeros((3, 3)))
    return model


def holding_efforts(
    robot: RobotModel, positions: Mapping[str, float], carried: Sequence[LinkMass] = ()
) -> dict[str, float]:
    """Return what each joint must give for the robot to stand still, in Nm, or N where it slides.

    Args:
        positions: rad or m by joint name; joints that are not named stand as `RobotModel.configuration` says.
        carried: what links carry besides their own mass.
    """
    weights = Weights(robot, robot.joints, carried)
    at = [positions.get(joint, robot.rest_of(joint)) for joint in robot.joints]
    return dict(zip(robot.joints, weights.efforts(np.array(at)).tolist(), strict=True))


@dataclass(frozen=True, slots=True)
class Load:
    """What differs from what a law was bound for.

    Attributes:
        holds: whether the tool holds its part.
        part_more_kg: by which the part is heavier.
        compensation: share by which the device compensates too much.
    """

    holds: bool = False
    part_more_kg: float = 0.0
    compensation: float = 0.0


AS_BOUND = Load()


class Springs:
    """The joints of one device behind springs: what each must give, and where they balance.

    Attributes:
        joints: those behind springs, in the order of the law.
        stiffness: Nm/rad, or N/m.
    """

    def __init__(
        self, law: ControlLaw, robot: RobotModel, load: Load = AS_BOUND, others: Mapping[str, float] | None = None
    ) -> None:
        """Bind a law to a robot.

        Args:
            others: where the joints are that this law does not hold, rad or m.

        Raises:
            ModelError: the robot has not what the law names.
        """
        self.joints = tuple(law.joints)
        self.stiffness = np.array([joint.stiffness for joint in law.joints.values()])
        self._integral = np.array([_integral(joint.integral, joint.integral_most) for joint in law.joints.values()])
        part = () if law.part is None or not load.holds else (_heavier(law.part, load.part_more_kg),)
        compensated = law.gravity is Gravity.COMPENSATED
        left = (*law.unaccounted, *part) if compensated else part
        self._left = Weights(robot, self.joints, left, others=others, robot_too=not compensated)
        self._too_much = load.compensation if compensated else 0.0
        known = tuple(LinkMass(link=mass.link, mass_kg=-mass.mass_kg, center=mass.center) for mass in law.unaccounted)
        self._known = Weights(robot, self.joints, known, others=others) if self._too_much else None

    def efforts(self, positions: Array) -> Array:
        """Return what the springs must give at positions, Nm or N."""
        efforts = self._left.efforts(positions)
        return efforts if self._known is None else efforts - self._too_much * self._known.efforts(positions)

    def held(self, efforts: Array) -> Array:
        """Return what is left to the springs once the integrals have taken what they may."""
        return np.asarray(np.sign(efforts) * np.maximum(np.abs(efforts) - self._integral, 0.0))

    def balance(self, commanded: Array) -> Array:
        """Return where the joints come to rest; a joint that nothing holds ends `_FARTHEST` from its command."""
        at = commanded
        for _ in range(_STEPS):
            droop = np.clip(self.held(self.efforts(at)) / self.stiffness, -_FARTHEST, _FARTHEST)
            before, at = at, commanded - droop
            if float(np.abs(at - before).max(initial=0.0)) < _STILL:
                break
        return at


def _integral(gain: float, most: float | None) -> float:
    if gain <= 0.0:
        return 0.0
    return np.inf if most is None else most


def _heavier(part: LinkMass, more_kg: float) -> LinkMass:
    return LinkMass(link=part.link, mass_kg=max(0.0, part.mass_kg + more_kg), center=part.center)
