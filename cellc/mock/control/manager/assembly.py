"""Assembly of the manager's parts from the two texts that it is given."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Behavior, Distro
from cellc.mock.control.controllers.base import DeclaredInterfaces
from cellc.mock.control.errors import DescriptionError
from cellc.mock.control.hardware import CommandLimiter, Disturbances
from cellc.mock.control.hardware.forces import Forces
from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.manager.cycles import CycleRunner
from cellc.mock.control.manager.hardware_set import HardwareSet, all_limits
from cellc.mock.control.manager.registry import ControllerRegistry
from cellc.mock.control.manager.settings import NODE_NAME, read_file, read_settings
from cellc.mock.control.manager.switching import SwitchChecker, Switcher
from cellc.mock.control.messages import ControlEvent
from cellc.mock.control.parameters import ParameterSet
from cellc.mock.control.robot_description import RobotDescription, take_description
from cellc.robot.description.model import Description


@dataclass(frozen=True, slots=True)
class NodeOptions:
    """How the manager's node is started.

    Attributes:
        namespace: namespace of the manager and its controllers.
        distro: ROS distribution.
        behaviors: behaviors of further controller types.
        start_ns: simulated time of the first cycle.
        declared: interfaces of controllers that only the cell tells, by name.
        forces: what moves the joints; None where they are where they are led to.
    """

    namespace: str
    distro: Distro
    behaviors: Mapping[str, Behavior]
    start_ns: int
    declared: Mapping[str, DeclaredInterfaces]
    forces: Forces | None = None


@dataclass(slots=True)
class Stack:
    """The parts of the manager; `hardware` and `cycles` are None where the description was refused."""

    log: Log
    events: list[ControlEvent]
    table: InterfaceTable
    disturbances: Disturbances
    registry: ControllerRegistry
    checker: SwitchChecker
    hardware: HardwareSet | None
    cycles: CycleRunner | None
    period_ns: int
    rate: int
    description_error: str


class _Late:
    """Calls of the disturbances that reach parts which are made after them."""

    def __init__(self) -> None:
        self.hardware: HardwareSet | None = None
        self.cycles: CycleRunner | None = None

    def skip(self, cycles: int) -> None:
        if self.cycles is not None:
            self.cycles.skip(cycles)

    def set_state(self, component: str, state: str) -> None:
        if self.hardware is not None:
            self.hardware.set_state(component, state)

    def stand(self, component: str) -> None:
        if self.hardware is not None:
            self.hardware.stand(component)

    def place(self, joint: str, position: float) -> None:
        if self.hardware is not None:
            self.hardware.place(joint, position)

    def rest(self, component: str) -> None:
        if self.hardware is not None:
            self.hardware.rest(component)


def _load_hardware(
    source: str | Description,
    table: InterfaceTable,
    disturbances: Disturbances,
    log: Log,
    events: list[ControlEvent],
    forces: Forces | None,
) -> tuple[RobotDescription, HardwareSet | None, str]:
    """Read the description; where it is refused, no hardware starts and the reason is returned."""
    try:
        description = take_description(source)
    except DescriptionError as error:
        reason = f"Error importing joint limiters: {error.reason}"
        log.error(NODE_NAME, reason)
        return RobotDescription({}, ()), None, reason
    try:
        return description, HardwareSet(description, table, disturbances, log, events, forces), ""
    except DescriptionError as error:
        log.error("resource_manager", error.reason)
        log.warn(
            NODE_NAME,
            "Could not load and initialize hardware. Please check previous output for more details. After you have "
            "corrected your URDF, try to publish robot description again.",
        )
        return RobotDescription({}, ()), None, error.reason


def assemble(
    robot_description: str | Description, parameters: str, options: NodeOptions, changed: Callable[[], None]
) -> Stack:
    """Make all parts.

    Args:
        robot_description: the text of a URDF, or what was read of it before.
        parameters: text of the parameter file.
        options: how the node is started.
        changed: called before each change that comes from outside.

    Raises:
        ManagerAbortedError: where the real process would end while it starts.
    """
    log, table, late = Log(), InterfaceTable(), _Late()
    events: list[ControlEvent] = []
    log.now_ns = options.start_ns
    file = read_file(parameters)
    settings = read_settings(ParameterSet(file.of_node(NODE_NAME, options.namespace)), options.distro)
    rate, period_ns = settings.update_rate, 1_000_000_000 // settings.update_rate
    disturbances = Disturbances(changed, late.skip, late.set_state, late.stand, late.place, late.rest)
    description, hardware, reason = _load_hardware(robot_description, table, disturbances, log, events, options.forces)
    limiter = None
    if hardware is not None:
        hardware.set_initial(settings.initially_unconfigured, settings.initially_inactive)
        if settings.enforce_command_limits:
            limiter = CommandLimiter(all_limits(description), table, period_ns, log)
    registry = ControllerRegistry(
        file, options.namespace, options.distro, options.behaviors, log, events, options.declared
    )
    registry.attach(description, table, limiter, period_ns, rate)
    checker = SwitchChecker(registry, hardware, table, log)
    switcher = Switcher(registry, hardware, table, limiter, checker, log, events)
    cycles = None
    if hardware is not None:
        cycles = CycleRunner(
            registry, hardware, switcher, table, limiter, disturbances, log, period_ns, rate, options.start_ns
        )
    late.hardware, late.cycles = hardware, cycles
    return Stack(log, events, table, disturbances, registry, checker, hardware, cycles, period_ns, rate, reason)
