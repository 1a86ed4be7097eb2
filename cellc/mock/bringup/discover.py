"""Discover: is the hardware described, and do the declared endpoints connect?"""

from __future__ import annotations

from cellc.mock.bus.matching import unmatched_pairs
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.plant import Plant
from cellc.mock.result import StageEvidence


def discover(plant: Plant) -> Waiting[StageEvidence]:
    """List hardware components and endpoints; a description that was refused is a problem.

    Endpoints that do not connect are facts: the cell comes up without the data, as it does in reality.
    """
    yield Wait(plant.now_ns)
    facts: list[str] = []
    problems: list[str] = []
    for name, manager in plant.control.managers.items():
        if manager.description_error:
            problems.append(f"`{name}`: robot description refused: {manager.description_error}")
        components = manager.list_hardware_components()
        facts += [f"`{name}`: hardware component `{entry.name}` is {entry.state}" for entry in components]
    facts += unmatched_pairs(plant.contract)
    return StageEvidence("discover", tuple(facts), tuple(problems))
