"""The controller manager as its clients see it: services, actions, topics and simulated time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from cellc.contract.control_law import ControlLaw
from cellc.contract.vocabulary import Behavior, Distro
from cellc.mock.control.controllers.base import Controller, DeclaredInterfaces
from cellc.mock.control.controllers.broadcasters import JointStateBlock, JointStateBroadcaster
from cellc.mock.control.controllers.forward_command import ForwardCommandController, GpioCommandController
from cellc.mock.control.controllers.joint_trajectory import JointTrajectoryController
from cellc.mock.control.controllers.joint_trajectory.recorder import Recorder, Recording
from cellc.mock.control.hardware.forces import Forces
from cellc.mock.control.manager.assembly import NodeOptions, assemble
from cellc.mock.control.manager.services import (
    ControllerState,
    GoalDesk,
    HardwareComponentState,
    HardwareInterfaces,
    Listing,
    Spawner,
    SpawnResponse,
)
from cellc.mock.control.manager.switching import Strictness, Switch
from cellc.mock.control.messages import (
    CancelResponse,
    ControlEvent,
    Goal,
    GoalResponse,
    HardwareStateResponse,
    ParameterResponse,
    ServiceResponse,
    Trajectory,
    TrajectoryStateResponse,
)
from cellc.mock.control.parameters import ParameterError, ParameterFile, ParameterValue
from cellc.robot.description.model import Description
from cellc.robot.planning import Springs


class ControllerManager:
    """A simulated ros2_control_node.

    Args:
        robot_description: the text of a URDF, or what was read of it before.
        parameters: text of the parameter file (controllers.yaml); empty for none.
        namespace: namespace of the manager and its controllers.
        distro: ROS distribution.
        plugin_behaviors: behavior of further controller plugin types.
        start_ns: simulated time of the first update cycle.
        declared: interfaces of controllers that only the cell tells, by name.
        forces: what moves the joints; None where they are where they are led to.

    Raises:
        ManagerAbortedError: where the real process would end while it starts.
    """

    def __init__(
        self,
        robot_description: str | Description,
        parameters: str,
        *,
        namespace: str = "",
        distro: Distro = Distro.KILTED,
        plugin_behaviors: Mapping[str, Behavior] | None = None,
        start_ns: int = 0,
        declared: Mapping[str, DeclaredInterfaces] | None = None,
        forces: Forces | None = None,
    ) -> None:
        options = NodeOptions(namespace, distro, plugin_behaviors or {}, start_ns, declared or {}, forces)
        stack = assemble(robot_description, parameters, options, self.interrupt)
        self.log, self.disturbances = stack.log, stack.disturbances
        self.journal = stack.table.journal
        self.description_error = stack.description_error
        self.period_ns = stack.period_ns
        self.now_ns = start_ns
        self._table, self._events = stack.table, stack.events
        self._registry, self._hardware, self._checker = stack.registry, stack.hardware, stack.checker
        self._cycles = stack.cycles
        self._listing = Listing(stack.registry, stack.hardware, stack.table, stack.rate)
        self._goals = GoalDesk(stack.registry, stack.log)
        self._spawner = Spawner(stack.registry, stack.checker, self._apply, stack.log)

    # -- services ----------------------------------------------------------------------------------------------------

    def spawn(self, names: Sequence[str], inactive: bool = False, parameters: str | None = None) -> SpawnResponse:
        """Bring controllers up as one call of the spawner does; switches act immediately.

        Args:
            names: controllers in order; the first failure stops the rest.
            inactive: configure them only.
            parameters: text of the file given with --param-file.
        """
        self.interrupt()
        if self._cycles is None:
            # Without a robot description the services are not offered and the spawner waits without an answer.
            return SpawnResponse(False, "", self.description_error, tuple(names))
        file = None if parameters is None else ParameterFile(parameters)
        return self._spawner.spawn(names, inactive, file)

    def load_controller(self, name: str) -> ServiceResponse:
        """Answer load_controller."""
        self.interrupt()
        return self._registry.load(name, None)

    def configure_controller(self, name: str) -> ServiceResponse:
        """Answer configure_controller."""
        self.interrupt()
        return self._registry.configure(name)

    def cleanup_controller(self, name: str) -> ServiceResponse:
        """Answer cleanup_controller."""
        self.interrupt()
        return self._registry.cleanup(name)

    def unload_controller(self, name: str) -> ServiceResponse:
        """Answer unload_controller."""
        self.interrupt()
        return self._registry.unload(name)

    def switch_controllers(
        self, activate: Sequence[str], deactivate: Sequence[str], strictness: Strictness = Strictness.STRICT
    ) -> ServiceResponse:
        """Answer switch_controller; what it says is carried out at the end of the next update cycle."""
        if self._cycles is not None:
            self._cycles.apply_pending(self.now_ns)
        answer, switch = self._checker.check(activate, deactivate, strictness)
        if switch is not None and self._cycles is not None:
            self._cycles.request(switch)
        return answer

    def _apply(self, switch: Switch) -> None:
        if self._cycles is not None:
            self._cycles.apply_pending(self.now_ns)
            self._cycles.apply(switch, self.now_ns)

    def list_controllers(self) -> tuple[ControllerState, ...]:
        """Answer list_controllers."""
        return self._listing.controllers()

    def list_hardware_components(self) -> tuple[HardwareComponentState, ...]:
        """Answer list_hardware_components."""
        return self._listing.components()

    def list_hardware_interfaces(self) -> HardwareInterfaces:
        """Answer list_hardware_interfaces."""
        return self._listing.interfaces()

    def set_hardware_component_state(self, name: str, state: str) -> HardwareStateResponse:
        """Answer set_hardware_component_state."""
        self.interrupt()
        if self._hardware is None:
            return HardwareStateResponse(False)
        return self._hardware.set_state(name, state)

    def set_parameter(self, controller: str, name: str, value: ParameterValue) -> ParameterResponse:
        """Answer set_parameters of a controller's node for one parameter."""
        self.interrupt()
        loaded = self._registry.controllers[controller]
        try:
            loaded.context.parameters.set(name, value)
        except ParameterError as error:
            return ParameterResponse(False, error.reason)
        loaded.controller.parameter_changed(name, value)
        return ParameterResponse(True)

    def interrupt(self) -> None:
        """Void what was computed ahead: something is asked, or done, from outside."""
        if self._cycles is not None:
            self._cycles.discard()

    # -- time --------------------------------------------------------------------------------------------------------

    def advance(self, until_ns: int) -> int:
        """Run update cycles and action monitors up to a time.

        Args:
            until_ns: the time to reach; a cycle scheduled exactly then is run.

        Returns:
            The time that was reached: earlier than asked for where something happened that the outside must see,
            which is then among the events.
        """
        before = len(self._events)
        while len(self._events) == before:
            controllers = self._controllers()
            monitor_ns = min((t for c in controllers if (t := c.next_monitor_ns()) is not None), default=until_ns + 1)
            horizon = min(until_ns, monitor_ns)
            if self._cycles is not None and self._cycles.first_time_ns() <= horizon:
                due = (horizon - self._cycles.first_time_ns()) // self.period_ns + 1
                self.now_ns = self._cycles.run(due)
                continue
            self.now_ns = self.log.now_ns = max(horizon, self.now_ns)
            if monitor_ns > until_ns:
                break
            for controller in controllers:
                controller.monitor(self.now_ns)
        return self.now_ns

    def _controllers(self) -> list[Controller]:
        configured = ("inactive", "active")
        return [loaded.controller for loaded in self._registry.controllers.values() if loaded.state in configured]

    def take_events(self) -> tuple[ControlEvent, ...]:
        """Hand over what happened since the last time, in order."""
        events = tuple(self._events)
        self._events.clear()
        return events

    # -- actions and topics ------------------------------------------------------------------------------------------

    def send_goal(self, controller: str, goal: Goal, feedback: bool = False) -> GoalResponse:
        """Send a goal to a controller's action; `feedback` asks for feedback events."""
        self.interrupt()
        return self._goals.send(controller, goal, self.now_ns, feedback)

    def cancel_goal(self, goal_id: int) -> CancelResponse:
        """Ask to cancel one goal."""
        self.interrupt()
        return self._goals.cancel(goal_id, self.now_ns)

    def cancel_all(self, controller: str) -> CancelResponse:
        """Ask to cancel all goals of a controller."""
        self.interrupt()
        return self._goals.cancel_all(controller, self.now_ns)

    def publish_trajectory(self, controller: str, trajectory: Trajectory) -> str:
        """Publish to `~/joint_trajectory`; returns why the controller ignored it, empty where it did not."""
        self.interrupt()
        return self._goals.take_trajectory(controller, trajectory, self.now_ns)

    def publish_commands(self, controller: str, data: Sequence[float]) -> None:
        """Publish to `~/commands` of a forward command controller."""
        self.interrupt()
        publisher = self._registry.controllers[controller].controller
        assert isinstance(publisher, ForwardCommandController), f"{controller} takes no lists of commands"
        publisher.receive(data)

    def publish_gpio_commands(self, controller: str, values: Mapping[str, float]) -> None:
        """Publish to `~/commands` of a gpio command controller, values by full interface name."""
        self.interrupt()
        publisher = self._registry.controllers[controller].controller
        assert isinstance(publisher, GpioCommandController), f"{controller} takes no gpio commands"
        publisher.receive(values)

    def publish_speed_scaling(self, controller: str, factor: float) -> None:
        """Publish to `~/speed_scaling_input` of a trajectory controller."""
        self.interrupt()
        self._trajectory_controller(controller).scaling.set(factor)

    def query_state(self, controller: str, time_ns: int) -> TrajectoryStateResponse:
        """Answer `~/query_state` of a trajectory controller."""
        return self._trajectory_controller(controller).query_state(time_ns)

    def _trajectory_controller(self, name: str) -> JointTrajectoryController:
        trajectory = self._registry.controllers[name].controller
        assert isinstance(trajectory, JointTrajectoryController), f"{name} is no trajectory controller"
        return trajectory

    # -- values ------------------------------------------------------------------------------------------------------

    def state(self, name: str) -> float:
        """Present value of a state interface."""
        return float(self._table.state[self._table.state_column(name)])

    def command(self, name: str) -> float:
        """Present value of a command interface."""
        return float(self._table.command[self._table.command_column(name)])

    def joint_positions(self) -> dict[str, float]:
        """Present positions of all joints that have a position state."""
        names = [name for name in self._table.state_names() if name.endswith("/position") and name.count("/") == 1]
        return {name.removesuffix("/position"): self.state(name) for name in names}

    def bind(self, component: str, law: ControlLaw, springs: Springs) -> None:
        """Let the joints of a component follow by a law, or by the one that binds them with another load."""
        self.interrupt()
        if self._hardware is not None and component in self._hardware.components:
            self._hardware.components[component].system.bind(law, springs)

    def write_state(self, name: str, value: float) -> None:
        """Let the outside world set a state interface that no command moves: a sensor, a speed scaling factor."""
        self.interrupt()
        self._table.state[self._table.state_column(name)] = value

    def has_local_topics(self, controller: str) -> bool:
        """Tell whether a joint state broadcaster publishes below its own name alone."""
        return self._broadcaster(controller).is_local

    def subscribe_joint_states(self, controller: str) -> None:
        """Collect what a joint state broadcaster publishes, from the next cycle on."""
        self.interrupt()
        self._broadcaster(controller).listen()

    def take_joint_states(self, controller: str) -> tuple[JointStateBlock, ...]:
        """Hand over the joint states that were published since the last time."""
        return self._broadcaster(controller).take()

    def _broadcaster(self, name: str) -> JointStateBroadcaster:
        broadcaster = self._registry.controllers[name].controller
        assert isinstance(broadcaster, JointStateBroadcaster), f"{name} is no joint state broadcaster"
        return broadcaster

    def record(self, controller: str, rate_hz: float) -> Recorder:
        """Record a trajectory controller from now on, thinned to a rate; return what records it."""
        self.interrupt()
        trajectory = self._trajectory_controller(controller)
        trajectory.recorder = Recorder(trajectory.interfaces, round(1e9 / rate_hz))
        return trajectory.recorder

    def recording(self, controller: str) -> Recording:
        """What was recorded of a trajectory controller."""
        recorder = self._trajectory_controller(controller).recorder
        assert recorder is not None, f"{controller} is not recorded"
        return recorder.recording()
