"""Cycles that are computed ahead at once, and adopted piece by piece as time advances.

A block is computed in three steps. Controllers write the commands of coming cycles as if nothing happened; limits and
hardware turn them into states; controllers tell up to which cycle really nothing happened. The cycles up to there may
be adopted, and the one after them has to be done alone. Whatever is asked of the manager from outside makes the rest of
the block void.

It is worth its lines: 40 campaign runs of a six-joint arm took 5.5 s of processor time with blocks, start included, and
were not done after 49 s cycle by cycle; ten runs took 1.9 s and 8.3 s. The results were the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellc.mock.control.hardware import CommandLimiter
from cellc.mock.control.interfaces import Block, Columns, InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.manager.hardware_set import HardwareSet
from cellc.mock.control.manager.registry import LoadedController


@dataclass(frozen=True, slots=True)
class _Part:
    """The updates of one controller within a block.

    Attributes:
        loaded: the controller.
        rows: cycles of the block in which it is updated.
        block: its updates; the block itself where it is updated in every cycle.
        columns: columns that it commands.
    """

    loaded: LoadedController
    rows: Columns
    block: Block
    columns: list[int]

    def updates_within(self, cycles: int) -> int:
        """Return how many of the updates lie in the first cycles of the block."""
        count = len(self.rows)
        if count and int(self.rows[-1]) == count - 1:  # every cycle up to there has an update
            return min(cycles, count)
        return int(np.searchsorted(self.rows, cycles))


class Lookahead:
    """Regular cycles from the present on.

    Args:
        table: the interfaces.
        hardware: the components.
        limiter: limits commands, None where limits are not enforced.
        rate: rate of the manager (Hz).
        period_ns: its period.
    """

    def __init__(
        self, table: InterfaceTable, hardware: HardwareSet, limiter: CommandLimiter | None, rate: int, period_ns: int
    ) -> None:
        self._table = table
        self._hardware = hardware
        self._limiter = limiter
        self._rate = rate
        self._period_ns = period_ns
        self._parts: list[_Part] = []
        self._block: Block | None = None
        self._done = 0

    @property
    def remaining(self) -> int:
        """Cycles that can still be adopted."""
        return 0 if self._block is None else len(self._block) - self._done

    def discard(self) -> None:
        """Void what is not adopted yet."""
        self._block = None

    def compute(self, active: list[LoadedController], first_ns: int, cycles: int) -> None:
        """Compute up to so many cycles; none remain where the first of them has to be done alone.

        Args:
            active: the active controllers in the order of their updates.
            first_ns: time of the first cycle.
            cycles: the number of cycles.
        """
        self._block, self._done, self._parts = None, 0, []
        times = first_ns + self._period_ns * np.arange(cycles, dtype=np.int64)
        block = Block(times, self._period_ns, np.empty((cycles, len(self._table.command))), np.empty((0, 0)))
        block.command[:] = self._table.command
        for loaded in active:
            part = self._part(loaded, block)
            if part is None:
                continue
            self._parts.append(part)
            cycles = min(cycles, self._previewed(part, block))
            if cycles == 0:
                return
        cycles = self._read(block, cycles)
        for part in self._parts:
            if cycles:
                cycles = min(cycles, self._regular(part, block, cycles))
        if cycles:
            self._block = block.cut(cycles)

    def _part(self, loaded: LoadedController, block: Block) -> _Part | None:
        """The updates of a controller, None where there is none in the block."""
        columns = loaded.columns.tolist()
        if loaded.last_update_ns is None:
            # Its first update is never part of a block.
            return _Part(loaded, np.empty(0, dtype=np.intp), block, columns)
        divisor = loaded.divisor(self._rate, self._period_ns)
        if divisor == 1:
            return _Part(loaded, np.arange(len(block)), block, columns)
        first = divisor - (int(block.times_ns[0]) - loaded.last_update_ns) // self._period_ns
        rows = np.arange(max(first, 0), len(block), divisor)
        if not len(rows):
            return None
        own = Block(block.times_ns[rows], divisor * self._period_ns, block.command[rows], block.state)
        return _Part(loaded, rows, own, columns)

    def _previewed(self, part: _Part, block: Block) -> int:
        """Let a controller write its commands, limited, into the block; returns the regular cycles."""
        if not len(part.rows):
            return 0
        own = part.block
        updates = part.loaded.controller.preview(own)
        if updates and self._limiter is not None:
            updates = min(updates, self._limiter.limit_block(own.cut(updates), part.columns))
        if own is not block and part.columns:
            first = int(part.rows[0])
            lasting = np.searchsorted(part.rows, np.arange(first, len(block)), side="right") - 1
            block.command[first:, part.columns] = own.command[lasting][:, part.columns]
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

    def _seen(self, part: _Part, block: Block, cycles: int) -> Block:
        """The updates of a controller within the first cycles, with their states."""
        own = part.block
        count = part.updates_within(cycles)
        state = block.state[:cycles] if count == cycles else block.state[part.rows[:count]]
        return Block(own.times_ns[:count], own.period_ns, own.command[:count], state)

    def _regular(self, part: _Part, block: Block, cycles: int) -> int:
        """Ask a controller which cycles are regular, with the states known."""
        seen = self._seen(part, block, cycles)
        updates = len(seen)
        if updates and self._limiter is not None and part.columns:
            updates = self._limiter.first_out_of_bounds(seen, part.columns)
        if updates:
            updates = min(updates, part.loaded.controller.regular(seen.cut(updates)))
        return min(_cycles(part, updates, cycles), cycles) if len(seen) else cycles

    def adopt(self, cycles: int, log: Log) -> int:
        """Adopt at most so many of the remaining cycles.

        Returns:
            The time of the last adopted one.
        """
        block = self._block
        assert block is not None, "only cycles that remain are adopted"
        before, self._done = self._done, min(self._done + cycles, len(block))
        last = self._done - 1
        for component in self._hardware.components.values():
            if component.available:
                component.system.commit(self._done)
                component.last_read_ns = int(block.times_ns[last])
        for part in self._parts:
            start = part.updates_within(before)
            seen = self._seen(part, block, self._done)
            if start < len(seen):
                part.loaded.controller.commit(seen, start)
                self._table.journal.add(part.loaded.name, part.columns, seen.times_ns[start:], seen.command[start:])
                part.loaded.last_update_ns = int(seen.times_ns[-1])
                if self._limiter is not None:
                    self._limiter.commit(seen, part.columns)
        self._table.command[:] = block.command[last]
        self._table.state[:] = block.state[last]
        log.now_ns = int(block.times_ns[last])
        return log.now_ns


def _cycles(part: _Part, updates: int, cycles: int) -> int:
    """Cycles of the manager before the first update that is not regular."""
    return int(part.rows[updates]) if updates < len(part.rows) else cycles
