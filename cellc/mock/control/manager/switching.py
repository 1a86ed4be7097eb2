"""Switches of controllers: checked before they are accepted, then carried out at the end of a cycle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import IntEnum

from cellc.contract.frozen import dataclass
from cellc.mock.control.hardware import CommandLimiter
from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.manager.hardware_set import HardwareSet
from cellc.mock.control.manager.registry import ControllerRegistry, LoadedController
from cellc.mock.control.manager.settings import NODE_NAME
from cellc.mock.control.messages import ControlEvent, ControllerChanged, ServiceResponse

_NOTHING = "After checking the controllers, no controllers need to be activated or deactivated."
_REJECTED = "Could not switch controllers since prepare command mode switch was rejected."


class Strictness(IntEnum):
    """`strictness` of controller_manager_msgs/srv/SwitchController."""

    UNSPECIFIED = 0
    BEST_EFFORT = 1
    STRICT = 2
    AUTO = 3
    FORCE_AUTO = 4


@dataclass(frozen=True, slots=True)
class Switch:
    """A checked switch; `activate` and `deactivate` in the order of the request.

    Attributes:
        failing: controllers whose activation ends in an error, with its reason; the others are switched all the same.
    """

    activate: tuple[str, ...]
    deactivate: tuple[str, ...]
    failing: tuple[tuple[str, str], ...] = ()


class _RefusedError(Exception):
    """The request is answered with ok false."""


class SwitchChecker:
    """Answers requests to switch, without carrying them out.

    Args:
        registry: the controllers.
        hardware: the components, None where the description was refused.
        table: the interfaces.
        log: the log.
    """

    def __init__(
        self, registry: ControllerRegistry, hardware: HardwareSet | None, table: InterfaceTable, log: Log
    ) -> None:
        self._registry = registry
        self._hardware = hardware
        self._table = table
        self._log = log

    def check(
        self, activate: Sequence[str], deactivate: Sequence[str], strictness: Strictness
    ) -> tuple[ServiceResponse, Switch | None]:
        """Answer a request.

        Returns:
            The answer, and what has to be carried out in the next cycle (None for nothing).
        """
        strict = strictness is Strictness.STRICT
        if strictness is Strictness.AUTO:
            self._log.warn(
                NODE_NAME, "Controller Manager: AUTO is not currently implemented. Defaulting to BEST_EFFORT"
            )
        if strictness is Strictness.UNSPECIFIED:
            self._log.warn(
                NODE_NAME,
                "Controller Manager: to switch controllers you need to specify a strictness level of "
                "controller_manager_msgs::SwitchController::STRICT (2) or ::BEST_EFFORT (1). When unspecified, the "
                "default is BEST_EFFORT",
            )
        try:
            stop = self._known(deactivate, "deactivate", strict)
            start = self._known(activate, "activate", strict)
            start = self._checked_start(start, stop, strict)
            stop = self._checked_stop(stop, start, strict)
            if not start and not stop:
                return ServiceResponse(True, _NOTHING), None
            switch = self._with_restarts(start, stop)
            self._check_interfaces(switch)
            self._check_hardware(switch)
        except _RefusedError as refused:
            return ServiceResponse(False, str(refused)), None
        if failing := tuple(self._failing(switch.activate)):
            names = {name for name, _ in failing}
            rest = tuple(name for name in switch.activate if name not in names)
            answer = self._refuse(f"Failed to activate controller : {', '.join(sorted(names))}")
            return ServiceResponse(False, str(answer)), Switch(rest, switch.deactivate, failing)
        return ServiceResponse(True, _success(switch, strict)), switch

    def _failing(self, names: Sequence[str]) -> Iterator[tuple[str, str]]:
        for name in names:
            if error := self._registry.controllers[name].controller.activation_error():
                self._log.error(name, error)
                yield name, error

    def _refuse(self, text: str) -> _RefusedError:
        self._log.warn(NODE_NAME, text)
        return _RefusedError(text)

    def _known(self, names: Sequence[str], verb: str, strict: bool) -> list[str]:
        known, complaints = [], ""
        for name in names:
            if name in self._registry.controllers:
                known.append(name)
                continue
            text = f"Could not {verb} controller with name '{name}' because no controller with this name exists"
            self._log.error(NODE_NAME, text)
            if strict:
                self._log.error(NODE_NAME, "Aborting, no controller is switched! ('STRICT' switch)")
                raise _RefusedError(text)
            complaints += f"{text}\n"
        if names and not known:
            raise _RefusedError(complaints)
        return known

    def _checked_start(self, start: Sequence[str], stop: Sequence[str], strict: bool) -> list[str]:
        return self._keep(start, [self._start_complaint(name, start, stop) for name in start], "activate", strict)

    def _checked_stop(self, stop: Sequence[str], start: Sequence[str], strict: bool) -> list[str]:
        return self._keep(stop, [self._stop_complaint(name, start, stop) for name in stop], "deactivate", strict)

    def _keep(self, names: Sequence[str], complaints: Sequence[str], verb: str, strict: bool) -> list[str]:
        remaining = []
        for name, complaint in zip(names, complaints, strict=True):
            if not complaint:
                remaining.append(name)
                continue
            self._log.warn(NODE_NAME, complaint)
            self._log.warn(
                NODE_NAME,
                f"Could not {verb} controller with name '{name}'. Check above warnings for more details. Check the "
                "state of the controllers and their required interfaces using `ros2 control list_controllers -v` CLI "
                "to get more information.",
            )
            if strict:
                self._log.error(NODE_NAME, "Aborting, no controller is switched! (::STRICT switch)")
                raise _RefusedError(complaint)
        return remaining

    def _start_complaint(self, name: str, start: Sequence[str], stop: Sequence[str]) -> str:
        loaded = self._registry.controllers[name]
        if loaded.state == "active" and name not in stop:
            return f"Controller with name '{name}' is already active."
        if loaded.state not in ("inactive", "active"):
            return (
                f"Controller with name '{name}' is in '{loaded.state}' state. The controller needs to be configured to "
                "be in 'inactive' state before it can be checked and activated."
            )
        for other in self._registry.following(loaded):
            following = f"The following controller with name '{other.name}' is currently"
            if other.state == "inactive" and other.name not in start:
                return f"{following} inactive and it is not requested to be activated."
            if other.state == "active" and other.name in stop and other.name not in start:
                return f"{following} active but it is requested to be deactivated."
        return ""

    def _stop_complaint(self, name: str, start: Sequence[str], stop: Sequence[str]) -> str:
        loaded = self._registry.controllers[name]
        if loaded.state != "active":
            return f"Controller with name '{name}' can not be deactivated since it is not active."
        for other in self._registry.preceding(loaded):
            if other.state == "active" and other.name not in stop and name not in start:
                return (
                    f"Could not deactivate controller with name '{name}' because preceding controller with name "
                    f"'{other.name}' is active and is not requested to be deactivated."
                )
        return ""

    def _with_restarts(self, start: Sequence[str], stop: Sequence[str]) -> Switch:
        """Add the controllers that have to go in or out of chained mode, which restarts them."""
        activate, deactivate = list(start), list(stop)
        for name in (*start, *stop):
            for other in self._registry.following(self._registry.controllers[name]):
                if other.state == "active" and other.name not in deactivate:
                    deactivate.append(other.name)
                    activate.append(other.name)
        return Switch(tuple(activate), tuple(deactivate))

    def _check_interfaces(self, switch: Switch) -> None:
        taken: set[str] = set()
        for name in switch.activate:
            controller = self._registry.controllers[name].controller
            for interface in controller.command_interfaces():
                prefix = f"Unable to activate controller '{name}' since the command interface '{interface}'"
                if not self._usable(interface, switch) or not self._table.has_command(interface):
                    raise self._refuse(f"{prefix} is not available.")
                owner = self._table.claims.get(interface)
                if owner is not None and owner not in switch.deactivate:
                    raise self._refuse(f"{prefix} is currently claimed by another controller.")
                if interface in taken:
                    raise self._refuse(f"{prefix} will be used by another controller that is being activated.")
                taken.add(interface)
            for interface in controller.state_interfaces():
                if not self._usable(interface, switch) or not self._table.has_state(interface):
                    raise self._refuse(
                        f"Unable to activate controller '{name}' since the state interface '{interface}' is not "
                        "available."
                    )

    def _usable(self, interface: str, switch: Switch) -> bool:
        exporter = self._registry.exporter(interface)
        if exporter is not None:
            return exporter.state == "active" or exporter.name in switch.activate
        return self._hardware is not None and self._hardware.is_available(interface)

    def _check_hardware(self, switch: Switch) -> None:
        """Ask the components of all interfaces whether they accept the switch."""
        if self._hardware is None:
            return
        start, stop = self._registry.interfaces_of(switch.activate), self._registry.interfaces_of(switch.deactivate)
        for interface in stop:
            owner = self._hardware.owner(interface)
            if owner is not None and not owner.available:
                self._log.error("resource_manager", "Not acceptable command interfaces combination: ")
                raise _RefusedError(_REJECTED)
        for component in self._hardware.components.values():
            wanted = [name for name in start if self._hardware.owner(name) is component]
            if wanted and component.state == "inactive":
                self._log.warn(
                    "resource_manager",
                    f"Component '{component.name}' is in INACTIVE state, but has start interfaces to switch: ",
                )
                raise _RefusedError(_REJECTED)
            reasons = component.system.refuse_switch(wanted) if wanted else []
            for reason in reasons:
                self._log.error(component.name, reason)
            refusal = self._hardware.refusal(component) if wanted else ""
            if refusal:
                self._log.error(component.name, refusal)
            if reasons or refusal:
                raise _RefusedError(_REJECTED)


def _success(switch: Switch, strict: bool) -> str:
    lines = ["Successfully switched controllers!"]
    if not strict:
        for title, names in (("Deactivated", switch.deactivate), ("Activated", switch.activate)):
            if names:
                lines.append(f"{title} controllers: [ {' '.join(names)} ]")
    return "\n".join(lines)


class Switcher:
    """Carries out switches that were checked.

    Args:
        registry: the controllers.
        hardware: the components, None where the description was refused.
        table: the interfaces.
        limiter: the limiter, None where limits are not enforced.
        checker: checks the activation of fallback controllers.
        log: the log.
        events: receives changes.
    """

    def __init__(
        self,
        registry: ControllerRegistry,
        hardware: HardwareSet | None,
        table: InterfaceTable,
        limiter: CommandLimiter | None,
        checker: SwitchChecker,
        log: Log,
        events: list[ControlEvent],
    ) -> None:
        self._checker = checker
        self._log = log
        self._registry = registry
        self._hardware = hardware
        self._table = table
        self._limiter = limiter
        self._events = events

    def apply(self, switch: Switch, now_ns: int) -> None:
        """Carry out a checked switch."""
        start, stop = self._registry.interfaces_of(switch.activate), self._registry.interfaces_of(switch.deactivate)
        if self._hardware is not None:
            for component in self._hardware.components.values():
                component.system.switch([name for name in start if self._hardware.owner(name) is component])
        if self._limiter is not None:
            self._limiter.reset([*start, *stop])
        for name in switch.deactivate:
            self.deactivate(self._registry.controllers[name], now_ns, "")
        for name, error in switch.failing:
            self._registry.controllers[name].state = "unconfigured"
            self._events.append(ControllerChanged(now_ns, name, "unconfigured", error))
        for loaded in reversed([c for c in self._registry.in_update_order() if c.name in switch.activate]):
            self._activate(loaded, switch, now_ns)

    def deactivate(self, loaded: LoadedController, now_ns: int, reason: str) -> None:
        """Stop a controller and release its interfaces."""
        loaded.controller.deactivate(now_ns)
        for interface in loaded.claims:
            self._table.claims.pop(interface, None)
        loaded.claims = ()
        loaded.state, loaded.chained = "inactive", False
        self._events.append(ControllerChanged(now_ns, loaded.name, "inactive", reason))

    def deactivate_failed(self, loaded: LoadedController, now_ns: int, reason: str) -> None:
        """Stop a controller whose update failed.

        Controllers that do not release their interfaces themselves keep them in this case, as was observed.
        """
        claims = loaded.claims
        self.deactivate(loaded, now_ns, reason)
        if not loaded.controller.releases_itself:
            loaded.claims = claims
            self._table.claims.update(dict.fromkeys(claims, loaded.name))

    def activate_fallbacks(self, failed: str, now_ns: int) -> None:
        """Activate the fallback controllers of a failed one, those that can be."""
        names = self._registry.fallbacks(failed)
        if not names:
            return
        answer, switch = self._checker.check(names, [], Strictness.STRICT)
        if switch is not None:
            self._log.warn(NODE_NAME, f"Activating fallback controllers of '{failed}' : [ {' '.join(names)} ]")
            self.apply(switch, now_ns)
        else:
            self._log.error(NODE_NAME, f"Fallback controllers of '{failed}' cannot be activated: {answer.message}")

    def _activate(self, loaded: LoadedController, switch: Switch, now_ns: int) -> None:
        loaded.claims = loaded.controller.command_interfaces()
        loaded.columns = self._table.command_columns(loaded.claims)
        for interface in loaded.claims:
            self._table.claims[interface] = loaded.name
        loaded.chained = any(
            other.name in switch.activate or other.state == "active" for other in self._registry.preceding(loaded)
        )
        loaded.last_update_ns = None
        loaded.controller.activate(now_ns)
        loaded.state = "active"
        self._events.append(ControllerChanged(now_ns, loaded.name, "active"))
