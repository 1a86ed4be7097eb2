"""What happens between the fingers of grippers that clients on the graph drive."""

from __future__ import annotations

from cellc.contract.frozen import dataclass
from cellc.mock.control import GoalStatus, GripperEnded, GripperGoal
from cellc.mock.plant import Plant
from cellc.mock.task.context import AttemptError
from cellc.mock.task.fingers import body_of, release, take, tip_link


@dataclass(frozen=True, slots=True)
class Closing:
    """A goal of a gripper.

    Attributes:
        closes: it is nearer to closed fingers than to open ones.
        part: that is between them as they close.
    """

    device: str
    closes: bool
    part: str | None


class Fingers:
    """Lets fingers meet, take and let go of parts as goals drive them.

    Attributes:
        last: the last goal of each controller.
        failures: what was wrong as fingers opened, by controller, which no node of the cell sees.
    """

    def __init__(self, plant: Plant) -> None:
        """Bind the grippers of a plant."""
        self.last: dict[str, Closing] = {}
        self.failures: dict[str, AttemptError] = {}
        self._plant = plant
        self._devices = {
            facts.gripper.controller: name
            for name, facts in plant.contract.devices.items()
            if facts.gripper is not None and facts.gripper.controller is not None
        }

    def aim(self, controller: str, goal: GripperGoal) -> tuple[str, bool] | None:
        """Return the gripper that a goal drives, and whether it closes it; None where no gripper is driven."""
        device = self._devices.get(controller)
        facts = None if device is None else self._plant.contract.devices[device].gripper
        if device is None or facts is None or not goal.position:
            return None
        to = goal.position[0]
        return device, abs(to - facts.closed) <= abs(to - facts.open)

    def begin(self, controller: str, goal: GripperGoal) -> None:
        """Look what is between the fingers before they move."""
        aim = self.aim(controller, goal)
        if aim is None:
            return
        device, closes = aim
        parts, now_ns = self._plant.parts, self._plant.now_ns
        between = parts.between(device, tip_link(self._plant, device), now_ns) if closes else None
        if between is not None:
            parts.stop_fingers(device, between)
        if not closes:
            parts.measure(device, body_of(self._plant, device), now_ns)
        self.failures.pop(controller, None)
        self.last[controller] = Closing(device, closes, between)

    def end(self, controller: str, ended: GripperEnded) -> None:
        """Take or let go of a part, where the fingers have arrived."""
        last = self.last.get(controller)
        if last is None or ended.status is not GoalStatus.SUCCEEDED:
            return
        self._plant.loads.hold(last.device, holds=last.closes)
        if last.part is not None:
            take(self._plant, last.device, last.part)
        if not last.closes:
            try:
                release(self._plant, last.device)
            except AttemptError as failure:
                self.failures[controller] = failure
