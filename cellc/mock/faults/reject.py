"""A controller is inactive when its goal arrives."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.control import ControlEvent, GripperEnded, TrajectoryEnded
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Reject:
    """Deactivates a controller, at once or as soon as the goal that it has is over."""

    controller: str

    def begin(self, plant: Plant) -> None:
        """Deactivate it before its next goal."""
        if self.controller not in plant.requests.executing:
            self._deactivate(plant)
            return
        waiting = [True]

        def after_goal(event: ControlEvent) -> None:
            if waiting and isinstance(event, (TrajectoryEnded, GripperEnded)) and event.controller == self.controller:
                waiting.clear()
                self._deactivate(plant)

        plant.control.listen(after_goal)

    def end(self, plant: Plant) -> None:
        """Activate it again."""
        plant.control.manager_of(self.controller).switch_controllers([self.controller], [])

    def _deactivate(self, plant: Plant) -> None:
        plant.control.manager_of(self.controller).switch_controllers([], [self.controller])
