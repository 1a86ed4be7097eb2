"""Carrying out of switches: modes of the hardware, claims, transitions of the controllers."""

from __future__ import annotations

from cellc.mock.control.events import ControlEvent, ControllerChanged
from cellc.mock.control.hardware import CommandLimiter
from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.manager.hardware_set import HardwareSet
from cellc.mock.control.manager.loaded import LoadedController
from cellc.mock.control.manager.registry import ControllerRegistry
from cellc.mock.control.manager.settings import NODE_NAME
from cellc.mock.control.manager.switch_checks import Strictness, Switch, SwitchChecker


class Switcher:
    """Carries out switches that were checked.

    Args:
        registry: the controllers.
        hardware: the components, None where the description was refused.
        table: the interfaces.
        limiter: the limiter, None where limits are not enforced.
        checker: checks the activation of fallback controllers.
        log: the log.
        events: where changes are told.
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
