"""Which recorded topics an attempt is read from, by the contract of its cell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cellc.contract.bring_up import TopicProof, Watch
from cellc.contract.contract import Contract
from cellc.contract.vocabulary import TRAJECTORIES
from cellc.mock.evidence.topics import ATTEMPTS, controller_state_topic, goal_topic
from cellc.mock.task.bounds import planning_actions
from cellc.tools.attempt.heard import KINDS

STATUS = "/_action/status"


@dataclass(frozen=True, slots=True)
class Action:
    """An action whose goals are followed.

    Attributes:
        controller: that takes its goals, or the device behind an adapter; empty for one that plans.
        joints: that it moves.
        manager: of the controller, empty behind an adapter.
        scales: its hardware has a speed scaling factor.
    """

    name: str
    controller: str
    joints: tuple[str, ...]
    gripper: bool = False
    scales: bool = False


@dataclass(frozen=True, slots=True)
class Watched:
    """What a device needs to listen, such as ``no_stop``, and the topic that proves it."""

    device: str
    need: str
    proof: TopicProof

    def holds(self, values: Mapping[str, float]) -> bool | None:
        """Tell whether a message proves it; None where it does not have the field."""
        field, above = self.proof.field, self.proof.above
        if field is None:
            return True
        if field not in values:
            return None
        return values[field] > above if above is not None else values[field] in self.proof.values


@dataclass(frozen=True, slots=True)
class Sources:
    """What is read.

    Attributes:
        actions: by the topic of their status.
        planning: names of the actions that plan for the task.
        observations: frame that each topic of an observation tells the place of, with the oldest age in s.
        states: controller by the topic of its state.
        missing: topics of the contract that the bag does not have.
        watched: what a topic of a vendor proves, by topic.
    """

    topics: Mapping[str, str]
    actions: Mapping[str, Action]
    planning: tuple[str, ...]
    observations: Mapping[str, tuple[str, float | None]]
    states: Mapping[str, str]
    missing: tuple[str, ...]
    watched: Mapping[str, tuple[Watched, ...]]


def sources_of(contract: Contract, watches: Sequence[Watch], recorded: Mapping[str, str]) -> Sources:
    """Return what is read of a bag with some topics, each with its type."""
    watched = _watched(watches)
    actions = {f"{each.name}{STATUS}": each for each in _actions(contract)}
    planning = tuple(planning_actions(contract))
    actions |= {f"{name}{STATUS}": Action(name, "", ()) for name in planning}
    states = {
        controller_state_topic(contract, name, controller).name: controller
        for name, manager in contract.managers.items()
        for controller, facts in manager.controllers.items()
        if facts.behavior in TRAJECTORIES
    }
    observations = _observations(contract)
    joints = [name for name, each in contract.interfaces.items() if each.type.endswith("/JointState")]
    expected = (*actions, *states, *observations, *joints, *watched, "/tf", "/diagnostics", "/rosout")
    of_use = {name: kind for name, kind in recorded.items() if name in watched or kind in KINDS}
    topics = {name: kind for name, kind in of_use.items() if not _own(name, contract)}
    missing = tuple(name for name in dict.fromkeys(expected) if name not in topics)
    return Sources(topics, actions, planning, observations, states, missing, watched)


def _watched(watches: Sequence[Watch]) -> dict[str, tuple[Watched, ...]]:
    found: dict[str, tuple[Watched, ...]] = {}
    for watch in watches:
        for need, proof in watch.while_hold.items():
            found[proof.topic] = (*found.get(proof.topic, ()), Watched(watch.device, need, proof))
    return found


def _own(topic: str, contract: Contract) -> bool:
    """Tell whether a topic is one that the mock alone writes: its record is compared with, never read from."""
    goals = {goal_topic(each.controller, gripper=each.gripper).name for each in _actions(contract)}
    return topic == ATTEMPTS.name or topic in goals


def _actions(contract: Contract) -> list[Action]:
    found = []
    for manager in contract.managers.values():
        for name, facts in manager.controllers.items():
            device = contract.devices.get(facts.device or "")
            scales = device is not None and device.speed_scaling_interface is not None
            gripper = facts.behavior not in TRAJECTORIES
            actions = dict.fromkeys((facts.action, facts.real_action))
            found += [Action(each, name, facts.joints, gripper, scales) for each in actions if each is not None]
    found += [Action(each.action, name, each.joints) for name, each in contract.adapters.items()]
    return found


def _observations(contract: Contract) -> dict[str, tuple[str, float | None]]:
    found: dict[str, tuple[str, float | None]] = {}
    for frame, facts in contract.frames.items():
        for name, each in contract.interfaces.items():
            of_frame = each.type.endswith("/PoseStamped") and each.frame == facts.parent
            if facts.kind == "dynamic" and of_frame and any(source.node == facts.authority for source in each.sources):
                found[name] = (frame, each.max_age_s)
    return found
