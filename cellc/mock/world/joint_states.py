"""The recent joint states of one broadcaster, as arrays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.mock.control import JointStateBlock
from cellc.mock.errors import LimitReachedError

JOINT_STATE_TYPE = "sensor_msgs/msg/JointState"

NEVER_NS = 10**15
"""A delay that is longer than any rehearsal."""

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class LateArrival:
    """States stamped from ``from_ns`` up to ``until_ns`` (None is for ever) arrive ``delay_ns`` after their stamp."""

    from_ns: int
    until_ns: int | None
    delay_ns: int


class JointStateHistory:
    """Stamped positions of the joints of one broadcaster over a bounded time.

    Attributes:
        names: joints in the order of the columns; empty before the first message.
        subscribed: somebody collects the messages of the broadcaster.
        silent: the broadcaster is not active, so that messages which stay away are no missed cycles.
        period_ns: of the update cycles in which it may publish.
        first_ns: stamp of its first message, of whichever joints; None before.
    """

    def __init__(
        self, horizon_s: float, period_ns: int, foreign: frozenset[str] = frozenset(), broadcaster: str = ""
    ) -> None:
        """Keep at least ``horizon_s`` seconds of messages that come every ``period_ns``.

        Args:
            foreign: joints that another controller manager drives. The one description names all hardware, so that
                this manager simulates them too, and only the other one knows where they are.
            broadcaster: controller that publishes the messages; it stamps them on its own clock, where the stamps here
                are simulated time.
        """
        self.broadcaster = broadcaster
        self.names: tuple[str, ...] = ()
        self._late: list[LateArrival] = []
        self.subscribed = False
        self.silent = False
        self.period_ns = period_ns
        self._keep = int(horizon_s * 1e9 / period_ns) + 2
        self._foreign = foreign
        self._missed = 0
        self._resumed = False
        self._spacing_ns: int | None = None
        self._published: tuple[str, ...] = ()
        self._columns: list[int] = []
        self._stamps: IntArray = np.empty(0, dtype=np.int64)
        self._positions: FloatArray = np.empty((0, 0))
        self._count = 0
        self.first_ns: int | None = None

    def __getstate__(self) -> dict[str, object]:
        """Return what a copy has: room for the messages that are there, unless old ones are to be dropped."""
        size = self._count if self._count <= self._keep else len(self._stamps)
        return {**self.__dict__, "_stamps": self._stamps[:size], "_positions": self._positions[:size]}

    def append(self, block: JointStateBlock) -> None:
        """Add the messages that a broadcaster published; a message of other joints than before starts again."""
        size = len(block.stamps_ns)
        if size == 0:
            return
        if self.first_ns is None:
            self.first_ns = int(block.stamps_ns[0])
        if block.names != self._published:
            self._published = block.names
            self._columns = [index for index, name in enumerate(block.names) if name not in self._foreign]
            names = tuple(block.names[index] for index in self._columns)
            if names != self.names:
                self._restart(names)
        self._make_room(size)
        self._stamps[self._count : self._count + size] = block.stamps_ns
        positions = block.positions if len(self._columns) == len(block.names) else block.positions[:, self._columns]
        self._positions[self._count : self._count + size] = positions
        self._count_missed(max(0, self._count - 1), self._count + size)
        self._resumed = False
        self._count += size

    @property
    def stamps(self) -> IntArray:
        """Stamps of the kept messages in nanoseconds, rising."""
        return self._stamps[: self._count]

    @property
    def positions(self) -> FloatArray:
        """Positions of the kept messages, shape (messages, joints)."""
        return self._positions[: self._count]

    def arrived(self, now_ns: int) -> int:
        """Return how many of the kept messages have arrived by ``now_ns``, late ones not counted."""
        if not self._late:
            return int(self.stamps.searchsorted(now_ns, side="right"))
        here = np.flatnonzero(self.arrivals(self.stamps) <= now_ns)
        return int(here[-1]) + 1 if here.size else 0

    def arrivals(self, stamps_ns: IntArray) -> IntArray:
        """Return when messages arrive that were published at ``stamps_ns``."""
        arrivals: IntArray = stamps_ns.copy()
        for late in self._late:
            until = np.iinfo(np.int64).max if late.until_ns is None else late.until_ns
            arrivals[(stamps_ns >= late.from_ns) & (stamps_ns < until)] += late.delay_ns
        return arrivals

    def missed_until(self, now_ns: int) -> int:
        """Return how many messages were due by ``now_ns`` and never published: update cycles that were missed."""
        if self._spacing_ns is None or self.silent or self._resumed:
            return self._missed
        return self._missed + max(0, (now_ns - int(self.stamps[-1])) // self._spacing_ns - 1)

    def count_again(self) -> None:
        """Forget the cycles that were missed up to now."""
        self._missed = 0

    def hold_back(self, from_ns: int, delay_ns: int = NEVER_NS) -> None:
        """Let messages that are stamped from an instant on arrive late."""
        self._late.append(LateArrival(from_ns, None, delay_ns))

    def release(self, until_ns: int, delay_ns: int = NEVER_NS) -> None:
        """Let messages that are stamped from an instant on arrive without a delay that began before."""
        for index, late in enumerate(self._late):
            if late.until_ns is None and late.delay_ns == delay_ns:
                self._late[index] = replace(late, until_ns=until_ns)
                return

    @property
    def is_delayed(self) -> bool:
        """Tell whether some messages arrive later than they are stamped."""
        return bool(self._late)

    @property
    def unbroken(self) -> bool:
        """Tell whether the broadcaster publishes in every cycle, so that no message is missed while cycles go on."""
        return self._spacing_ns == self.period_ns and not (self.silent or self._resumed or self._late)

    def note_active(self, active: bool) -> None:
        """Take note that the broadcaster was activated or deactivated."""
        self._resumed = self._resumed or (self.silent and active)
        self.silent = not active

    def at(self, stamp_ns: int) -> dict[str, float]:
        """Return the positions at a time, linear between messages and held beyond the first and last."""
        stamps, positions = self.stamps, self.positions
        if not stamps.size:
            return {}
        after = int(stamps.searchsorted(stamp_ns, side="left"))
        if after == 0 or after == stamps.size:
            row = positions[min(after, stamps.size - 1)]
        else:
            span = int(stamps[after] - stamps[after - 1])
            fraction = int(stamp_ns - stamps[after - 1]) / span
            row = (1.0 - fraction) * positions[after - 1] + fraction * positions[after]
        return dict(zip(self.names, row.tolist(), strict=True))

    def _restart(self, names: tuple[str, ...]) -> None:
        self.names = names
        if 2 * self._keep * len(names) > limits().mock_samples:
            what = f"a buffer of {self._keep} joint states of {len(names)} joints is kept"
            raise LimitReachedError(f"{what}, at most {limits().mock_samples // 2} values may be", "mock-samples")
        self._stamps = np.empty(2 * self._keep, dtype=np.int64)
        self._positions = np.empty((2 * self._keep, len(names)))
        self._count = 0

    def _make_room(self, size: int) -> None:
        if self._count + size <= len(self._stamps):
            return
        remaining = min(self._count, self._keep)
        capacity = max(2 * self._keep, remaining + size)
        stamps: IntArray = np.empty(capacity, dtype=np.int64)
        positions: FloatArray = np.empty((capacity, len(self.names)))
        stamps[:remaining] = self._stamps[self._count - remaining : self._count]
        positions[:remaining] = self._positions[self._count - remaining : self._count]
        self._stamps, self._positions, self._count = stamps, positions, remaining

    def _count_missed(self, first: int, last: int) -> None:
        stamps = self._stamps[first + 1 if self._resumed else first : last]
        gaps = stamps[1:] - stamps[:-1]
        if not gaps.size:
            return
        least = int(gaps.min())
        self._spacing_ns = least if self._spacing_ns is None else min(self._spacing_ns, least)
        if int(gaps.max()) > self._spacing_ns:
            self._missed += int(np.sum(np.rint(gaps / self._spacing_ns).astype(np.int64) - 1))
