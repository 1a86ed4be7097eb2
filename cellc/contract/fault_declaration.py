"""What the declaration of a fault is made of: what it names and hits, by how much, and what a run with it shows."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from cellc.contract.vocabulary import AttemptOutcome, Term


class Reference(Term):
    """What the value of a fault's key names; ``unknown-REFERENCE`` is the code of a name that is not in the cell."""

    DEVICE = "device"
    JOINT = "joint"
    CONTROLLER = "controller"
    NODE = "node"
    INTERFACE = "interface"
    FRAME = "frame"
    CLOCK = "clock"
    GOAL = "goal"
    STEP = "step"
    """A kind of step: nothing of the cell."""
    CYCLES = "cycles"
    """A count."""


class FaultTarget(Enum):
    """Which devices, joints or controllers a fault may hit, with their noun in messages; ``link`` finds their names."""

    STREAM = Reference.DEVICE, "camera or device with joints"
    STOPPABLE = Reference.DEVICE, "device with hardware"
    PROTECTED = Reference.DEVICE, "device that stops by itself"
    GUARDED = Reference.DEVICE, "device with a stop by a door or a light curtain"
    POWERED = Reference.DEVICE, "device with an emergency stop"
    SCALED = Reference.DEVICE, "device with speed scaling"
    ARM = Reference.DEVICE, "arm"
    PROGRAMMED = Reference.DEVICE, "device with a program that set points pass through"
    PAUSING = Reference.DEVICE, "device whose program pauses"
    BRAKED = Reference.DEVICE, "device with brakes that a claim needs open"
    SENSED = Reference.DEVICE, "device with sensors that are wired"
    GRIPPER = Reference.DEVICE, "gripper in a cell that states the width and tolerance of a part"
    JOINT = Reference.JOINT, "joint"
    PROGRAMMED_JOINT = Reference.JOINT, "joint with a program that set points pass through"
    CONTROLLER = Reference.CONTROLLER, "controller"
    COMMANDED = Reference.CONTROLLER, "controller with an action"
    SWITCH = Reference.CONTROLLER, "switch or controller"
    SERVER = Reference.NODE, "server"
    INTERFACE = Reference.INTERFACE, "interface"
    FRAME = Reference.FRAME, "frame"
    PART = Reference.FRAME, "frame of a part whose width and tolerance are stated"
    CLOCK = Reference.CLOCK, "clock"
    GOAL = Reference.GOAL, "goal"
    STEP = Reference.STEP, "kind of step"
    LOOP = Reference.CYCLES, "update loop"

    def __init__(self, reference: Reference, noun: str) -> None:
        self.reference = reference
        self.noun = noun


class Amount(Enum):
    """What a fault says beside its target: the key in the spec, and the field of ``FaultEntry``, in SI."""

    DELAY = "by", "delay_s"
    JUMP = "by", "jump_s"
    DISPLACEMENT = "by", "displacement"
    SIZE = "by", "size_m"
    VELOCITY = "to", "velocity"
    FACTOR = "to", "factor"

    def __init__(self, key: str, field: str) -> None:
        self.key = key
        self.field = field

    @property
    def of_joint(self) -> bool:
        """Whether its unit is that of a joint: rad for one that turns, m for one that slides."""
        return self in (Amount.DISPLACEMENT, Amount.VELOCITY)


class Hits(NamedTuple):
    """The key of a fault: what it names, its description and an example."""

    target: FaultTarget
    description: str
    example: str | int


class By(NamedTuple):
    """The second key of a fault: its description and an example."""

    amount: Amount
    description: str
    example: str


class Interaction(Term):
    """A case of the S2 checklist that a run with the fault is evidence of."""

    LATE_SAMPLE = "late_sample"
    MISSING_RESPONDER = "missing_responder"


class Declared(NamedTuple):
    """Everything about a kind of fault that both sides share.

    Attributes:
        word: the key in the spec, and the kind in ``rehearsals.json``.
        meaning: what happens, as schema, reference and editors show it.
        layers: outcomes of a run that the fault explains, its usual one first.
        shows: cases of the S2 checklist that it provokes.
    """

    word: str
    meaning: str
    hits: Hits
    layers: tuple[AttemptOutcome, ...]
    by: By | None = None
    shows: tuple[Interaction, ...] = ()
