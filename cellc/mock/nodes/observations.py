"""The task's view of what perception publishes: the newest observation of each frame that has reached it."""

from __future__ import annotations

from collections.abc import Callable

from cellc.contract.contract import Contract
from cellc.contract.entities import ContractInterface
from cellc.mock.bus.edge import Subscription
from cellc.mock.bus.topic import Topic
from cellc.mock.clocks import Clock
from cellc.mock.engine.process import Signal
from cellc.mock.engine.simulation import Simulation
from cellc.mock.nodes.executors import Executors
from cellc.mock.nodes.perception import POSE_TYPE, ObjectPose

DEFAULT_MAX_AGE_S = 0.2
"""Where no interface states how old an observation may be."""


def pose_interface(contract: Contract, frame: str) -> tuple[str, ContractInterface] | None:
    """Return the topic on which a dynamic frame's publisher states its pose in the frame's parent, with its name."""
    entry = contract.frames[frame]
    for name, interface in sorted(contract.interfaces.items()):
        sources = [source.node for source in interface.sources]
        if interface.type == POSE_TYPE and interface.frame == entry.parent and entry.authority in sources:
            return name, interface
    return None


def oldest_observation_s(interface: ContractInterface | None) -> float:
    """Return how old an observation may be; without an interface where poses reach the task by /tf alone."""
    stated_s = None if interface is None else interface.max_age_s
    return DEFAULT_MAX_AGE_S if stated_s is None else stated_s


class ObservationInbox:
    """Receives the poses of one frame.

    Attributes:
        arrived: fires with each pose.
        newest: the pose that arrived last.
        arrived_ns: when it arrived.
        max_age_s: older observations are stale.
        on_stale: the reaction to a stale observation in the contract.
        lapsed_ns: arrival of the last pose that was stale, or whose predecessor was; None where there was none.
    """

    def __init__(self, interface: ContractInterface | None, clock: Clock, simulation: Simulation) -> None:
        """Bind the inbox to the contract of the topic; None where poses reach the task by /tf alone.

        Args:
            clock: of the task, on which ages are measured.
        """
        self.arrived = Signal(from_background=True)
        self.newest: ObjectPose | None = None
        self.arrived_ns: int | None = None
        self.lapsed_ns: int | None = None
        self.max_age_s = oldest_observation_s(interface)
        self.on_stale = "reject_goal" if interface is None or interface.on_stale is None else interface.on_stale
        self._clock = clock
        self._simulation = simulation
        self._subscription: Subscription[ObjectPose] | None = None
        self._listeners: list[Callable[[ObjectPose], None]] = []

    def listen(self, listener: Callable[[ObjectPose], None]) -> None:
        """Call ``listener`` with every pose that reaches the task."""
        self._listeners.append(listener)

    def subscribe(self, topic: Topic[ObjectPose], node: str, executors: Executors) -> None:
        """Subscribe as a node of the contract, whose executor takes what has arrived."""
        self._subscription = topic.subscribe(node, lambda: self._arrive(executors))

    def age_s(self, stamp_ns: int) -> float:
        """Return the age of a stamp in seconds, negative for one from the future."""
        return (self._clock.read(self._simulation.now_ns) - stamp_ns) / 1e9

    def is_stale(self, stamp_ns: int, allowance_s: float = 0.0) -> bool:
        """Return whether a stamp is too old to act on, ``allowance_s`` beyond the bound of the contract.

        A stamp as far in the future as that bound is stale, too: a clock was set back.
        """
        age_ns = self._clock.read(self._simulation.now_ns) - stamp_ns
        max_age_ns = round(self.max_age_s * 1e9)
        too_old = age_ns > max_age_ns + round(allowance_s * 1e9)
        return self.on_stale != "continue" and (too_old or age_ns < -max_age_ns)

    def stale_from_ns(self, stamp_ns: int) -> int:
        """Return the first simulated instant, from now on, at which an observation of this stamp is too old."""
        return self._clock.when(stamp_ns + round(self.max_age_s * 1e9) + 1, self._simulation.now_ns)

    def lapsed_since(self, since_ns: int) -> bool:
        """Tell whether at some instant since then, or now, the newest observation was none to act on."""
        stale = self.newest is None or self.is_stale(self.newest.stamp_ns)
        return stale or (self.lapsed_ns is not None and self.lapsed_ns >= since_ns)

    def describe(self, frame: str) -> str:
        """Say how old the newest observation of ``frame`` is."""
        if self.newest is None:
            return f"no observation of {frame} has arrived"
        return f"newest {self.describe_age(frame, self.newest.stamp_ns)}"

    def describe_age(self, frame: str, stamp_ns: int) -> str:
        """Say how old an observation of ``frame`` is that has a stamp."""
        age_s = self.age_s(stamp_ns)
        aged = f"{age_s:.3f} s old" if age_s > 0.0 else f"stamped {-age_s:.3f} s in the future"
        return f"observation of {frame} is {aged}, {self.max_age_s:g} s allowed"

    def accept(self, pose: ObjectPose) -> None:
        """Take note of a pose that has reached the task."""
        before, self.newest = self.newest, pose
        self.arrived_ns = self._simulation.now_ns
        if self.is_stale(pose.stamp_ns) or (before is not None and self.is_stale(before.stamp_ns)):
            self.lapsed_ns = self._simulation.now_ns
        self.arrived.fire(self._simulation.now_ns)
        for listener in self._listeners:
            listener(pose)

    def _arrive(self, executors: Executors) -> None:
        processing = None if self._subscription is None else self._subscription.endpoint.processing
        if processing is None:
            self._receive()
        else:
            executors.execute(processing, self._receive)

    def _receive(self) -> None:
        received = None if self._subscription is None else self._subscription.take(self._simulation.now_ns)
        if received is not None:
            self.accept(received.sample)
