"""Activates controllers as an operator does: one strict switch, then a look at what became of it."""

from __future__ import annotations

from cellc.mock.bringup.log_reasons import LogMark
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.plant import Plant

_SETTLE_CYCLES = 5
"""A controller that activates and throws in its first update is seen a few cycles later."""


def activate(plant: Plant, manager_name: str, controllers: tuple[str, ...]) -> Waiting[tuple[str, ...]]:
    """Activate controllers of one manager one after the other; return the problems, in the words of the manager."""
    manager = plant.control.managers[manager_name]
    problems: list[str] = []
    for controller in controllers:
        mark = LogMark(manager)
        response = manager.switch_controllers([controller], [])
        until_ns = plant.now_ns + _SETTLE_CYCLES * manager.period_ns
        while plant.now_ns < until_ns:
            yield Wait(until_ns)
        states = {entry.name: entry.state for entry in manager.list_controllers()}
        if states.get(controller) != "active":
            reason = mark.reasons() or response.message or f"it is {states.get(controller, 'not loaded')}"
            problems.append(f"`{controller}` cannot be activated: {reason}")
    return tuple(problems)
