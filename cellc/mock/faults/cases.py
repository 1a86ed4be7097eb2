"""What a cell has that faults can hit, and the case of a fault: what each step may make of it, and how soon."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from cellc.contract.contract import Contract, ContractController
from cellc.contract.faults import FaultKind, stop_state
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry, FaultEvent, StepEntry
from cellc.contract.vocabulary import AttemptOutcome


@dataclass(frozen=True, slots=True)
class CellStep:
    """A step as it may stand in a rehearsal.

    Attributes:
        kind, target: as in rehearsals.json.
        controllers: those that get a goal in this step.
        observes: dynamic frame whose observation the step needs or rests on.
        frames: frames whose transforms it looks up.
    """

    kind: str
    target: str
    controllers: tuple[str, ...] = ()
    observes: str | None = None
    frames: tuple[str, ...] = ()


def cell_steps(contract: Contract) -> Iterator[CellStep]:
    """Yield every step that a rehearsal of the cell can take."""
    for name, poses in contract.poses.items():
        controllers = [contract.groups[pose.group].controller for pose in poses]
        yield CellStep("move", name, tuple(name for name in controllers if name is not None))
    for name, goal in contract.goals.items():
        controller = contract.groups[goal.group].controller
        yield CellStep(
            "move",
            name,
            () if controller is None else (controller,),
            _observed(contract, goal.frame),
            (*ancestors(contract, goal.frame), *ancestors(contract, contract.groups[goal.group].base_link)),
        )
    for name, frame in contract.frames.items():
        if frame.kind == "dynamic":
            yield CellStep("detect", name, observes=name)
    for name, device in contract.devices.items():
        if device.gripper is not None:
            yield CellStep("grip", name, () if device.gripper.controller is None else (device.gripper.controller,))
        if device.switched is not None and device.switched.outputs:
            yield CellStep("set", name)
        if device.switched is not None and device.switched.inputs:
            yield CellStep("sense", name)
    yield CellStep("wait", "")


def ancestors(contract: Contract, frame: str) -> tuple[str, ...]:
    """Return a frame and all frames that it hangs from, up to the root."""
    chain: list[str] = []
    while frame in contract.frames and frame not in chain:
        chain.append(frame)
        frame = contract.frames[frame].parent
    return tuple(chain)


def _observed(contract: Contract, frame: str) -> str | None:
    dynamic = [name for name in ancestors(contract, frame) if contract.frames[name].kind == "dynamic"]
    return dynamic[0] if dynamic else None


def controllers(contract: Contract) -> dict[str, ContractController]:
    """Return the controllers of all managers."""
    return {name: facts for manager in contract.managers.values() for name, facts in manager.controllers.items()}


def driven_joints(contract: Contract) -> dict[str, str]:
    """Return the controller that moves each joint after start-up, or the device whose adapter does."""
    driven = {
        joint: name
        for name, facts in controllers(contract).items()
        if facts.active and facts.action is not None
        for joint in facts.joints
    }
    return driven | {joint: device for device, facts in contract.adapters.items() for joint in facts.joints}


def device_of(contract: Contract, controller: str) -> str | None:
    """Return the device that a controller moves; what is commanded behind an adapter is the device itself."""
    facts = controllers(contract).get(controller)
    return controller if facts is None else facts.device


def first_joints(contract: Contract) -> dict[str, str]:
    """Return one joint of everything that takes goals: the first, which represents the others."""
    firsts: dict[str, str] = {}
    for joint, controller in driven_joints(contract).items():
        firsts.setdefault(controller, joint)
    return {joint: controller for controller, joint in firsts.items()}


def components(contract: Contract) -> dict[str, str]:
    """Return the hardware component of every device that has one."""
    components = {name: device.hardware_component for name, device in contract.devices.items()}
    return {name: component for name, component in components.items() if component is not None}


def stoppable(contract: Contract) -> dict[str, str]:
    """Return what stops of every device that stops by itself: its hardware component, or the device on its adapter."""
    return components(contract) | {device: device for device in contract.adapters}


def stop_of(contract: Contract, device: str, kind: FaultKind) -> str | None:
    """Return the state in which a fault stops a device; None where nothing of it stops so."""
    return stop_state(kind, contract.devices[device].stops) if device in stoppable(contract) else None


def joints_of_device(contract: Contract, device: str) -> tuple[str, ...]:
    """Return the joints that the controllers of a device or its adapter drive, sorted."""
    if device in contract.adapters:
        return tuple(sorted(contract.adapters[device].joints))
    facts = controllers(contract).values()
    return tuple(sorted({joint for each in facts if each.device == device for joint in each.joints}))


def image_topic(contract: Contract, device: str) -> str | None:
    """Return the topic of a camera; None for another device."""
    camera = contract.devices[device].camera if device in contract.devices else None
    return None if camera is None else camera.topic


def cameras(contract: Contract) -> dict[str, tuple[str, ...]]:
    """Return the dynamic frames that are seen in the images of each camera."""
    cameras: dict[str, tuple[str, ...]] = {}
    for name, device in contract.devices.items():
        if device.camera is not None and device.camera.topic in contract.interfaces:
            nodes = {sink.node for sink in contract.interfaces[device.camera.topic].sinks}
            frames = (frame for frame, facts in contract.frames.items() if facts.kind == "dynamic")
            cameras[name] = tuple(frame for frame in frames if contract.frames[frame].authority in nodes)
    return cameras


def published_frames(contract: Contract) -> tuple[str, ...]:
    """Return the frames on /tf that stand for all: the dynamic ones, and the first moving link of each group."""
    dynamic = [name for name, frame in contract.frames.items() if frame.kind == "dynamic"]
    chains = (ancestors(contract, group.tip_frame) for group in contract.groups.values())
    moving = [[name for name in chain if _moves(contract, name)] for chain in chains]
    return tuple(dict.fromkeys([*dynamic, *(names[-1] for names in moving if names)]))


def _moves(contract: Contract, frame: str) -> bool:
    return contract.frames[frame].kind == "link" and contract.frames[frame].moving


@dataclass(frozen=True, slots=True)
class Ending:
    """How a step may end that meets a fault.

    Attributes:
        outcomes: names of outcomes; ``succeeded`` among them means that the step may bear the fault.
        within_s: bound from the fault's effect, which is its begin or the start of the step, whatever is later, to the
            end of the step; None where only the timeout of the rehearsal bounds it.
    """

    outcomes: frozenset[AttemptOutcome]
    within_s: float | None = None


BORNE = Ending(frozenset({AttemptOutcome.SUCCEEDED}))
"""A step that the fault does not concern."""


def ends_in(*outcomes: AttemptOutcome, within_s: float | None) -> Ending:
    """Return the ending of a step that the fault concerns."""
    return Ending(frozenset(outcomes), within_s)


@dataclass(frozen=True, slots=True)
class FaultCase:
    """A fault without a time, and the ending of each step that it may hit.

    Attributes:
        entry: kind, target and parameters; neither ``at_s`` nor ``event``.
        endings: by kind and target of a step; every step that a rehearsal of the cell can take is there.
        hits_running_step: the fault also meets a step whose goal is already executing.
    """

    entry: FaultEntry
    endings: Mapping[tuple[str, str], Ending]
    hits_running_step: bool = False

    @property
    def name(self) -> str:
        """The fault in words: its kind, what it hits, and which way a clock jumps."""
        jump_s = self.entry.jump_s
        direction = "" if jump_s is None else "forwards" if jump_s > 0.0 else "back"
        return " ".join(part for part in (self.entry.kind, self.entry.target, direction) if part)

    def at(self, step: int, when: str = "started", after_s: float = 0.0) -> FaultEntry:
        """Return the fault as it begins with a step; ``when`` is started, accepted or moving."""
        event = FaultEvent.model_validate({"step": step, "when": when, "after_s": after_s})
        return self.entry.model_copy(update={"event": event})

    def ending(self, step: StepEntry) -> Ending:
        """Return how one step may end that meets the fault."""
        return self.endings.get((step.kind, step.target), BORNE)

    def outcomes(self, steps: Sequence[StepEntry], first: int, when: str = "started") -> frozenset[AttemptOutcome]:
        """Return the outcomes of a run whose step ``first``, counted from 1, is the first to meet the fault."""
        endings = self._endings(steps, first, when)
        failures = frozenset(
            outcome for ending in _met(endings) for outcome in ending.outcomes - {AttemptOutcome.SUCCEEDED}
        )
        borne = all(AttemptOutcome.SUCCEEDED in ending.outcomes for ending in endings)
        return failures | {AttemptOutcome.SUCCEEDED} if borne else failures

    def within_s(self, steps: Sequence[StepEntry], first: int, when: str = "started") -> float | None:
        """Return the bound of the response of such a run; None where only the rehearsal's timeout bounds it."""
        failing = [ending for ending in _met(self._endings(steps, first, when)) if ending.outcomes != BORNE.outcomes]
        bounds = [ending.within_s for ending in failing if ending.within_s is not None]
        return max(bounds) if failing and len(bounds) == len(failing) else None

    def _endings(self, steps: Sequence[StepEntry], first: int, when: str) -> list[Ending]:
        """Return the endings of a step and of those after it.

        A step that executes already has done its asking, and may be over before the fault is noticed.
        """
        endings = [self.ending(step) for step in steps[first - 1 :]]
        if endings and when != "started" and not self.hits_running_step:
            endings[0] = Ending(endings[0].outcomes | {AttemptOutcome.SUCCEEDED}, endings[0].within_s)
        return endings


def _met(endings: Sequence[Ending]) -> list[Ending]:
    """Return the endings up to the first step that cannot bear the fault."""
    met: list[Ending] = []
    for ending in endings:
        met.append(ending)
        if AttemptOutcome.SUCCEEDED not in ending.outcomes:
            break
    return met


def fault_case(
    entry: FaultEntry, contract: Contract, ending: Callable[[CellStep], Ending], *, hits_running_step: bool = False
) -> FaultCase:
    """Return the case of a fault; ``ending`` says of each step of the cell how it may end."""
    endings = {(step.kind, step.target): ending(step) for step in cell_steps(contract)}
    return FaultCase(entry, endings, hits_running_step)
