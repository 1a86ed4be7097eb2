"""Bring-up of the simulated cell in four stages, each with its evidence: discover, configure, observe, claim."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from cellc.contract.bring_up import (
    Acknowledgment,
    BringUpStep,
    Comparison,
    HardwareActivation,
    Proof,
    Restart,
    Transition,
)
from cellc.contract.contract import ContractManager
from cellc.contract.vocabulary import BringUpPhase
from cellc.mock.bus.qos import hears, unmatched_pairs
from cellc.mock.control import ControllerManager
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.nodes.robot_state_publisher import NODE
from cellc.mock.plant import Plant
from cellc.mock.proofs import Proofs
from cellc.mock.result import StageEvidence
from cellc.mock.tf.buffer import Transform
from cellc.mock.tf.sources import LATEST
from cellc.mock.world.joint_states import JOINT_STATE_TYPE

_LEVELS = ("WARN", "ERROR", "FATAL")

_SETTLE_CYCLES = 5
"""A controller that activates and throws in its first update is seen a few cycles later."""
_PATIENCE_NS = 1_000_000_000
_LOOK_NS = 20_000_000
_WATCH_NS = 500_000_000
"""How long states are watched before anything may move; afterwards the buffers hold what an observation needs."""


class LogMark:
    """A place in the log of a manager."""

    def __init__(self, manager: ControllerManager) -> None:
        """Mark the present end of the log."""
        self._manager = manager
        self._length = len(manager.log.lines())

    def reasons(self) -> str:
        """Return the warnings and errors written since, joined to one line; empty without one."""
        lines = self._manager.log.lines()[self._length :]
        return "; ".join(" ".join(line.text.split()) for line in lines if line.level.value in _LEVELS)


def activate(
    plant: Plant, manager_name: str, controllers: tuple[str, ...], *, again: bool = False
) -> Waiting[tuple[str, ...]]:
    """Activate those of some controllers that are not active, one by one; return the problems, in the manager's words.

    Args:
        again: those that are active are deactivated by the same request, to read interfaces that are new.
    """
    manager = plant.control.managers[manager_name]
    problems: list[str] = []
    before = {entry.name: entry.state for entry in manager.list_controllers()}
    for controller in controllers:
        if before.get(controller) == "active" and not again:
            continue
        mark = LogMark(manager)
        was_active = before.get(controller) == "active"
        response = manager.switch_controllers([controller], [controller] if was_active else [])
        until_ns = plant.now_ns + _SETTLE_CYCLES * manager.period_ns
        while plant.now_ns < until_ns:
            yield Wait(until_ns)
        states = {entry.name: entry.state for entry in manager.list_controllers()}
        if states.get(controller) != "active":
            reason = mark.reasons() or response.message or f"it is {states.get(controller, 'not loaded')}"
            problems.append(f"`{controller}` cannot be activated: {reason}")
    return tuple(problems)


class PlanTaker:
    """Takes the steps of ``config/bring_up.json`` as the program on the robot does: proof, one request, effect."""

    def __init__(self, plant: Plant) -> None:
        """Bind the plant whose plan it is."""
        self._plant = plant
        self._proofs = Proofs(plant)

    def take(self, *phases: BringUpPhase) -> Waiting[tuple[tuple[str, ...], tuple[str, ...]]]:
        """Take the steps of some phases up to the first that fails; return what was done, and the problems."""
        facts: list[str] = []
        for step in self._plant.bring_up:
            if step.phase in phases:
                self._plant.start.enter(step.phase)
                facts += (f"step `{step.name}` believes {what}" for what in self._proofs.believed(step.proof))
                done, problems = yield from self._step(step)
                facts += done
                if problems:
                    return tuple(facts), tuple(f"step `{step.name}`: {problem}" for problem in problems)
        return tuple(facts), ()

    def _step(self, step: BringUpStep) -> Waiting[tuple[tuple[str, ...], tuple[str, ...]]]:
        asked = step.request
        again = isinstance(asked, Restart)
        if absent := (yield from self._awaited(step.proof, step.deadline_s)):
            return (), (absent,)
        if asked is not None and step.effect and not again and not self._proofs.missing(step.effect):
            return (), ()  # it was done before
        facts: tuple[str, ...] = ()
        problems: tuple[str, ...] = ()
        if isinstance(asked, Transition):
            problems = tuple(filter(None, (self._proofs.take(asked),)))
        elif isinstance(asked, HardwareActivation):
            manager = self._plant.control.managers[self._proofs.managers[asked.manager]]
            answer = manager.set_hardware_component_state(asked.component, "active")
            until_ns = self._plant.now_ns + self._plant.start.activate(asked.component)
            while self._plant.now_ns < until_ns:
                yield Wait(until_ns)
            states = (f"hardware component `{asked.component}` is {answer.state or 'unknown'}",)
            facts, problems = (states, ()) if answer.ok else ((), states)
        elif isinstance(asked, Acknowledgment):
            self._plant.watches.acknowledge()
        elif isinstance(asked, Comparison):
            facts = (f"step `{step.name}` believes that {len(asked.parts)} parts of the tuple are installed as pinned",)
        elif asked is not None:
            keys = self._proofs.controllers(asked.manager)
            wanted = tuple(keys.get(name, name) for name in asked.controllers)
            problems = yield from activate(self._plant, self._proofs.managers[asked.manager], wanted, again=again)
        if not problems and (absent := (yield from self._awaited(step.effect, step.deadline_s))):
            problems = (absent,)
        return facts, problems

    def _awaited(self, proofs: Sequence[Proof], deadline_s: float) -> Waiting[str]:
        """Wait for proofs, for a second at most: nothing else changes meanwhile; return what is missing then."""
        until_ns = self._plant.now_ns + min(_PATIENCE_NS, round(deadline_s * 1e9))
        while (absent := self._proofs.missing(proofs)) and self._plant.now_ns < until_ns:
            yield Wait(min(until_ns, self._plant.now_ns + _LOOK_NS))
        return absent


def discover(plant: Plant) -> Waiting[StageEvidence]:
    """List hardware components and endpoints; a description that was refused is a problem.

    Endpoints that do not connect are facts: the cell starts without the data, as it does in reality.
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


def configure(plant: Plant) -> Waiting[StageEvidence]:
    """Spawn every controller as inactive, one by one, with the parameters of its file, and connect every adapter."""
    yield Wait(plant.now_ns)
    facts: list[str] = []
    problems: list[str] = []
    for name, entry in plant.contract.managers.items():
        manager = plant.control.managers[name]
        for controller, declared in entry.controllers.items():
            if "mock" not in declared.targets:
                facts.append(f"`{controller}` is left out: it is only for real hardware")
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
        plant.control.subscribe_joint_states(_read_locally(plant))
    return StageEvidence("configure", tuple(facts), tuple(problems))


def _read_locally(plant: Plant) -> set[str]:
    """Return the broadcasters with a topic of joint states of their own in the contract."""
    topics = plant.contract.interfaces.items()
    states = (interface for name, interface in topics if interface.type == JOINT_STATE_TYPE and name != _COMMON)
    return {source.node for interface in states for source in interface.sources}


_COMMON = "/joint_states"


def observe(plant: Plant, plan: PlanTaker) -> Waiting[StageEvidence]:
    """Wait for joint states of every group's joints and for a transform of every fixed frame and link."""
    facts, problems = yield from plan.take(BringUpPhase.START, BringUpPhase.ACTIVATE)
    if problems:
        return StageEvidence("observe", facts, problems)
    until_ns = plant.now_ns + _PATIENCE_NS
    while (missing := _missing_joints(plant)) and plant.now_ns < until_ns:
        yield Wait(plant.now_ns + _LOOK_NS)
    if missing:
        return StageEvidence("observe", facts, tuple(f"no state of joint `{joint}` is published" for joint in missing))
    watched_until_ns = plant.now_ns + _WATCH_NS
    while plant.now_ns < watched_until_ns:
        yield Wait(watched_until_ns)
    announce(plant)
    seen = (*facts, _freshness(plant), *plant.task.buffer.conflicts)
    return StageEvidence("observe", seen, tuple(_missing_frames(plant)))


def announce(plant: Plant) -> None:
    """Let the task hear robot_state_publisher from now on; the names of the joints must be known."""
    task = plant.task.name
    plant.robot_state_publisher.announce(
        plant.task.buffer,
        plant.now_ns,
        hears_static=hears(plant.contract, "/tf_static", NODE, task),
        hears_moving=hears(plant.contract, "/tf", NODE, task),
    )


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
        answer = plant.task.buffer.lookup(root, name, LATEST)
        if not isinstance(answer, Transform):
            problems.append(f"frame `{name}`: {answer.text.strip()}")
    return problems


def claim(plant: Plant, plan: PlanTaker) -> Waiting[StageEvidence]:
    """Activate the commanding controllers and adapters, compare the claims of controllers with the contract, and look
    at what must show before anything may ask for motion.
    """
    facts: list[str] = []
    taken, refused = yield from plan.take(BringUpPhase.CLAIM)
    facts += taken
    problems = list(refused)
    for name, entry in plant.contract.managers.items():
        claims = _claims(plant.control.managers[name])
        facts += [f"`{interface}` is claimed by `{owner}`" for interface, owner in sorted(claims.items())]
        if not problems:
            problems += _differences(entry, claims)
    for device, server in plant.control.adapters.items() if not problems else ():
        server.adapter.activate()
        client = plant.contract.adapters[device].client
        permitted = f"only `{client}`" if client else "no client"
        facts.append(f"the adapter of `{device}` is {server.adapter.phase.value}, for {permitted}")
    if not problems:
        seen, missing = yield from plan.take(BringUpPhase.MOVE)
        facts, problems = [*facts, *seen], [*missing]
    return StageEvidence("claim", tuple(facts), tuple(problems))


def _claims(manager: ControllerManager) -> dict[str, str]:
    return {
        interface: controller.name
        for controller in manager.list_controllers()
        for interface in controller.claimed_interfaces
    }


def _owner(claims: dict[str, str], interface: str) -> str:
    return f"`{claims[interface]}`" if interface in claims else "no controller"


def _differences(entry: ContractManager, claims: dict[str, str]) -> list[str]:
    expected = {
        interface: name
        for name, controller in entry.controllers.items()
        if controller.active and "mock" in controller.targets
        for interface in controller.command_interfaces
    }
    return [
        f"`{interface}` must be claimed by {_owner(expected, interface)}, got {_owner(claims, interface)}"
        for interface in sorted({*expected, *claims})
        if claims.get(interface) != expected.get(interface)
    ]


class Bringup:
    """Brings a plant up.

    Attributes:
        evidence: of each stage that was started.
    """

    def __init__(self, plant: Plant) -> None:
        """Bind the bring-up to a plant whose nodes have started."""
        self.evidence: list[StageEvidence] = []
        self._plant = plant

    @property
    def passed(self) -> bool:
        """Tell whether every stage passed, so that motion may be asked for."""
        return all(stage.passed for stage in self.evidence)

    def run(self) -> Waiting[None]:
        """Run the stages up to the first that fails."""
        plan = PlanTaker(self._plant)
        stages = (discover, configure, partial(observe, plan=plan), partial(claim, plan=plan))
        for stage in stages:
            evidence = yield from stage(self._plant)
            self.evidence.append(evidence)
            if not evidence.passed:
                return
