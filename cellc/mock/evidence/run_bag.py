"""Writes what happens in one rehearsal to a bag: states, transforms, goals, poses, diagnostics and attempts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from cellc.contract.attempt import AttemptRecord
from cellc.contract.contract import ContractController
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import TRAJECTORIES
from cellc.mock.control import ControllerManager, GripperGoal, JointStateBlock, Recording
from cellc.mock.engine.control_stack import GoalSent
from cellc.mock.evidence.bag import messages
from cellc.mock.evidence.bag.bag_file import MessageWriter
from cellc.mock.evidence.bag.cdr import MessageRows
from cellc.mock.evidence.bag.messages import (
    DiagnosticStatus,
    GoalState,
    Point,
    StampedTransform,
    controller_state_rows,
    joint_state_shape,
)
from cellc.mock.evidence.statuses import ROSOUT, Line, status_topics
from cellc.mock.evidence.topics import (
    ATTEMPTS,
    CLOCK_TOPIC,
    DIAGNOSTICS,
    BagTopic,
    controller_state_topic,
    description_topic,
    goal_topic,
    joint_states_topic,
    pose_topic,
    static_transforms_topic,
    transforms_topic,
)
from cellc.mock.nodes.perception import ObjectPose
from cellc.mock.nodes.robot_state_publisher import PUBLISH_FREQUENCY_HZ
from cellc.mock.plant import Plant
from cellc.mock.result import to_json_line
from cellc.mock.world.joint_states import NEVER_NS, JointStateHistory

_OK, _WARN, _ERROR = 0, 1, 2

_INTERVAL_NS = round(1e9 / PUBLISH_FREQUENCY_HZ)
_FIELD_OF = {
    "position": "positions",
    "velocity": "velocities",
    "acceleration": "accelerations",
    "effort": "effort",
}
"""Field of a trajectory point by kind of interface."""


def diagnose(plant: Plant, until_ns: int | None) -> tuple[DiagnosticStatus, ...]:
    """Return the present status of every controller manager and of its update loop.

    Args:
        until_ns: up to which cycles were due; up to the last message of each manager where it is None, because
            managers run ahead of each other for some cycles.
    """
    return tuple(_statuses(plant, until_ns))


def _statuses(plant: Plant, until_ns: int | None) -> Iterator[DiagnosticStatus]:
    for name, manager in plant.control.managers.items():
        namespace = plant.contract.managers[name].namespace.strip("/")
        node = f"{namespace}/controller_manager" if namespace else "controller_manager"
        yield _activity(f"{node}: Controllers Activity", "controllers", _controllers(manager), _WARN)
        yield _activity(f"{node}: Hardware Components Activity", "hardware components", _components(manager), _ERROR)
        histories = [history for (owner, _), history in plant.control.histories.items() if owner == name]
        missed = sum(history.missed_until(_last_ns(history) if until_ns is None else until_ns) for history in histories)
        text = "no update cycle was missed" if missed == 0 else f"{missed} update cycles were missed"
        yield DiagnosticStatus(
            _ERROR if missed else _OK, f"{node}: Update Cycles", text, (("missed_cycles", str(missed)),)
        )


def _last_ns(history: JointStateHistory) -> int:
    return int(history.stamps[-1]) if len(history.stamps) else 0


def _activity(name: str, what: str, states: tuple[tuple[str, str], ...], level: int) -> DiagnosticStatus:
    active = all(state == "active" for _, state in states)
    text = f"all {what} are active" if active else f"not all {what} are active"
    return DiagnosticStatus(_OK if active else level, name, text, states)


def _controllers(manager: ControllerManager) -> tuple[tuple[str, str], ...]:
    return tuple((controller.name, controller.state) for controller in manager.list_controllers())


def _components(manager: ControllerManager) -> tuple[tuple[str, str], ...]:
    return tuple((component.name, component.state) for component in manager.list_hardware_components())


@dataclass(frozen=True, slots=True)
class TransformMessage:
    """A tf2_msgs/TFMessage with the simulated instant at which it was published."""

    published_ns: int
    transforms: tuple[StampedTransform, ...]


class TransformStream:
    """Turns the joint states of one broadcaster into transforms, thinned as the node does it."""

    def __init__(self, plant: Plant, history: JointStateHistory) -> None:
        """Bind the stream; it reads the plant and changes nothing in it."""
        self._plant = plant
        self._history = history
        self._clock = plant.clocks.of(history.broadcaster)
        self._due_ns: int | None = None

    def take(self, block: JointStateBlock) -> Iterator[TransformMessage]:
        """Yield the messages that a block of joint states gives."""
        arrivals = self._history.arrivals(block.stamps_ns)
        for row in self._used(block):
            taken_ns = int(block.stamps_ns[row])
            positions = dict(zip(block.names, block.positions[row].tolist(), strict=True))
            transforms = self._transforms(taken_ns, positions)
            if transforms and arrivals[row] - taken_ns < NEVER_NS:
                yield TransformMessage(int(arrivals[row]), transforms)

    def _used(self, block: JointStateBlock) -> Iterator[int]:
        row = 0 if self._due_ns is None else int(np.searchsorted(block.stamps_ns, self._due_ns))
        while row < len(block.stamps_ns):
            yield row
            self._due_ns = int(block.stamps_ns[row]) + _INTERVAL_NS
            row = int(np.searchsorted(block.stamps_ns, self._due_ns))

    def _transforms(self, taken_ns: int, positions: dict[str, float]) -> tuple[StampedTransform, ...]:
        publisher, stamp_ns = self._plant.robot_state_publisher, self._clock.read(taken_ns)
        return tuple(
            StampedTransform(stamp_ns, joint.parent, joint.child, joint.pose(positions))
            for joint in publisher.moved_by(self._history)
            if publisher.publishes(joint.child, taken_ns)
        )


def static_transforms(plant: Plant) -> tuple[StampedTransform, ...]:
    """Return the fixed edges of the robot description, stamped with the beginning of time."""
    joints = plant.robot_state_publisher.links.joints.values()
    return tuple(StampedTransform(0, joint.parent, joint.child, joint.origin) for joint in joints if not joint.moves)


class RunBag:
    """Writes what happens in a plant; all topics are declared first, in the order of the contract."""

    def __init__(self, bag: MessageWriter, plant: Plant) -> None:
        """Declare the topics of a plant."""
        self._bag = bag
        self._plant = plant
        self._shapes: dict[tuple[str, ...], MessageRows] = {}
        contract = plant.contract
        self._description = self._declare(description_topic(contract))
        self._static = self._declare(static_transforms_topic(contract))
        self._transforms = self._declare(transforms_topic(contract))
        self._joint_states = {key: self._declare(joint_states_topic(contract, *key)) for key in plant.control.histories}
        self._states: dict[str, int] = {}
        self._goals: dict[str, int] = {}
        self._images: dict[str, int] = {}
        for name, manager in contract.managers.items():
            for controller, facts in manager.controllers.items():
                if facts.behavior in TRAJECTORIES:
                    self._states[controller] = self._declare(controller_state_topic(contract, name, controller))
                if facts.action is not None:
                    topic = goal_topic(controller, gripper=facts.behavior not in TRAJECTORIES)
                    self._goals[controller] = self._declare(topic)
        for device in contract.adapters:
            self._goals[device] = self._declare(goal_topic(device, gripper=False))
        topics = {frame: pose_topic(contract, frame) for frame in plant.perceptions}
        self._poses = {frame: self._declare(topic) for frame, topic in topics.items() if topic is not None}
        self._diagnostics = self._declare(DIAGNOSTICS)
        self._clock = self._declare(CLOCK_TOPIC)
        self._attempts = self._declare(ATTEMPTS)
        self._statuses = {action: self._declare(topic) for action, topic in status_topics(contract).items()}
        self._log = self._declare(ROSOUT)

    def begin(self, urdf: str) -> None:
        """Write what robot_state_publisher latches when it starts."""
        now_ns = self._plant.now_ns
        self._bag.write(self._description, messages.string(urdf), now_ns)
        self._bag.write(self._static, messages.transforms(static_transforms(self._plant)), now_ns)

    def joint_states(self, manager: str, broadcaster: str, block: JointStateBlock) -> None:
        """Write joint states, each logged when it arrives."""
        history = self._plant.control.histories[(manager, broadcaster)]
        columns = [block.names.index(name) for name in history.names]
        clock = self._plant.clocks.of(broadcaster)
        stamps = np.array([clock.read(stamp) for stamp in block.stamps_ns.tolist()], dtype=np.int64)
        shape = self._shapes.setdefault(history.names, joint_state_shape(history.names))
        numbers = [values[:, columns] for values in (block.positions, block.velocities, block.efforts)]
        arrivals = history.arrivals(block.stamps_ns).tolist()
        for data, published_ns, arrived_ns in zip(
            shape.encode(stamps, numbers), block.stamps_ns.tolist(), arrivals, strict=True
        ):
            if arrived_ns - published_ns < NEVER_NS:  # what is lost on the way no recorder hears
                self._bag.write(self._joint_states[(manager, broadcaster)], data, published_ns, arrived_ns)

    def controller_states(self, controller: str, recording: Recording) -> None:
        """Write the states of a trajectory controller."""
        clock = self._plant.clocks.of(controller)
        stamps = np.array([clock.read(stamp) for stamp in recording.stamps_ns.tolist()], dtype=np.int64)
        points = _points(recording, self._first_command(controller))
        shape, numbers = controller_state_rows(recording.joints, points, recording.scaling, self._plant.contract.distro)
        for data, stamp_ns in zip(shape.encode(stamps, numbers), recording.stamps_ns.tolist(), strict=True):
            self._bag.write(self._states[controller], data, stamp_ns)

    def transforms(self, message: TransformMessage) -> None:
        """Write moving edges."""
        self._bag.write(self._transforms, messages.transforms(message.transforms), message.published_ns)

    def goal(self, sent: GoalSent) -> None:
        """Write a goal as it was sent, whatever the answer was."""
        if sent.controller not in self._goals:
            return
        if isinstance(sent.goal, GripperGoal):
            joints = sent.goal.joint_names or self._facts(sent.controller).joints
            data = messages.gripper_command(sent.stamp_ns, joints, sent.goal)
        else:
            data = messages.joint_trajectory(sent.goal.trajectory())
        self._bag.write(self._goals[sent.controller], data, sent.stamp_ns)

    def pose(self, frame: str, published: ObjectPose, as_transform: bool) -> None:
        """Write an object pose, and its transform where that was published too."""
        now_ns = self._plant.now_ns
        if frame in self._poses:
            data = messages.pose_stamped(published.stamp_ns, published.frame, published.pose)
            self._bag.write(self._poses[frame], data, now_ns)
        if as_transform:
            stamped = messages.StampedTransform(published.stamp_ns, published.frame, frame, published.pose)
            self._bag.write(self._transforms, messages.transforms((stamped,)), now_ns)

    def clock(self, now_ns: int) -> None:
        """Write the simulated time."""
        self._bag.write(self._clock, messages.clock(now_ns), now_ns)

    def images(self, topics: Iterable[BagTopic]) -> None:
        """Declare the topics of cameras."""
        self._images |= {topic.name: self._declare(topic) for topic in topics}

    def image(self, topic: str, data: bytes, stamp_ns: int) -> None:
        """Write an image, or the intrinsics of one."""
        self._bag.write(self._images[topic], data, stamp_ns)

    def diagnostics(self, now_ns: int, *, ended: bool = False) -> None:
        """Write the present diagnostics; where the run has ended, every cycle up to now was due."""
        data = messages.diagnostics(now_ns, diagnose(self._plant, now_ns if ended else None))
        self._bag.write(self._diagnostics, data, now_ns)

    def attempt(self, record: AttemptRecord) -> None:
        """Write an attempt record when it ended."""
        self._bag.write(self._attempts, messages.string(to_json_line(record)), record.ended_ns)

    def status(self, action: str, at_ns: int, goals: tuple[GoalState, ...]) -> None:
        """Write the states of all goals of an action."""
        self._bag.write(self._statuses[action], messages.goal_status(goals), at_ns)

    def line(self, line: Line) -> None:
        """Write what a node says."""
        self._bag.write(self._log, messages.log(line.stamp_ns, line.level, line.node, line.text), line.stamp_ns)

    def _declare(self, topic: BagTopic) -> int:
        return self._bag.declare(topic.name, topic.kind, topic.qos)

    def _facts(self, controller: str) -> ContractController:
        managers = self._plant.contract.managers.values()
        return next(manager.controllers[controller] for manager in managers if controller in manager.controllers)

    def _first_command(self, controller: str) -> str:
        interfaces = self._facts(controller).command_interfaces
        return interfaces[0].rpartition("/")[2] if interfaces else "position"


def _points(recording: Recording, command: str) -> tuple[Point, ...]:
    """Return reference, feedback, error and output with the fields that the controller knows."""
    reference = {"positions": recording.desired, "velocities": recording.desired_velocity}
    feedback, error = {"positions": recording.actual}, {"positions": recording.error}
    if not np.isnan(recording.actual_velocity).all():
        feedback["velocities"] = recording.actual_velocity
        error["velocities"] = recording.desired_velocity - recording.actual_velocity
    output = {_FIELD_OF.get(command, "positions"): recording.command}
    return reference, feedback, error, output
