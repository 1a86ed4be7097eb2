"""A camera: stamped images at its rate, each delivered after exposure and transport."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.contract.contract import ContractCamera
from cellc.mock.bus.topic import Topic
from cellc.mock.clocks import Clock
from cellc.mock.engine.simulation import Simulation

DEFAULT_TRANSPORT_S = 0.005
"""Where the contract states no transport time: readout and copy of one image on a local bus."""


@dataclass(frozen=True, slots=True)
class Image:
    """What is known of an image: when its exposure began, and which one it is.

    Attributes:
        stamp_ns: begin of the exposure on the clock of the camera.
        taken_ns: the same in simulated time, which no node knows.
    """

    stamp_ns: int
    taken_ns: int
    frame: str
    sequence: int


class Camera:
    """Publishes one stream; a frozen camera repeats its last image with its old stamp.

    Attributes:
        frozen: set by a fault.
        last: the image delivered last.
    """

    def __init__(
        self,
        device: str,
        facts: ContractCamera,
        topic: Topic[Image],
        transport_s: float | None,
        clock: Clock,
        simulation: Simulation,
    ) -> None:
        """Bind the camera to its topic; ``transport_s`` is the time from readout to arrival."""
        self.device = device
        self.frozen = False
        self.last: Image | None = None
        self._facts = facts
        self._topic = topic
        self._clock = clock
        self._simulation = simulation
        transport = DEFAULT_TRANSPORT_S if transport_s is None else transport_s
        self._latency_ns = round((facts.exposure_s + transport) * 1e9)

    def start(self) -> None:
        """Stream from now on."""
        begun_ns = self._simulation.now_ns
        rate_hz = self._facts.rate_hz

        def deliver(sequence: int) -> None:
            taken_ns = begun_ns + round(sequence * 1e9 / rate_hz)
            self._deliver(Image(self._clock.read(taken_ns), taken_ns, self._facts.frame, sequence))

        self._simulation.every(begun_ns + self._latency_ns, rate_hz, deliver)

    def _deliver(self, image: Image) -> None:
        if not self.frozen or self.last is None:
            self.last = image
        self._topic.publish(self.device, self.last)
