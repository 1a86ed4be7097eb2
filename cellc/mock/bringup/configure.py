"""Configure: load and configure every controller; none is active yet."""

from __future__ import annotations

from cellc.mock.bringup.log_reasons import LogMark
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.plant import Plant
from cellc.mock.result import StageEvidence


def configure(plant: Plant) -> Waiting[StageEvidence]:
    """Spawn every controller as inactive, one by one, with the parameters of its file, and connect every adapter."""
    yield Wait(plant.now_ns)
    facts: list[str] = []
    problems: list[str] = []
    for name, entry in plant.contract.managers.items():
        manager = plant.control.managers[name]
        for controller, declared in entry.controllers.items():
            if "mock" not in declared.targets:
                facts.append(f"`{controller}` is left out: it is for real hardware alone")
                continue
            mark = LogMark(manager)
            response = manager.spawn((controller,), inactive=True)
            if response.ok:
                facts.append(f"`{controller}` is configured")
            else:
                problems.append(f"`{controller}` cannot be configured: {mark.reasons() or response.reason}")
    for device, server in plant.control.adapters.items():
        server.adapter.connect()
        facts.append(f"the adapter of `{device}` is connected and {server.adapter.phase.value}")
    if not problems:
        plant.control.subscribe_joint_states()
    return StageEvidence("configure", tuple(facts), tuple(problems))
