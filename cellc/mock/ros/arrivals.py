"""What arrives from the graph, handed to the part of the run that it is meant for."""

from __future__ import annotations

from collections.abc import Callable

from cellc.mock.ros.bridge import Bridge, Received
from cellc.mock.ros.incoming import MalformedMessageError
from cellc.mock.ros.judgment import Judgment, Violation

Taker = Callable[[Received], bool]
"""Takes what is meant for it, and tells whether it was."""


class Arrivals:
    """Takes what the nodes under test send, in the order in which it arrives."""

    def __init__(self, bridge: Bridge, judgment: Judgment) -> None:
        """Begin without a taker."""
        self._bridge = bridge
        self._judgment = judgment
        self._takers: list[tuple[str, Taker]] = []

    def go_to(self, node: str, taker: Taker) -> None:
        """Hand what a node sends on to a taker, where it is meant for that."""
        self._takers.append((node, taker))

    def hear(self, within_s: float = 0.0) -> Received | None:
        """Take what has arrived, and return it; None where nothing arrives in time."""
        received = self._bridge.take(within_s)
        if received is not None:
            for node, taker in self._takers:
                try:
                    if taker(received):
                        break
                except MalformedMessageError as error:
                    self._judgment.note(Violation.MALFORMED, node, f"`{node}` sent {error}")
                    break
        return received

    def hear_all(self) -> None:
        """Take all that has arrived."""
        while self.hear() is not None:
            pass
