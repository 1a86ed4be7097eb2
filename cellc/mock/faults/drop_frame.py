"""A frame is no longer published."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class DropFrame:
    """Stops the publisher of a frame; a frame of /tf_static stays known to who has heard it, as in tf2."""

    frame: str

    def begin(self, plant: Plant) -> None:
        """Stop publishing."""
        if self.frame in plant.perceptions:
            plant.perceptions[self.frame].publishes_transform = False
        else:
            plant.robot_state_publisher.drop(self.frame, plant.now_ns)

    def end(self, plant: Plant) -> None:
        """Publish again."""
        if self.frame in plant.perceptions:
            plant.perceptions[self.frame].publishes_transform = True
        else:
            plant.robot_state_publisher.resume(self.frame)
