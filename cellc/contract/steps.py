"""Steps of rehearsals, each kind declared once: its word, what it does, what its keys say.

Models, schema and reference of the spec, linking and ``rehearsals.json`` follow from a member of ``StepKind``.
``cellc.mock.task`` executes each kind.
"""

from __future__ import annotations

from enum import Enum, auto
from typing import NamedTuple

from cellc.contract.vocabulary import Term


class StepTarget(Enum):
    """What the value of a step's key is; ``link`` finds the names."""

    POSTURE = auto()
    FRAME = auto()
    FINGERS = auto()
    """What they do; the gripper has a key of its own."""
    SWITCHED = auto()
    SENSED = auto()
    SERVICE = auto()
    TIME = auto()
    PERSON = auto()


class Key(NamedTuple):
    """A key of a step with its description and an example."""

    key: str
    description: str
    example: str | bool


class Declared(NamedTuple):
    """Everything about a kind of step that both sides share.

    Attributes:
        word: the key in the spec, and the kind in ``rehearsals.json``.
        meaning: what happens, as schema, reference and editors show it.
        target: what the value of that key is, with its description and an example.
        more: the second key.
    """

    word: str
    meaning: str
    target: StepTarget
    description: str
    example: str
    more: Key | None = None


TOGETHER = Key("together", "The groups of the pose move together; one after another if false.", True)
DEVICE = Key("device", "Gripper; the only one if absent.", "gripper")
STATE = Key("state", "One of its states.", "closed")


class StepKind(Term):
    """What a step of a rehearsal does."""

    meaning: str
    target: StepTarget
    description: str
    example: str
    more: Key | None

    def __new__(
        cls, word: str, meaning: str, target: StepTarget, description: str, example: str, more: Key | None
    ) -> StepKind:
        """Make a member of the parts of its ``Declared``."""
        kind = str.__new__(cls, word)
        kind._value_ = word
        kind.meaning, kind.target, kind.description, kind.example, kind.more = (
            meaning, target, description, example, more,
        )  # fmt: skip
        return kind

    MOVE = Declared(
        "move",
        "Move a group to a named pose or a Cartesian goal.",
        StepTarget.POSTURE,
        "Named pose or goal.",
        "home",
        TOGETHER,
    )
    DETECT = Declared(
        "detect",
        "Wait for a fresh observation of a dynamic frame and keep its stamp for the goals that use it.",
        StepTarget.FRAME,
        "Dynamic frame.",
        "object",
    )
    GRIP = Declared("grip", "Drive the gripper.", StepTarget.FINGERS, "Open or close.", "close", DEVICE)
    SET = Declared(
        "set",
        "Set the outputs of a switched device; the step does not wait until it is there.",
        StepTarget.SWITCHED,
        "Device that digital outputs switch.",
        "gripper",
        STATE,
    )
    SENSE = Declared(
        "sense",
        "Wait until the sensors of a switched device report a state.",
        StepTarget.SENSED,
        "Device with sensors.",
        "door",
        STATE,
    )
    CALL = Declared(
        "call",
        "Call a service and wait for its answer; the mock answers in place of its server.",
        StepTarget.SERVICE,
        "Service interface of the cell.",
        "/conveyor/start",
    )
    WAIT = Declared("wait", "Let simulated time pass.", StepTarget.TIME, "How long.", "1 s")
    ACKNOWLEDGE = Declared(
        "acknowledge",
        "Let a person acknowledge a stop, so that the cell may continue; without it, every further goal is refused.",
        StepTarget.PERSON,
        "Who acknowledges.",
        "operator",
    )
