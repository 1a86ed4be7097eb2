"""What the middleware tells of its contracts: the events of rmw, counted by endpoint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum


class QosEventKind(str, Enum):
    """Names of rmw_event_type_t, without the prefix; the values say what happened in words."""

    OFFERED_DEADLINE_MISSED = "offered deadline missed"
    REQUESTED_DEADLINE_MISSED = "requested deadline missed"
    LIVELINESS_LOST = "liveliness lost"
    LIVELINESS_CHANGED = "liveliness changed"
    OFFERED_QOS_INCOMPATIBLE = "offered QoS incompatible"
    REQUESTED_QOS_INCOMPATIBLE = "requested QoS incompatible"
    MESSAGE_LOST = "message lost"


@dataclass(frozen=True, slots=True)
class QosEvent:
    """One event of an endpoint; ``detail`` says what rmw puts in the status beside the count."""

    kind: QosEventKind
    topic: str
    node: str
    at_ns: int
    count: int = 1
    detail: str = ""


class QosEvents:
    """The events of all endpoints so far.

    Attributes:
        log: every event in order.
    """

    def __init__(self) -> None:
        self.log: list[QosEvent] = []
        self._listeners: list[Callable[[QosEvent], None]] = []

    def listen(self, listener: Callable[[QosEvent], None]) -> None:
        """Call ``listener`` with every event from now on."""
        self._listeners.append(listener)

    def note(self, event: QosEvent) -> None:
        """Note an event."""
        self.log.append(event)
        for listener in self._listeners:
            listener(event)

    def total(self, kind: QosEventKind, topic: str, node: str) -> int:
        """Return the total count of an endpoint, as its status says."""
        return sum(event.count for event in self.log if (event.kind, event.topic, event.node) == (kind, topic, node))

    def lines(self) -> tuple[str, ...]:
        """Return one line for each endpoint and kind of event, in the order in which they came first.

        Incompatible endpoints are left out: they are found, with the policy, before anything is sent.
        """
        totals: dict[tuple[str, str, QosEventKind], int] = {}
        for event in self.log:
            if event.kind not in (QosEventKind.OFFERED_QOS_INCOMPATIBLE, QosEventKind.REQUESTED_QOS_INCOMPATIBLE):
                key = (event.topic, event.node, event.kind)
                totals[key] = totals.get(key, 0) + event.count
        return tuple(f"`{topic}` at `{node}`: {kind.value}, {count} x" for (topic, node, kind), count in totals.items())
