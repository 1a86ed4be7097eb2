"""Everything that runs in one rehearsal, each part with its owner.

Code that needs less does not take a plant: faults get `faults.ports.FaultPorts`, nodes get their own inputs.
"""

from __future__ import annotations

from dataclasses import field

from cellc.contract.bring_up import BringUpStep
from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.mock.bus.network import Network
from cellc.mock.clocks import Clocks
from cellc.mock.effects import Effects
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.simulation import Simulation
from cellc.mock.loads import Loads
from cellc.mock.nodes.motion_planner import MotionPlanner
from cellc.mock.nodes.observations import ObservationInbox
from cellc.mock.nodes.perception import Camera, Perception
from cellc.mock.nodes.robot_state_publisher import JointStateFeed, RobotStatePublisher
from cellc.mock.parts import Parts
from cellc.mock.real_start import RealStart
from cellc.mock.reality import Arrival
from cellc.mock.stops import Stops
from cellc.mock.task_status import ActionStatus, Milestones, TaskRequests
from cellc.mock.tf.buffer import TransformBuffer
from cellc.mock.watching import ClaimWatches
from cellc.mock.world.switches import Switches
from cellc.mock.world.world import World


@dataclass(frozen=True, slots=True)
class TaskNode:
    """The node that the task represents: what reaches it, what it shows of itself, and what is asked of it.

    Attributes:
        name: of the node in the contract.
        buffer: transforms that it has heard.
        feeds: joint states that reach it.
        observations: by the dynamic frame that is observed.
        requests: what others ask of it.
        actions: goals that execute.
        milestones: how far the steps of the rehearsal have come.
    """

    name: str
    buffer: TransformBuffer
    feeds: tuple[JointStateFeed, ...]
    observations: dict[str, ObservationInbox]
    requests: TaskRequests
    actions: ActionStatus
    milestones: Milestones


@dataclass(frozen=True, slots=True)
class Plant:
    """The parts of a running cell.

    Attributes:
        control: controller managers and adapters, with the joint states that they publish.
        stops: of the hardware, until they are acknowledged.
        watches: who takes claims from devices that follow no set points.
        effects: what devices do beside following commands.
        start: what devices and people do as the real target is brought up.
        loads: what joints behind springs hold.
        world: where links and objects really are.
        parts: what grippers hold, and how it differs from what is stated.
        switches: devices that digital outputs switch.
        cameras: by device.
        perceptions: by the dynamic frame that they publish.
        arrivals: at goals, with how near each really was.
        lifecycles: states of managed nodes by full name, as far as a bring-up has asked them for transitions.
    """

    contract: Contract
    bring_up: tuple[BringUpStep, ...]
    simulation: Simulation
    clocks: Clocks
    network: Network
    control: ControlStack
    stops: Stops
    watches: ClaimWatches
    effects: Effects
    start: RealStart
    loads: Loads
    world: World
    parts: Parts
    switches: Switches
    robot_state_publisher: RobotStatePublisher
    planner: MotionPlanner
    task: TaskNode
    cameras: dict[str, Camera] = field(default_factory=dict)
    perceptions: dict[str, Perception] = field(default_factory=dict)
    arrivals: list[Arrival] = field(default_factory=list)
    lifecycles: dict[str, str] = field(default_factory=dict)

    @property
    def now_ns(self) -> int:
        """The simulated time."""
        return self.simulation.now_ns
