"""How far the steps of a rehearsal have come, for faults that wait for it."""

from __future__ import annotations

from collections import defaultdict

from cellc.mock.engine.queue import Action


class Progress:
    """The task announces milestones; who waits for one acts at that instant.

    Attributes:
        step: number of the step that runs, from 1; 0 before the first.
    """

    def __init__(self) -> None:
        self.step = 0
        self._waiting: defaultdict[tuple[int, str], list[Action]] = defaultdict(list)

    def expect(self, step: int, milestone: str, action: Action) -> None:
        """Call ``action`` once when a step first reaches a milestone: started, accepted or moving."""
        self._waiting[(step, milestone)].append(action)

    def is_expected(self, milestone: str) -> bool:
        """Tell whether somebody waits for a milestone of the step that runs."""
        return bool(self._waiting.get((self.step, milestone)))

    def announce(self, milestone: str) -> bool:
        """Say that the step that runs has reached a milestone; tell whether somebody had waited for it."""
        actions = self._waiting.pop((self.step, milestone), [])
        for action in actions:
            action()
        return bool(actions)
