"""Who approves, who answers for what, the way back after a stop, and what only the real cell can prove."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell

_QUESTIONS = {
    "graph": "Is there one command publisher or action server?",
    "time_tf": "Which stamp and calibration produced the goal?",
    "controller": "Are joints, interfaces, tolerance and hold defined?",
    "vendor": "Are firmware, driver, mode and scaling pinned?",
    "network": "Do discovery and data use controlled paths?",
    "safety": "Are stop, recovery and observer independent?",
    "data": "Can failures be replayed by layer?",
}


def approvals(cell: Cell) -> Iterator[str]:
    """Yield the seven approval areas with the question that each answers."""
    yield "| area | question | owner |"
    yield "|---|---|---|"
    for area, owner in cell.spec.owners.approvals:
        yield f"| {area} | {_QUESTIONS[area]} | {owner} |"


def responsibilities(cell: Cell) -> Iterator[str]:
    """Yield the responsibilities with their owners."""
    yield "| responsibility | owner |"
    yield "|---|---|"
    for name, owner in cell.spec.owners.responsibilities:
        yield f"| {name} | {owner} |"


def recovery(cell: Cell) -> Iterator[str]:
    """Yield who acknowledges a stop, and the steps of every device."""
    recovery = cell.spec.safety.recovery
    yield f"Acknowledged by: {recovery.acknowledge}. Owner: {recovery.owner}."
    yield f"After a reconnect: {recovery.on_reconnect}."
    for device in cell.devices:
        steps = () if device.facts.safety is None else device.facts.safety.recovery
        for way in steps:
            yield ""
            yield f"{device.name}, {way.state}:"
            yield ""
            yield from (f"{number}. {step}" for number, step in enumerate(way.steps, 1))


def not_provable(cell: Cell) -> Iterator[str]:
    """Yield what the catalogue says that no mock shows, by device and vendor."""
    for device in cell.devices:
        of = f"{device.name} ({device.facts.vendor} {device.facts.model})"
        yield from (f"- {of}: {text}" for text in device.facts.mock_cannot_prove)
