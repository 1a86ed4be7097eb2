"""Everything that runs in one rehearsal, by its name in the contract."""

from __future__ import annotations

from dataclasses import dataclass, field

from cellc.contract.contract import Contract
from cellc.mock.bus.network import Network
from cellc.mock.clocks import Clocks
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.process import Signal
from cellc.mock.engine.simulation import Simulation
from cellc.mock.nodes.motion_planner import MotionPlanner
from cellc.mock.nodes.observations import ObservationInbox
from cellc.mock.nodes.perception import Camera, Perception
from cellc.mock.nodes.robot_state_publisher import JointStateFeed, RobotStatePublisher
from cellc.mock.progress import Progress
from cellc.mock.stops import Stops
from cellc.mock.tf.buffer import TransformBuffer
from cellc.mock.world.objects import World


@dataclass(slots=True)
class Requests:
    """What the outside asks of the task while it runs, and may know of it.

    Attributes:
        cancel: kinds of step whose next executing goal is to be cancelled.
        executing: controllers that have a goal of the task.
        displaced: goals that are not where they were, by goal: metres along the axes of their frame.
        unresponsive: servers that answer nothing.
        foreign_goals: goals that another client sent to a controller, by controller and goal, with the client.
        findings: what the middleware told of connections that were lost.
        changed: fires when something is asked.
    """

    cancel: set[str] = field(default_factory=set)
    executing: set[str] = field(default_factory=set)
    displaced: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    unresponsive: set[str] = field(default_factory=set)
    foreign_goals: dict[tuple[str, int], str] = field(default_factory=dict)
    findings: list[str] = field(default_factory=list)
    changed: Signal = field(default_factory=Signal)


@dataclass(frozen=True, slots=True)
class Plant:
    """The parts of a running cell.

    Attributes:
        task: node that the task of a rehearsal stands for.
        feeds: joint states that reach the task.
        cameras: by device.
        perceptions: by the dynamic frame that they publish.
        inboxes: the task's observations, by dynamic frame.
        progress: how far the steps of the rehearsal have come.
        stops: of the hardware, until they are acknowledged.
    """

    contract: Contract
    simulation: Simulation
    control: ControlStack
    world: World
    buffer: TransformBuffer
    robot_state_publisher: RobotStatePublisher
    planner: MotionPlanner
    clocks: Clocks
    network: Network
    task: str
    feeds: tuple[JointStateFeed, ...]
    cameras: dict[str, Camera]
    perceptions: dict[str, Perception]
    inboxes: dict[str, ObservationInbox]
    requests: Requests
    progress: Progress
    stops: Stops

    @property
    def now_ns(self) -> int:
        """The simulated time."""
        return self.simulation.now_ns
