"""What nodes under test do against the contract, as it shows from outside: each kind once, with its first case."""

from __future__ import annotations

from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Term


class Violation(Term):
    """What a node can do against its contract."""

    STAMP_OF_ANOTHER_TIME = "stamp_of_another_time"
    WRONG_FRAME = "wrong_frame"
    INVALID_POSE = "invalid_pose"
    STALE_INPUT_USED = "stale_input_used"
    TOO_SLOW = "too_slow"
    QOS = "qos_of_another_profile"
    SECOND_PUBLISHER = "second_publisher"
    MALFORMED = "malformed_message"
    ENDED = "node_ended"
    BLOCKED = "blocked"
    INVALID_GOAL = "invalid_goal"
    GOAL_OUTSIDE_LIMITS = "goal_outside_limits"
    GOAL_ELSEWHERE = "goal_elsewhere"
    UNEXPECTED_GOAL = "unexpected_goal"
    COMMANDED_ON_STALE_STATE = "commanded_on_stale_state"
    COMMANDED_WHILE_STOPPED = "commanded_while_stopped"
    COMMANDED_AFTER_CANCEL = "commanded_after_cancel"
    CANCEL_IGNORED = "cancel_ignored"
    NOT_STOPPED = "not_stopped"


@dataclass(slots=True)
class _Case:
    """The first case of a violation, and how many followed."""

    text: str
    count: int = 1


class Judgment:
    """Keeps what was seen; the same violation of the same subject is reported once, with how often it was seen."""

    def __init__(self) -> None:
        self._cases: dict[tuple[Violation, str], _Case] = {}

    def note(self, kind: Violation, subject: str, text: str) -> None:
        """Take note of a case; ``subject`` is the topic or node that it is about."""
        known = self._cases.get((kind, subject))
        if known is None:
            self._cases[kind, subject] = _Case(text)
        else:
            known.count += 1

    def lines(self) -> tuple[str, ...]:
        """Return a line for each violation, in the order in which they were seen first."""
        return tuple(
            f"{kind.value}: {case.text}{f' ({case.count} times)' if case.count > 1 else ''}"
            for (kind, _), case in self._cases.items()
        )
