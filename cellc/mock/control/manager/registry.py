"""The controllers of the manager: loading, configuring, their schedule and their order."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cellc.contract.vocabulary import Behavior, Distro
from cellc.mock.control.controllers.base import ConfigureError, Context, Controller, DeclaredInterfaces
from cellc.mock.control.controllers.plugins import controller_factory
from cellc.mock.control.hardware import CommandLimiter
from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.manager.settings import NODE_NAME
from cellc.mock.control.messages import ControlEvent, ControllerChanged, ServiceResponse
from cellc.mock.control.parameters import Parameter, ParameterError, ParameterFile, ParameterSet
from cellc.mock.control.robot_description import RobotDescription

# A controller is updated when this share of its period has passed (tolerance for jitter in the real manager).
_DUE = 0.99


@dataclass(slots=True)
class LoadedController:
    """A controller in the manager.

    Attributes:
        name: name of the controller.
        type: its plugin type.
        controller: the controller.
        context: what it was given.
        state: lifecycle state.
        rate: its update rate (Hz).
        claims: command interfaces that it holds.
        columns: their columns.
        last_update_ns: time of its last update since activation.
        chained: whether a preceding controller writes its references.
    """

    name: str
    type: str
    controller: Controller
    context: Context
    state: str = "unconfigured"
    rate: int = 0
    claims: tuple[str, ...] = ()
    columns: NDArray[np.intp] = field(default_factory=lambda: np.empty(0, dtype=np.intp))
    last_update_ns: int | None = None
    chained: bool = False

    def updates_in_cycle(self, time_ns: int, manager_rate: int) -> bool:
        """Return whether it is updated in the cycle at a time."""
        if self.rate >= manager_rate or self.last_update_ns is None:
            return True
        return (time_ns - self.last_update_ns) / 1e9 * self.rate >= _DUE

    def divisor(self, manager_rate: int, period_ns: int) -> int:
        """Cycles of the manager from one update to the next."""
        if self.rate >= manager_rate:
            return 1
        cycles = 1
        while (cycles * period_ns) / 1e9 * self.rate < _DUE:
            cycles += 1
        return cycles

    def since_ns(self, time_ns: int, period_ns: int, manager_rate: int) -> int:
        """Time since its last update, its nominal period for the first."""
        if self.rate >= manager_rate:
            return period_ns
        return 1_000_000_000 // self.rate if self.last_update_ns is None else time_ns - self.last_update_ns


class ControllerRegistry:
    """The loaded controllers.

    Args:
        file: parameters of the manager's process.
        namespace: namespace of the manager.
        distro: ROS distribution.
        behaviors: behaviors of further plugin types.
        log: the log.
        events: receives changes.
        declared: interfaces of controllers that only the contract of the cell states, by name.
    """

    def __init__(
        self,
        file: ParameterFile,
        namespace: str,
        distro: Distro,
        behaviors: Mapping[str, Behavior],
        log: Log,
        events: list[ControlEvent],
        declared: Mapping[str, DeclaredInterfaces],
    ) -> None:
        self._declared = declared
        self._file = file
        self._namespace = namespace
        self._distro = distro
        self._behaviors = behaviors
        self._log = log
        self._events = events
        self._own = file.of_node(NODE_NAME, namespace)
        self.controllers: dict[str, LoadedController] = {}

    def attach(
        self,
        description: RobotDescription,
        table: InterfaceTable,
        limiter: CommandLimiter | None,
        period_ns: int,
        rate: int,
    ) -> None:
        """Tell what controllers work on."""
        self._description, self._table, self._limiter = description, table, limiter
        self._period_ns, self._rate = period_ns, rate

    def _change(self, loaded: LoadedController, state: str) -> None:
        loaded.state = state
        self._events.append(ControllerChanged(self._log.now_ns, loaded.name, state))

    def _refuse(self, text: str) -> ServiceResponse:
        self._log.error(NODE_NAME, text)
        return ServiceResponse(False, text)

    def load(self, name: str, spawner_file: ParameterFile | None) -> ServiceResponse:
        """Answer load_controller; `spawner_file` is the file of the spawner's --param-file."""
        bare = name.rpartition("/")[2]  # one of several namesakes is called by its full name
        parameters = self._file.of_node(bare, self._namespace)
        given = self._own.get(f"{bare}.type")
        if spawner_file is not None:
            from_spawner = spawner_file.of_node(bare, self._namespace)
            parameters.update(from_spawner)
            given = from_spawner.get("type", given)
        if name in self.controllers:
            return self._refuse(f"A controller named '{name}' was already loaded inside the controller manager")
        if not isinstance(given, str) or not given:
            return self._refuse(f"The 'type' param was not defined for '{name}'.")
        factory = controller_factory(given, self._distro, self._behaviors)
        if factory is None:
            return self._refuse(f"Loader for controller '{name}' (type '{given}') not found.")
        context = Context(
            name,
            ParameterSet(parameters),
            self._distro,
            self._period_ns,
            self._rate,
            self._description,
            self._table,
            self._limiter,
            self._log,
            self._events,
            self._declared.get(name, DeclaredInterfaces()),
        )
        try:
            context.parameters.declare(
                (Parameter("update_rate", "integer", self._rate), Parameter("is_async", "bool", False))
            )
            controller = factory(context)
        except ParameterError as error:
            reason = f"Exception thrown during init stage with message: {error.reason}"
            self._log.error(name, reason)
            self._log.error(NODE_NAME, f"Could not initialize the controller named '{name}'")
            return ServiceResponse(False, reason)
        self.controllers[name] = LoadedController(name, given, controller, context)
        self._change(self.controllers[name], "unconfigured")
        return ServiceResponse(True)

    def fallbacks(self, name: str) -> list[str]:
        """Controllers that are activated where a controller fails (`<controller>.fallback_controllers`)."""
        names = self._own.get(f"{name}.fallback_controllers")
        return [str(entry) for entry in names] if isinstance(names, list) else []

    def configure(self, name: str) -> ServiceResponse:
        """Answer configure_controller."""
        loaded = self.controllers.get(name)
        if loaded is None:
            return self._refuse(
                f"Could not configure controller with name '{name}' because no controller with this name exists"
            )
        if loaded.state not in ("unconfigured", "inactive"):
            return self._refuse(f"Controller '{name}' can not be configured from '{loaded.state}' state.")
        loaded.rate = self._achievable_rate(loaded)
        loaded.context.update_rate = loaded.rate
        try:
            loaded.controller.configure()
        except ConfigureError as failure:
            self._log.error(name, failure.reason)
            return self._refuse(
                f"After configuring, controller '{name}' is in state 'unconfigured' , expected inactive."
            )
        for interface in loaded.controller.reference_interfaces():
            self._table.add_command(interface)
            self._table.add_state(interface, float("nan"))
        self._change(loaded, "inactive")
        return ServiceResponse(True)

    def _achievable_rate(self, loaded: LoadedController) -> int:
        """The rate that the manager can give; a higher one is lowered, one that does not divide is rounded up."""
        wanted = int(loaded.context.parameters.number("update_rate"))
        if wanted > self._rate:
            self._log.warn(
                loaded.name,
                f"The update rate of the controller : '{wanted} Hz' should be less than or equal to controller "
                f"manager's update rate : '{self._rate} Hz'!. The controller will be updated at controller_manager's "
                "update rate.",
            )
            return self._rate
        if wanted <= 0 or self._rate % wanted == 0:
            return wanted or self._rate
        achievable = self._rate // math.floor(self._rate / wanted + 0.5)  # std::round: a half goes up
        self._log.warn(
            loaded.name,
            f"The requested update rate of '{wanted}' Hz is not achievable with the controller manager update rate of "
            f"'{self._rate}' Hz. Setting it to the closest achievable frequency '{achievable}' Hz.",
        )
        self._log.warn(
            NODE_NAME,
            f"The controller : {loaded.name} update cycles won't be triggered at a constant period : "
            f"{1.0 / achievable:.6f} sec, as the controller's update rate : {achievable} Hz is not a perfect divisor "
            f"of the controller manager's update rate : {self._rate} Hz!.",
        )
        return achievable

    def cleanup(self, name: str) -> ServiceResponse:
        """Answer cleanup_controller."""
        loaded = self.controllers.get(name)
        if loaded is None:
            return self._refuse(
                f"Could not clean-up controller with name '{name}' because no controller with this name exists"
            )
        if loaded.state == "active":
            return self._refuse(f"Controller '{name}' cannot be cleaned-up from '{loaded.state}' state.")
        self._change(loaded, "unconfigured")
        return ServiceResponse(True)

    def unload(self, name: str) -> ServiceResponse:
        """Answer unload_controller."""
        loaded = self.controllers.get(name)
        if loaded is None:
            return self._refuse(
                f"Could not unload controller with name '{name}' because no controller with this name exists"
            )
        if loaded.state == "active":
            return self._refuse(f"Could not unload controller with name '{name}' because it is still active")
        self._change(loaded, "finalized")
        del self.controllers[name]
        return ServiceResponse(True)

    def exporter(self, reference: str) -> LoadedController | None:
        """The configured controller that offers a reference interface."""
        for loaded in self.controllers.values():
            if loaded.state in ("inactive", "active") and reference in loaded.controller.reference_interfaces():
                return loaded
        return None

    def following(self, loaded: LoadedController) -> list[LoadedController]:
        """Controllers whose references a controller writes."""
        exporters = [self.exporter(name) for name in loaded.controller.command_interfaces()]
        return [exporter for exporter in exporters if exporter is not None]

    def preceding(self, loaded: LoadedController) -> list[LoadedController]:
        """Controllers that write a controller's references."""
        references = set(loaded.controller.reference_interfaces())
        if not references:
            return []
        configured = [c for c in self.controllers.values() if c.state in ("inactive", "active")]
        return [other for other in configured if references & set(other.controller.command_interfaces())]

    def interfaces_of(self, names: Sequence[str]) -> list[str]:
        """Command interfaces of several controllers."""
        controllers = [self.controllers[name].controller for name in names]
        return [interface for controller in controllers for interface in controller.command_interfaces()]

    def in_update_order(self) -> list[LoadedController]:
        """The controllers, each before those whose references it writes."""
        configured = [loaded for loaded in self.controllers.values() if loaded.state in ("inactive", "active")]
        if not any(loaded.controller.reference_interfaces() for loaded in configured):
            return list(self.controllers.values())
        ordered: list[LoadedController] = []

        def place(loaded: LoadedController) -> None:
            if loaded in ordered:
                return
            if loaded.state in ("inactive", "active"):
                for other in self.preceding(loaded):
                    place(other)
            ordered.append(loaded)

        for loaded in self.controllers.values():
            place(loaded)
        return ordered
