"""Observe: activate what only publishes, and look whether joint states are fresh and the frames complete."""

from __future__ import annotations

from cellc.mock.bringup.activation import activate
from cellc.mock.bus.matching import hears, task_node
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.nodes.robot_state_publisher import NODE
from cellc.mock.plant import Plant
from cellc.mock.result import StageEvidence
from cellc.mock.tf.buffer import Transform

_PATIENCE_NS = 1_000_000_000
_LOOK_NS = 20_000_000
_WATCH_NS = 500_000_000
"""How long states are watched before anything may move; afterwards the buffers hold what an observation needs."""


def observe(plant: Plant) -> Waiting[StageEvidence]:
    """Wait for joint states of every group's joints and for a transform of every fixed frame and link."""
    problems: list[str] = []
    for name, manager in plant.contract.managers.items():
        publishing = tuple(
            controller
            for controller, entry in manager.controllers.items()
            if entry.active and not entry.command_interfaces and "mock" in entry.targets
        )
        problems += yield from activate(plant, name, publishing)
    if problems:
        return StageEvidence("observe", (), tuple(problems))
    until_ns = plant.now_ns + _PATIENCE_NS
    while (missing := _missing_joints(plant)) and plant.now_ns < until_ns:
        yield Wait(plant.now_ns + _LOOK_NS)
    if missing:
        return StageEvidence("observe", (), tuple(f"no state of joint `{joint}` is published" for joint in missing))
    watched_until_ns = plant.now_ns + _WATCH_NS
    while plant.now_ns < watched_until_ns:
        yield Wait(watched_until_ns)
    task = task_node(plant.contract)
    plant.robot_state_publisher.announce(
        plant.buffer,
        hears_static=hears(plant.contract, "/tf_static", NODE, task),
        hears_moving=hears(plant.contract, "/tf", NODE, task),
    )
    plant.robot_state_publisher.catch_up(plant.now_ns)
    facts = [_freshness(plant), *plant.buffer.conflicts]
    return StageEvidence("observe", tuple(facts), tuple(_missing_frames(plant)))


def _missing_joints(plant: Plant) -> tuple[str, ...]:
    published = {joint for history in plant.control.histories.values() for joint in history.names}
    wanted = {joint for group in plant.contract.groups.values() for joint in group.joints}
    return tuple(sorted(wanted - published))


def _freshness(plant: Plant) -> str:
    stamps = [int(history.stamps[-1]) for history in plant.control.histories.values() if len(history.stamps)]
    if not stamps:
        return "no joint states are published"
    joints = sum(len(history.names) for history in plant.control.histories.values())
    return f"states of {joints} joints, the oldest {(plant.now_ns - min(stamps)) / 1e9:.3f} s old"


def _missing_frames(plant: Plant) -> list[str]:
    problems: list[str] = []
    root = plant.contract.root_frame
    for name, frame in plant.contract.frames.items():
        if frame.kind == "dynamic" or name == root:
            continue
        latest_ns = plant.buffer.latest_ns(root, name)
        answer = plant.buffer.lookup(root, name, 0 if latest_ns is None else latest_ns)
        if not isinstance(answer, Transform):
            problems.append(f"frame `{name}`: {answer.text.strip()}")
    return problems
