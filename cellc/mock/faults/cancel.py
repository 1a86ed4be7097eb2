"""The client cancels the goal that is executing, or the first that executes after."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Cancel:
    """Asks the task to cancel a goal of one kind of step."""

    kind: str

    def begin(self, plant: Plant) -> None:
        """Ask."""
        plant.requests.cancel.add(self.kind)
        plant.requests.changed.fire(plant.now_ns)

    def end(self, plant: Plant) -> None:
        """Take the request back where no goal has been cancelled yet."""
        plant.requests.cancel.discard(self.kind)
