"""Update cycles: read, update the controllers, switch, write; one by one or in blocks.

A block is computed in three steps. Controllers write the commands of coming cycles as if nothing happened; limits and
hardware turn them into states; controllers tell up to which cycle really nothing happened. The cycles up to there are
adopted, and the one after them is done alone.
"""

from __future__ import annotations

import numpy as np

from cellc.mock.control.block import Block
from cellc.mock.control.controllers.base import Cycle
from cellc.mock.control.errors import UpdateError
from cellc.mock.control.hardware import CommandLimiter, Disturbances
from cellc.mock.control.interfaces import InterfaceTable, Times
from cellc.mock.control.log import Log
from cellc.mock.control.manager.hardware_set import Component, HardwareSet
from cellc.mock.control.manager.loaded import LoadedController
from cellc.mock.control.manager.registry import ControllerRegistry
from cellc.mock.control.manager.settings import NODE_NAME
from cellc.mock.control.manager.switching import Switch, Switcher

_SHORTEST_BLOCK = 16
_LONGEST_BLOCK = 1024


class _Part:
    """The updates of one controller within a block.

    Args:
        loaded: the controller.
        rows: cycles of the block in which it is updated.
        block: its updates.
    """

    def __init__(self, loaded: LoadedController, rows: Times, block: Block) -> None:
        self.loaded = loaded
        self.rows = rows
        self.block = block


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
    ) -> None:
        self._registry = registry
        self._hardware = hardware
        self._switcher = switcher
        self._table = table
        self._limiter = limiter
        self._disturbances = disturbances
        self._log = log
        self._period_ns = period_ns
        self._rate = rate
        self._length = _SHORTEST_BLOCK
        self._pending: Switch | None = None
        self._skipped = 0
        self.next_ns = 0

    def request(self, switch: Switch) -> None:
        """Carry out a switch at the end of the next cycle."""
        self._pending = switch

    def apply(self, switch: Switch, now_ns: int) -> None:
        """Carry out a switch now."""
        self._length = _SHORTEST_BLOCK
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

    def run(self, cycles: int) -> int:
        """Run at least one and at most so many cycles.

        Returns:
            The time of the last one.
        """
        active = [loaded for loaded in self._registry.in_update_order() if loaded.state == "active"]
        done = self._run_block(active, min(cycles, self._length)) if self._blocks_allowed() and cycles > 1 else 0
        if done:
            self._length = min(self._length * 2, _LONGEST_BLOCK)
            return self.next_ns - self._period_ns
        self._length = max(self._length // 2, _SHORTEST_BLOCK)
        return self._run_single()

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
            and loaded.is_due(time_ns, self._rate)
            and not self._update(loaded, time_ns, period_ns)
        ]
        if failed:
            names = " ".join(loaded.name for loaded in failed)
            text = f"Deactivating controllers : [ {names} ] as their update resulted in an error!"
            self._log.error(NODE_NAME, text)
            for loaded in failed:
                self._switcher.deactivate_failed(loaded, time_ns, text)
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

    # -- blocks ------------------------------------------------------------------------------------------------------

    def _run_block(self, active: list[LoadedController], cycles: int) -> int:
        """Run regular cycles at once; returns how many, 0 where the next one has to be done alone."""
        times = self.next_ns + self._period_ns * np.arange(cycles, dtype=np.int64)
        self._log.now_ns = self.next_ns
        block = Block(times, self._period_ns, np.empty((cycles, len(self._table.command))), np.empty((0, 0)))
        block.command[:] = self._table.command
        parts = []
        for loaded in active:
            part = self._part(loaded, block)
            if part is None:
                continue
            parts.append(part)
            cycles = min(cycles, self._previewed(part, block))
            if cycles == 0:
                return 0
        cycles = self._read(block, cycles)
        for part in parts:
            if cycles:
                cycles = min(cycles, self._regular(part, block, cycles))
        if cycles:
            self._commit(parts, block.cut(cycles))
        return cycles

    def _part(self, loaded: LoadedController, block: Block) -> _Part | None:
        """The updates of a controller, None where there is none in the block."""
        if loaded.last_update_ns is None:
            return _Part(loaded, np.empty(0, dtype=np.int64), block)
        divisor = loaded.divisor(self._rate, self._period_ns)
        if divisor == 1:
            return _Part(loaded, np.arange(len(block)), block)
        first = divisor - (self.next_ns - loaded.last_update_ns) // self._period_ns
        rows = np.arange(max(first, 0), len(block), divisor)
        if not len(rows):
            return None
        own = Block(block.times_ns[rows], divisor * self._period_ns, block.command[rows], block.state)
        return _Part(loaded, rows, own)

    def _previewed(self, part: _Part, block: Block) -> int:
        """Let a controller write its commands, limited, into the block; returns the regular cycles."""
        if not len(part.rows):
            return 0
        loaded, own = part.loaded, part.block
        updates = loaded.controller.preview(own)
        if updates and self._limiter is not None:
            updates = min(updates, self._limiter.limit_block(own.cut(updates), loaded.columns.tolist()))
        if own is not block and len(loaded.columns):
            first = int(part.rows[0])
            lasting = np.searchsorted(part.rows, np.arange(first, len(block)), side="right") - 1
            block.command[first:, loaded.columns] = own.command[lasting][:, loaded.columns]
        return _cycles(part, updates, len(block))

    def _read(self, block: Block, cycles: int) -> int:
        """Compute the states of the first cycles; returns how many could be computed."""
        block.state = np.empty((cycles, len(self._table.state)))
        block.state[:] = self._table.state
        before = np.empty((cycles, block.command.shape[1]))
        before[0] = self._table.command
        before[1:] = block.command[: cycles - 1]
        for component in self._hardware.components.values():
            if component.available:
                cycles = min(cycles, component.system.read(before, block.state, self._period_ns))
        return cycles

    def _regular(self, part: _Part, block: Block, cycles: int) -> int:
        """Ask a controller which cycles are regular, with the states known."""
        rows = part.rows[part.rows < cycles]
        if not len(rows):
            return cycles
        own = part.block
        state = block.state[:cycles] if own is block else block.state[rows]
        seen = Block(own.times_ns[: len(rows)], own.period_ns, own.command[: len(rows)], state)
        updates = len(rows)
        if self._limiter is not None and len(part.loaded.columns):
            updates = self._limiter.first_out_of_bounds(seen, part.loaded.columns.tolist())
        if updates:
            updates = min(updates, part.loaded.controller.regular(seen.cut(updates)))
        return _cycles(part, updates, cycles)

    def _commit(self, parts: list[_Part], block: Block) -> None:
        cycles = len(block)
        for component in self._hardware.components.values():
            component.system.commit(cycles)
            component.last_read_ns = int(block.times_ns[-1])
        for part in parts:
            rows = part.rows[part.rows < cycles]
            if not len(rows):
                continue
            own = part.block
            state = block.state if part.rows is None or len(rows) == cycles else block.state[rows]
            done = Block(own.times_ns[: len(rows)], own.period_ns, own.command[: len(rows)], state)
            part.loaded.controller.commit(done)
            part.loaded.last_update_ns = int(done.times_ns[-1])
            if self._limiter is not None:
                self._limiter.commit(done, part.loaded.columns.tolist())
        self._table.command[:] = block.command[-1]
        self._table.state[:] = block.state[-1]
        self.next_ns = int(block.times_ns[-1]) + self._period_ns
        self._log.now_ns = int(block.times_ns[-1])


def _cycles(part: _Part, updates: int, cycles: int) -> int:
    """Cycles of the manager before the first update that is not regular."""
    return int(part.rows[updates]) if updates < len(part.rows) else cycles
