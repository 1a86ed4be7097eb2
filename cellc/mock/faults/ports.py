"""What a fault may touch of a running cell: each part by the few things that can go wrong with it, and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Protocol

from cellc.contract.contract import ContractFrame
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.mock.bus.network import Network
from cellc.mock.clocks import Clock, Clocks
from cellc.mock.control import ControlEvent, GripperEnded, GripperGoal, JointFault, TrajectoryEnded, TrajectoryGoal
from cellc.mock.effects import Effects
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.process import Action
from cellc.mock.nodes.perception import Camera, Perception
from cellc.mock.nodes.robot_state_publisher import RobotStatePublisher
from cellc.mock.parts import Parts
from cellc.mock.plant import Plant
from cellc.mock.real_start import RealStart
from cellc.mock.task_status import ActionStatus, ForeignGoal, Milestones, TaskRequests
from cellc.mock.tf.buffer import DEFAULT_BUFFER_S, TransformBuffer
from cellc.mock.tf.sources import SampledSource
from cellc.mock.world.joint_states import NEVER_NS, JointStateHistory
from cellc.mock.world.switches import Switches


class Schedule(Protocol):
    """The simulated clock, and actions at its times."""

    @property
    def now_ns(self) -> int:
        """The simulated time."""
        ...

    def at(self, when_ns: int, action: Action) -> None:
        """Call an action at a time."""
        ...

    def every(self, first_ns: int, rate_hz: float, action: Callable[[int], None]) -> None:
        """Call an action at a rate."""
        ...


@dataclass(frozen=True, slots=True)
class HardwarePort:
    """Joints that do not follow, and update loops that miss cycles."""

    control: ControlStack

    def disturb(self, joint: str, fault: JointFault) -> None:
        """Let something be wrong with a joint."""
        for server in self.control.servers_of_joint(joint):
            server.disturbances.disturb(joint, fault)

    def restore(self, joint: str, fault: JointFault) -> None:
        """Let that be right again."""
        for server in self.control.servers_of_joint(joint):
            server.disturbances.restore(joint, fault)

    def positions(self, joints: Collection[str]) -> dict[str, float]:
        """Return what is measured of joints, rad or m."""
        servers = {joint: self.control.servers_of_joint(joint) for joint in joints}
        return {joint: server.joint_positions()[joint] for joint in joints for server in servers[joint]}

    def scale_speed(self, component: str, interface: str, factor: float) -> None:
        """Set the speed scaling that a component reports, 0 to 1."""
        for manager in self.control.managers_of_component(component):
            manager.write_state(interface, factor)

    def skip_cycles(self, cycles: int) -> None:
        """Let every controller manager and adapter miss a number of cycles in a row."""
        for manager in self.control.managers.values():
            manager.disturbances.skip_cycles(cycles)
        for server in self.control.adapters.values():
            server.skip_cycles(cycles)


@dataclass(frozen=True, slots=True)
class ControllerPort:
    """Controllers that somebody else switches or commands."""

    control: ControlStack
    actions: ActionStatus

    def switch(self, manager: str, activate: Collection[str], deactivate: Collection[str]) -> None:
        """Ask a controller manager for one strict switch."""
        self.control.managers[manager].switch_controllers(list(activate), list(deactivate))

    def activate(self, controller: str) -> None:
        """Activate a controller."""
        self.control.manager_of(controller).switch_controllers([controller], [])

    def deactivate_when_idle(self, controller: str) -> None:
        """Deactivate a controller, immediately or as soon as the goal that it has is over."""
        manager = self.control.manager_of(controller)
        if not self.actions.is_executing(controller):
            manager.switch_controllers([], [controller])
            return
        waiting = [True]

        def after_goal(event: ControlEvent) -> None:
            if waiting and isinstance(event, (TrajectoryEnded, GripperEnded)) and event.controller == controller:
                waiting.clear()
                manager.switch_controllers([], [controller])

        self.control.listen(after_goal)

    def positions(self, controller: str) -> dict[str, float]:
        """Return where the joints of a controller's manager stand."""
        return self.control.manager_of(controller).joint_positions()

    def send_foreign_goal(self, controller: str, goal: TrajectoryGoal | GripperGoal, client: str, now_ns: int) -> None:
        """Send the goal of another client than the task; one that is rejected commands nothing."""
        response = self.control.send_goal(controller, goal)
        if response.accepted:
            self.actions.note_foreign(ForeignGoal(controller, response.goal_id, client), now_ns)


@dataclass(frozen=True, slots=True)
class SamplePort:
    """Images and joint states that stay away or come late."""

    histories: Collection[JointStateHistory]
    cameras: Mapping[str, Camera]
    schedule: Schedule

    def freeze_camera(self, device: str, *, frozen: bool) -> None:
        """Let a camera repeat its last image, or stream again; nothing for another device."""
        if device in self.cameras:
            self.cameras[device].freeze(frozen)

    def camera_node(self, device: str) -> str:
        """Return the node that publishes the images of a camera."""
        return self.cameras[device].device

    def of_broadcasters(self, names: Collection[str]) -> list[JointStateHistory]:
        """Return what some broadcasters publish."""
        return [history for history in self.histories if history.broadcaster in names]

    def of_joints(self, joints: Collection[str]) -> list[JointStateHistory]:
        """Return what the broadcasters publish that report one of the joints."""
        return [history for history in self.histories if any(joint in history.names for joint in joints)]

    def hold_back(self, histories: Collection[JointStateHistory], delay_ns: int = NEVER_NS) -> None:
        """Let joint states that are stamped from now on arrive late."""
        for history in histories:
            history.hold_back(self.schedule.now_ns, delay_ns)

    def release(self, histories: Collection[JointStateHistory], delay_ns: int = NEVER_NS) -> None:
        """Let joint states that are stamped from now on arrive without a delay that began before."""
        for history in histories:
            history.release(self.schedule.now_ns, delay_ns)


@dataclass(frozen=True, slots=True)
class TransformPort:
    """Frames that are not published, or that two nodes publish."""

    buffer: TransformBuffer
    perceptions: Mapping[str, Perception]
    publisher: RobotStatePublisher
    schedule: Schedule
    task_clock: Clock

    def drop(self, frame: str) -> None:
        """Stop publishing a frame."""
        if frame in self.perceptions:
            self.perceptions[frame].publish_transform(False)
        else:
            self.publisher.drop(frame, self.schedule.now_ns)

    def resume(self, frame: str) -> None:
        """Publish a frame again."""
        if frame in self.perceptions:
            self.perceptions[frame].publish_transform(True)
        else:
            self.publisher.resume(frame, self.schedule.now_ns)

    def all_frames(self) -> Iterator[str]:
        """Yield every frame on /tf: those that perception publishes, and the links."""
        yield from self.perceptions
        yield from self.publisher.links.joints

    def add_authority(self, child: str, facts: ContractFrame, authority: str) -> SampledSource:
        """Let another node publish a frame too; it publishes what is put into the source."""
        buffer_s = facts.buffer_s or DEFAULT_BUFFER_S
        source = SampledSource(facts.parent, child, authority, buffer_s, self.buffer.warnings)
        self.buffer.add(child, source)
        return source

    def publish(self, source: SampledSource, pose: Pose) -> None:
        """Publish a transform that is stamped on the clock of the task."""
        source.insert(self.task_clock.read(self.schedule.now_ns), pose)


@dataclass(frozen=True, slots=True)
class FaultPorts:
    """Everything that faults may touch."""

    schedule: Schedule
    hardware: HardwarePort
    controllers: ControllerPort
    samples: SamplePort
    transforms: TransformPort
    network: Network
    clocks: Clocks
    requests: TaskRequests
    milestones: Milestones
    effects: Effects
    start: RealStart
    switches: Switches
    parts: Parts


def fault_ports(plant: Plant) -> FaultPorts:
    """Return what faults may touch of a plant."""
    schedule: Schedule = plant.simulation
    publisher, clock = plant.robot_state_publisher, plant.clocks.of(plant.task.name)
    return FaultPorts(
        schedule,
        HardwarePort(plant.control),
        ControllerPort(plant.control, plant.task.actions),
        SamplePort(plant.control.histories.values(), plant.cameras, schedule),
        TransformPort(plant.task.buffer, plant.perceptions, publisher, schedule, clock),
        plant.network,
        plant.clocks,
        plant.task.requests,
        plant.task.milestones,
        plant.effects,
        plant.start,
        plant.switches,
        plant.parts,
    )
