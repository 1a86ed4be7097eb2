"""What clients call: goals of actions, the list services, and the spawner."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cellc.contract.frozen import dataclass
from cellc.mock.control.controllers.gripper import GripperController
from cellc.mock.control.controllers.joint_trajectory import JointTrajectoryController
from cellc.mock.control.controllers.joint_trajectory.acceptance import refusal
from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.manager.hardware_set import HardwareSet
from cellc.mock.control.manager.registry import ControllerRegistry
from cellc.mock.control.manager.switching import Strictness, Switch, SwitchChecker
from cellc.mock.control.messages import (
    CancelResponse,
    Goal,
    GoalResponse,
    GripperGoal,
    ServiceResponse,
    Trajectory,
    TrajectoryGoal,
)
from cellc.mock.control.parameters import ParameterFile

_CANNOT_ACCEPT = "Can't accept new action goals. Controller is not running."
_NO_ERROR, _UNKNOWN, _TERMINATED = 0, 2, 3


class GoalDesk:
    """Passes goals and cancel requests on to the controllers.

    Args:
        registry: the controllers.
        log: the log.
    """

    def __init__(self, registry: ControllerRegistry, log: Log) -> None:
        self._registry = registry
        self._log = log
        self._owners: dict[int, str] = {}

    def send(self, controller: str, goal: Goal, now_ns: int, listened: bool) -> GoalResponse:
        """Answer a goal request."""
        self._log.now_ns = now_ns
        loaded = self._registry.controllers.get(controller)
        receiver = None if loaded is None else loaded.controller
        if isinstance(receiver, JointTrajectoryController) and isinstance(goal, TrajectoryGoal):
            return self._send_trajectory(controller, receiver, goal, now_ns, listened)
        if isinstance(receiver, GripperController) and isinstance(goal, GripperGoal):
            return self._send_gripper(controller, receiver, goal, now_ns)
        return GoalResponse(False, log_reason=f"no action server for this goal at '{controller}'")

    def _send_trajectory(
        self, name: str, controller: JointTrajectoryController, goal: TrajectoryGoal, now_ns: int, listened: bool
    ) -> GoalResponse:
        self._log.info(name, "Received new action goal")
        state = self._registry.controllers[name].state
        reason = _CANNOT_ACCEPT if state != "active" else refusal(goal.trajectory(), controller.rules(), now_ns)
        if reason:
            self._log.error(name, reason)
            return GoalResponse(False, log_reason=reason)
        self._log.info(name, "Accepted new action goal")
        goal_id = self._number(name)
        controller.goals.accept(goal_id, goal, now_ns, listened)
        controller.take(goal.trajectory())
        return GoalResponse(True, goal_id)

    def _send_gripper(self, name: str, controller: GripperController, goal: GripperGoal, now_ns: int) -> GoalResponse:
        if not controller.active:
            return GoalResponse(False, log_reason=f"the action server of '{name}' exists only while it is active")
        reason = controller.refusal(goal)
        if reason:
            self._log.error(name, reason)
            return GoalResponse(False, log_reason=reason)
        self._log.info(name, "Received & accepted new action goal")
        goal_id = self._number(name)
        controller.accept(goal_id, goal, now_ns)
        return GoalResponse(True, goal_id)

    def _number(self, controller: str) -> int:
        goal_id = len(self._owners) + 1
        self._owners[goal_id] = controller
        return goal_id

    def cancel(self, goal_id: int, now_ns: int) -> CancelResponse:
        """Answer a cancel request for one goal."""
        self._log.now_ns = now_ns
        name = self._owners.get(goal_id)
        if name is None or name not in self._registry.controllers:
            return CancelResponse(_UNKNOWN)
        controller = self._registry.controllers[name].controller
        assert isinstance(controller, JointTrajectoryController | GripperController)
        goals = controller.goals if isinstance(controller, JointTrajectoryController) else controller
        if goals.running_id != goal_id:
            return CancelResponse(_NO_ERROR, (goal_id,)) if goals.is_waiting(goal_id) else CancelResponse(_TERMINATED)
        self._cancel_running(name, controller, now_ns)
        return CancelResponse(_NO_ERROR, (goal_id,))

    def _cancel_running(
        self, name: str, controller: JointTrajectoryController | GripperController, now_ns: int
    ) -> None:
        self._log.info(name, "Got request to cancel goal")
        self._log.info(name, "Canceling active action goal because cancel callback received.")
        if isinstance(controller, JointTrajectoryController):
            controller.goals.cancel(now_ns)
            controller.stop()
        else:
            controller.cancel(now_ns)

    def cancel_all(self, name: str, now_ns: int) -> CancelResponse:
        """Answer a cancel request for all goals of a controller."""
        self._log.now_ns = now_ns
        controller = self._registry.controllers[name].controller
        if isinstance(controller, JointTrajectoryController):
            running = controller.goals.running_id
        elif isinstance(controller, GripperController):
            running = controller.running_id
        else:
            running = 0
        return self.cancel(running, now_ns) if running else CancelResponse(_NO_ERROR)

    def take_trajectory(self, name: str, trajectory: Trajectory, now_ns: int) -> str:
        """Pass a message of `~/joint_trajectory` on; returns why it was ignored, empty where it was not."""
        self._log.now_ns = now_ns
        loaded = self._registry.controllers[name]
        controller = loaded.controller
        assert isinstance(controller, JointTrajectoryController), f"{name} is no trajectory controller"
        if loaded.state != "active":
            return "the controller is not active"
        reason = refusal(trajectory, controller.rules(), now_ns)
        if reason:
            self._log.error(name, reason)
        else:
            controller.take(trajectory)
        return reason


@dataclass(frozen=True, slots=True)
class SpawnResponse:
    """How a spawner ended.

    Attributes:
        ok: exit status 0.
        failed: the controller at which it stopped, empty where it did not.
        reason: the manager's or controller's reason.
        not_tried: names that it did not come to.
    """

    ok: bool
    failed: str = ""
    reason: str = ""
    not_tried: tuple[str, ...] = ()


class Spawner:
    """Brings controllers up.

    Args:
        registry: the controllers.
        checker: checks the activations.
        apply: carries a switch out.
        log: the log.
    """

    def __init__(
        self, registry: ControllerRegistry, checker: SwitchChecker, apply: Callable[[Switch], None], log: Log
    ) -> None:
        self._registry = registry
        self._checker = checker
        self._apply = apply
        self._log = log

    def spawn(self, names: Sequence[str], inactive: bool, file: ParameterFile | None) -> SpawnResponse:
        """Do one call.

        Args:
            names: controllers in order.
            inactive: whether they are only configured (--inactive).
            file: parameters of --param-file.

        Returns:
            How it ended.
        """
        for index, name in enumerate(names):
            answer = self._bring_up(name, inactive, file, f"spawner_{names[0]}")
            if not answer.ok:
                return SpawnResponse(False, name, answer.message, tuple(names[index + 1 :]))
        return SpawnResponse(True)

    def _bring_up(self, name: str, inactive: bool, file: ParameterFile | None, logger: str) -> ServiceResponse:
        if name not in self._registry.controllers:
            loaded = self._registry.load(name, file)
            if not loaded.ok:
                self._log.fatal(logger, f"Failed loading controller {name}")
                return loaded
        if self._registry.controllers[name].state == "unconfigured":
            configured = self._registry.configure(name)
            if not configured.ok:
                self._log.error(logger, f"Failed to configure controller : {name}")
                return configured
        if inactive:
            return ServiceResponse(True)
        answer, switch = self._checker.check([name], [], Strictness.STRICT)
        if switch is not None:
            self._apply(switch)
        if not answer.ok:
            self._log.error(logger, f"Failed to activate controller : {name}")
        return answer


@dataclass(frozen=True, slots=True)
class ChainConnection:
    """controller_manager_msgs/ChainConnection."""

    name: str
    reference_interfaces: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ControllerState:
    """controller_manager_msgs/ControllerState."""

    name: str
    state: str
    type: str
    is_async: bool
    update_rate: int
    claimed_interfaces: tuple[str, ...]
    required_command_interfaces: tuple[str, ...]
    required_state_interfaces: tuple[str, ...]
    is_chainable: bool
    is_chained: bool
    exported_state_interfaces: tuple[str, ...]
    reference_interfaces: tuple[str, ...]
    chain_connections: tuple[ChainConnection, ...]


@dataclass(frozen=True, slots=True)
class HardwareInterface:
    """controller_manager_msgs/HardwareInterface."""

    name: str
    data_type: str
    is_available: bool
    is_claimed: bool


@dataclass(frozen=True, slots=True)
class HardwareComponentState:
    """controller_manager_msgs/HardwareComponentState."""

    name: str
    type: str
    is_async: bool
    rw_rate: int
    plugin_name: str
    state: str
    command_interfaces: tuple[HardwareInterface, ...]
    state_interfaces: tuple[HardwareInterface, ...]


@dataclass(frozen=True, slots=True)
class HardwareInterfaces:
    """The answer of list_hardware_interfaces."""

    command_interfaces: tuple[HardwareInterface, ...]
    state_interfaces: tuple[HardwareInterface, ...]


class Listing:
    """Lists controllers, components and interfaces.

    Args:
        registry: the controllers.
        hardware: the components, None where the description was refused.
        table: the interfaces.
        rate: rate of the manager (Hz).
    """

    def __init__(
        self, registry: ControllerRegistry, hardware: HardwareSet | None, table: InterfaceTable, rate: int
    ) -> None:
        self._registry = registry
        self._hardware = hardware
        self._table = table
        self._rate = rate

    def controllers(self) -> tuple[ControllerState, ...]:
        """All loaded controllers, in the order of their loading."""
        return tuple(self._controller(name) for name in self._registry.controllers)

    def _controller(self, name: str) -> ControllerState:
        loaded = self._registry.controllers[name]
        configured = loaded.state in ("inactive", "active")
        controller = loaded.controller
        references = controller.reference_interfaces() if configured else ()
        commands = controller.command_interfaces() if configured else ()
        claimed = tuple(claim for claim in loaded.claims if self._is_available(claim))
        return ControllerState(
            name,
            loaded.state,
            loaded.type,
            False,
            loaded.rate,
            claimed,
            commands,
            controller.state_interfaces() if configured else (),
            bool(references),
            loaded.chained,
            references,
            tuple(reference.split("/", 1)[1] for reference in references),
            self._connections(commands),
        )

    def _connections(self, commands: tuple[str, ...]) -> tuple[ChainConnection, ...]:
        followers: dict[str, list[str]] = {}
        for command in commands:
            exporter = self._registry.exporter(command)
            if exporter is not None:
                followers.setdefault(exporter.name, []).append(command)
        return tuple(ChainConnection(name, tuple(references)) for name, references in followers.items())

    def _is_available(self, interface: str) -> bool:
        exporter = self._registry.exporter(interface)
        if exporter is not None:
            return exporter.state == "active"
        return self._hardware is not None and self._hardware.is_available(interface)

    def _exists(self, interface: str) -> bool:
        if self._registry.exporter(interface) is not None:
            return True
        return self._hardware is not None and self._hardware.owner(interface) is not None

    def _interface(self, name: str, command: bool) -> HardwareInterface:
        available = self._is_available(name)
        claimed = command and available and name in self._table.claims
        return HardwareInterface(name, self._table.data_type(name), available, claimed)

    def interfaces(self) -> HardwareInterfaces:
        """All interfaces, by name."""
        commands = [name for name in sorted(self._table.command_names()) if self._exists(name)]
        states = [name for name in sorted(self._table.state_names()) if self._exists(name)]
        return HardwareInterfaces(
            tuple(self._interface(name, True) for name in commands),
            tuple(self._interface(name, False) for name in states),
        )

    def components(self) -> tuple[HardwareComponentState, ...]:
        """All components, in the order of the description."""
        hardware = [] if self._hardware is None else list(self._hardware.components.values())
        return tuple(
            HardwareComponentState(
                component.name,
                component.system.info.type,
                component.system.info.is_async,
                component.system.info.rw_rate or self._rate,
                component.system.info.plugin,
                component.state,
                tuple(self._interface(name, True) for name in component.system.command_names),
                tuple(self._interface(name, False) for name in component.system.state_names),
            )
            for component in hardware
        )
