"""A cell after its bring-up, copied for every run whose bring-up would be the same.

What a run draws, where things really are and what clocks read, reaches the control stack by the task's goals alone. So
controllers start alike in every run of a rehearsal; cameras, networks and transforms, which see what was drawn, are
made again and catch up. A run of ten seconds of a six-joint arm takes 10 ms of processor time less with it.
"""

from __future__ import annotations

import io
import pickle
from typing import Any

from cellc.contract.frozen import dataclass
from cellc.contract.limits import Limits, limits
from cellc.mock.bringup import Bringup, announce
from cellc.mock.control.parameters import Parameter
from cellc.mock.control.robot_description import RobotDescription
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.nodes.perception import PROCESSING_S
from cellc.mock.plant import Plant
from cellc.mock.result import StageEvidence
from cellc.robot.description.model import Description
from cellc.robot.physics.scene import Scene
from cellc.robot.planning import Springs

_SHARED = (Description, RobotDescription, Parameter, Springs, Scene)
"""What no run changes; a parameter has checks that are functions, and springs a model, which are not copied."""
_SMALL_OFFSET_NS = 100_000_000
"""Clocks that read so much more or less have no stamp that a lookup of transforms takes for another question."""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A control stack after the bring-up, with what is to be known of the rest.

    Attributes:
        content: the stack, as bytes.
        shared: what the bytes refer to.
        at_ns: simulated time.
        announced_ns: when robot_state_publisher was heard first.
        events: that had happened by then.
    """

    content: bytes
    shared: tuple[object, ...]
    evidence: tuple[StageEvidence, ...]
    at_ns: int
    announced_ns: int
    events: int

    def control(self) -> ControlStack:
        """Return a copy of the stack, without listeners."""
        stack: ControlStack = _Reader(io.BytesIO(self.content), self.shared).load()
        for server in stack.servers():
            server.journal.listening = False
        return stack

    def resume(self, plant: Plant) -> None:
        """Bring what is not copied to the time of the copy; the plant has started its nodes, and has a copied stack."""
        plant.simulation.catch_up(self.announced_ns)
        announce(plant)
        plant.simulation.catch_up(self.at_ns, self.events)
        for server in plant.control.servers():
            if not server.journal.listening:
                server.journal.take()


class _Writer(pickle.Pickler):
    def __init__(self, file: io.BytesIO) -> None:
        super().__init__(file, protocol=pickle.HIGHEST_PROTOCOL)
        self.shared: list[object] = []

    def persistent_id(self, obj: Any) -> int | None:
        """Refer to what is shared."""
        if not isinstance(obj, _SHARED):
            return None
        self.shared.append(obj)
        return len(self.shared) - 1


class _Reader(pickle.Unpickler):
    def __init__(self, file: io.BytesIO, shared: tuple[object, ...]) -> None:
        super().__init__(file)
        self._shared = shared

    def persistent_load(self, pid: Any) -> object:
        """Return what is shared."""
        return self._shared[pid]


class SnapshotMemory:
    """Copies of one cell, by the limits that held."""

    def __init__(self) -> None:
        self._kept: dict[Limits, Snapshot | None] = {}

    def get(self) -> Snapshot | None:
        """Return what is known; None where nothing is, or the stack of this cell cannot be copied."""
        return self._kept.get(limits())

    def bring_up(self, plant: Plant, bringup: Bringup) -> None:
        """Bring a plant up, and keep a copy of it where that passes and no copy was tried before.

        What controllers command meanwhile is recorded, for the runs in which somebody wants to know it.
        """
        quiet = [server.journal for server in plant.control.servers() if not server.journal.listening]
        for journal in quiet:
            journal.listening = True
        plant.simulation.run_process(bringup.run())
        if bringup.passed and limits() not in self._kept:
            self._kept[limits()] = _copy(plant, tuple(bringup.evidence))
        for journal in quiet:
            journal.listening = False
            journal.take()


def _copy(plant: Plant, evidence: tuple[StageEvidence, ...]) -> Snapshot | None:
    """Return a copy; None of a plant that cannot be copied, or whose runs do not start alike."""
    announced_ns = plant.robot_state_publisher.announced_ns
    if announced_ns is None or not has_same_bring_up(plant):
        return None
    file = io.BytesIO()
    writer = _Writer(file)
    try:
        writer.dump(plant.control)
    except (pickle.PicklingError, AttributeError, TypeError):  # a controller has what only it can make
        return None
    simulation = plant.simulation
    return Snapshot(file.getvalue(), tuple(writer.shared), evidence, simulation.now_ns, announced_ns, simulation.events)


def has_same_bring_up(plant: Plant) -> bool:
    """Return whether the bring-up of this plant is independent of every number that a run draws.

    The bring-up looks up transforms and records them. Joint states must therefore arrive as they are published, without
    noise, on one clock that reads about the simulated time, and before the first observation of an object.
    """
    histories = plant.control.histories.values()
    readings = {plant.clocks.of(history.broadcaster).read(0) for history in histories}
    return (
        plant.clocks.steady
        and len(readings) == 1
        and abs(min(readings)) < _SMALL_OFFSET_NS
        and not plant.control.adapters
        and not any(facts.noise for facts in plant.contract.simulated_joints.values())
        and all(feed.undelayed for feed in plant.task.feeds)
        and plant.robot_state_publisher.undelayed
        and all(history.first_ns is not None and history.first_ns <= PROCESSING_S * 1e9 for history in histories)
        and plant.simulation.next_foreground_ns() is None
    )
