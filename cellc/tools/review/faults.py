"""Faults and steps of rehearsals as people read them: when they begin, how long they last, and by how much."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.base import Json
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, Rehearsals
from cellc.contract.steps import StepKind
from cellc.robot.description.model import Description
from cellc.tools.review.units import shown


def of_rehearsals(rehearsals: Rehearsals, body: Description) -> Json:
    """Return rehearsals as data, with each fault and each wait as a text.

    Args:
        body: whose joints tell whether a fault displaces by a length or by an angle.
    """
    return [_of_rehearsal(entry, body) for entry in rehearsals.rehearsals]


def _of_rehearsal(entry: RehearsalEntry, body: Description) -> Json:
    data: dict[str, Json] = entry.model_dump(mode="json")
    steps, told = data["steps"], [" ".join(_of_fault(fault, body)) for fault in entry.faults]
    assert isinstance(steps, list)
    waits = [
        f"wait {shown(step.duration_s, 's')}" if step.kind == StepKind.WAIT else each
        for step, each in zip(entry.steps, steps, strict=True)
    ]
    return {**data, "steps": waits, "faults": [*told]}


def _of_fault(fault: FaultEntry, body: Description) -> Iterator[str]:
    slides = any(joint.name == fault.target and joint.type == "prismatic" for joint in body.joints)
    length, speed = ("m", "m/s") if slides else ("rad", "rad/s")
    yield fault.kind.value
    yield fault.target
    yield from _begin(fault.event) if fault.event is not None else ()
    for word, value, unit in (
        ("at", fault.at_s, "s"),
        ("by", fault.delay_s, "s"),
        ("by", fault.jump_s, "s"),
        ("by", fault.displacement, length),
        ("by", fault.size_m, "m"),
        ("to", fault.velocity, speed),
        ("to", fault.factor, "ratio"),
        ("for", fault.lasting_s, "s"),
    ):
        yield from [f"{word} {shown(value, unit)}"] if value is not None else ()
    yield from [f"at phase {fault.phase.value}"] if fault.phase is not None else ()
    yield from [f"for {fault.cycles} cycles"] if fault.cycles is not None else ()


def _begin(event: FaultEvent) -> Iterator[str]:
    yield f"at step {event.step} {event.when}"
    yield from [f"after {shown(event.after_s, 's')}"] if event.after_s else ()
