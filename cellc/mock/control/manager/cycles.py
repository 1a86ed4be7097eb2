"""Update cycles: read, update the controllers, switch, write; one by one, or adopted from a block computed ahead."""

from __future__ import annotations

import numpy as np

from cellc.mock.control.controllers.base import Cycle
from cellc.mock.control.errors import UpdateError
from cellc.mock.control.hardware import CommandLimiter, Disturbances
from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.manager.hardware_set import Component, HardwareSet
from cellc.mock.control.manager.lookahead import Lookahead
from cellc.mock.control.manager.registry import ControllerRegistry, LoadedController
from cellc.mock.control.manager.settings import NODE_NAME
from cellc.mock.control.manager.switching import Switch, Switcher

_SHORTEST_BLOCK = 64
_LONGEST_BLOCK = 2048
_GROWTH = 4
# Cycles after the one in which a decision is expected: a block that contains it ends right before it.
_BEYOND_DECISION = 2


class CycleRunner:
    """Runs the cycles of the manager.

    Args:
        registry: the controllers.
        hardware: the components.
        switcher: carries out switches.
        table: the interfaces.
        limiter: limits commands, None where limits are not enforced.
        disturbances: faults.
        log: the log.
        period_ns: period of the manager.
        rate: rate of the manager (Hz).
        start_ns: time of the first cycle.
    """

    def __init__(
        self,
        registry: ControllerRegistry,
        hardware: HardwareSet,
        switcher: Switcher,
        table: InterfaceTable,
        limiter: CommandLimiter | None,
        disturbances: Disturbances,
        log: Log,
        period_ns: int,
        rate: int,
        start_ns: int,
    ) -> None:
        self._registry = registry
        self._hardware = hardware
        self._table = table
        self._switcher = switcher
        self._ahead = Lookahead(table, hardware, limiter, rate, period_ns)
        self._disturbances = disturbances
        self._log = log
        self._period_ns = period_ns
        self._rate = rate
        self._length = _SHORTEST_BLOCK
        self._next_alone = False
        self._pending: Switch | None = None
        self._skipped = 0
        self.next_ns = start_ns

    def request(self, switch: Switch) -> None:
        """Carry out a switch at the end of the next cycle."""
        self.discard()
        self._pending = switch

    def apply(self, switch: Switch, now_ns: int) -> None:
        """Carry out a switch now."""
        self.discard()
        self._switcher.apply(switch, now_ns)

    def apply_pending(self, now_ns: int) -> None:
        """Carry out the requested switch, if there is one."""
        if self._pending is not None:
            switch, self._pending = self._pending, None
            self.apply(switch, now_ns)

    def skip(self, cycles: int) -> None:
        """Miss the next cycles."""
        self._skipped += cycles

    def first_time_ns(self) -> int:
        """Time of the next cycle that is not missed."""
        return self.next_ns + self._skipped * self._period_ns

    def discard(self) -> None:
        """Void what was computed ahead, since something was asked from outside."""
        self._next_alone = False
        if self._ahead.remaining:
            self._ahead.discard()
            self._length = max(self._length // 2, _SHORTEST_BLOCK)

    def run(self, cycles: int) -> int:
        """Run at least one and at most so many cycles.

        Returns:
            The time of the last one.
        """
        if not self._ahead.remaining and not self._next_alone and self._blocks_allowed():
            self._compute_ahead(cycles)
        if self._ahead.remaining:
            time_ns = self._ahead.adopt(cycles, self._log)
            self.next_ns = time_ns + self._period_ns
            return time_ns
        self._length = _SHORTEST_BLOCK
        self._next_alone = False
        return self._run_single()

    def _compute_ahead(self, wanted: int) -> None:
        """Compute a block of the cycles that are wanted and those after, not much longer than until a controller
        expects to decide something; none where one of them decides immediately.
        """
        active = [loaded for loaded in self._registry.in_update_order() if loaded.state == "active"]
        if any(loaded.last_update_ns is None or loaded.controller.decides_next for loaded in active):
            return
        expected = [loaded.controller.expected_updates() for loaded in active]
        longest = max(self._length, min(wanted, _LONGEST_BLOCK))
        length = min([longest, *(updates + _BEYOND_DECISION for updates in expected if updates is not None)])
        self._ahead.compute(active, self.next_ns, length)
        self._next_alone = self._ahead.remaining < length
        self._length = min(self._length * _GROWTH, _LONGEST_BLOCK)

    def _blocks_allowed(self) -> bool:
        return (
            self._pending is None
            and self._skipped == 0
            and not self._disturbances.pending()
            and not self._hardware.single_cycles_only(self._rate)
        )

    # -- single cycles -----------------------------------------------------------------------------------------------

    def _run_single(self) -> int:
        time_ns = self.first_time_ns()
        period_ns = (self._skipped + 1) * self._period_ns
        self._skipped = 0
        self.next_ns = time_ns + self._period_ns
        self._log.now_ns = time_ns
        self._stop_failed(self._hardware.read(time_ns, period_ns, self._rate), "read", time_ns)
        failed = [
            loaded
            for loaded in self._registry.in_update_order()
            if loaded.state == "active"
            and loaded.updates_in_cycle(time_ns, self._rate)
            and not self._update(loaded, time_ns, period_ns)
        ]
        if failed:
            names = " ".join(loaded.name for loaded in failed)
            text = f"Deactivating controllers : [ {names} ] as their update resulted in an error!"
            self._log.error(NODE_NAME, text)
            for loaded in failed:
                self._switcher.deactivate_failed(loaded, time_ns, text)
                self._switcher.activate_fallbacks(loaded.name, time_ns)
        self.apply_pending(time_ns)
        self._stop_failed(self._hardware.write(), "write", time_ns)
        return time_ns

    def _update(self, loaded: LoadedController, time_ns: int, period_ns: int) -> bool:
        cycle = Cycle(time_ns, loaded.since_ns(time_ns, period_ns, self._rate))
        loaded.last_update_ns = time_ns
        try:
            loaded.controller.update(cycle)
        except UpdateError as error:
            if error.reason:
                self._log.error(
                    NODE_NAME,
                    f"Caught exception of type : St13runtime_error while updating controller '{loaded.name}': "
                    f"{error.reason}",
                )
            return False
        if self._table.journal.listening:
            stamps = np.array([time_ns], dtype=np.int64)
            self._table.journal.add(loaded.name, loaded.columns.tolist(), stamps, self._table.command[None, :])
        return True

    def _stop_failed(self, failed: list[Component], what: str, time_ns: int) -> None:
        """Finalize components whose cycle failed, and deactivate all controllers that use them."""
        for component in failed:
            text = (
                f"Deactivating following hardware components as their {what} cycle resulted in an error: "
                f"[ {component.name} ]"
            )
            self._hardware.fail(component, text)
            used = {*component.system.command_names, *component.system.state_names}
            users = [
                loaded
                for loaded in self._registry.controllers.values()
                if loaded.state == "active" and used & self._interfaces_of(loaded)
            ]
            reason = (
                f"Deactivating following controllers as their hardware components {what} cycle resulted in an error: "
                f"[ {' '.join(loaded.name for loaded in users)} ]"
            )
            self._log.error(NODE_NAME, reason)
            for loaded in users:
                self._switcher.deactivate(loaded, time_ns, reason)

    def _interfaces_of(self, loaded: LoadedController) -> set[str]:
        controller = loaded.controller
        return {*controller.command_interfaces(), *controller.state_interfaces()}
