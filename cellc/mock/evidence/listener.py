"""Listens to one rehearsal from its first cycle on, and hands what happens to the bag and to the trace."""

from __future__ import annotations

from functools import partial

from cellc.contract.attempt import AttemptRecord
from cellc.contract.vocabulary import TRAJECTORIES
from cellc.mock.control import (
    ControlEvent,
    ControllerChanged,
    GripperEnded,
    HardwareChanged,
    JointStateBlock,
    TrajectoryEnded,
)
from cellc.mock.control.controllers.joint_trajectory.recorder import Recorder
from cellc.mock.engine.control_stack import GoalSent
from cellc.mock.evidence.run_bag import RunBag, TransformStream
from cellc.mock.evidence.run_trace import RunTrace
from cellc.mock.evidence.statuses import Statuses
from cellc.mock.plant import Plant
from cellc.mock.task_status import TaskEvent

_PIECE_NS = 250_000_000
"""States of controllers are taken four times a second, so that memory stays flat."""
_DIAGNOSTIC_NS = 1_000_000_000
"""diagnostic_updater publishes once a second by default."""
_CLOCK_NS = 25_000_000
"""40 Hz, as `ros2 bag play --clock` publishes by default."""


class RunListener:
    """Hands what happens on to the bag and to the trace of the run; it changes nothing."""

    def __init__(self, plant: Plant, bag: RunBag, trace: RunTrace) -> None:
        """Listen to a plant in which nothing has run yet."""
        self._plant = plant
        self._bag = bag
        self._trace = trace
        self._statuses = Statuses(plant, bag)
        self._recorders: dict[str, Recorder] = {}
        self._streams = {key: TransformStream(plant, history) for key, history in plant.control.histories.items()}
        self._piece_due_ns = 0
        self._diagnostics_due_ns = 0
        self._clock_due_ns = -(-plant.now_ns // _CLOCK_NS) * _CLOCK_NS
        plant.control.watch(self)
        plant.task.actions.listen(self._done)
        plant.control.listen(self._hear)
        for frame, perception in plant.perceptions.items():
            perception.listen(partial(bag.pose, frame))
        for frame, inbox in plant.task.observations.items():
            inbox.listen(partial(trace.observation, frame))

    def configured(self) -> None:
        """Record every trajectory controller, update by update."""
        for name, manager in self._plant.contract.managers.items():
            for controller, facts in manager.controllers.items():
                if facts.behavior in TRAJECTORIES:
                    rate_hz = manager.update_rate_hz
                    self._recorders[controller] = self._plant.control.managers[name].record(controller, rate_hz)

    def joint_states(self, manager: str, controller: str, block: JointStateBlock) -> None:
        """Take joint states; now and then what controllers did, and the diagnostics."""
        if not len(block.stamps_ns):
            return
        self._statuses.look()
        self._bag.joint_states(manager, controller, block)
        self._trace.joint_states(manager, controller, block)
        for message in self._streams[(manager, controller)].take(block):
            self._bag.transforms(message)
            self._trace.transforms(message)
        last_ns = int(block.stamps_ns[-1])
        self._tick(last_ns)
        if last_ns >= self._piece_due_ns:
            self._take_states()
            self._piece_due_ns = last_ns + _PIECE_NS
        if last_ns >= self._diagnostics_due_ns:
            self._bag.diagnostics(last_ns)
            self._diagnostics_due_ns = last_ns + _DIAGNOSTIC_NS

    def _tick(self, until_ns: int) -> None:
        """Write the clock up to a time: it is no event of the run, and changes nothing in it."""
        for due_ns in range(self._clock_due_ns, until_ns + 1, _CLOCK_NS):
            self._bag.clock(due_ns)
            self._clock_due_ns = due_ns + _CLOCK_NS

    def goal_sent(self, sent: GoalSent) -> None:
        """Take a goal."""
        self._statuses.sent(sent)
        self._bag.goal(sent)

    def end(self) -> None:
        """Take what is left when the rehearsal is over."""
        self._take_states()
        self._statuses.look()
        self._tick(self._plant.now_ns)
        self._bag.diagnostics(self._plant.now_ns, ended=True)
        self._trace.end(self._plant.now_ns)

    def _done(self, event: TaskEvent) -> None:
        if isinstance(event, AttemptRecord):
            self._bag.attempt(event)

    def _take_states(self) -> None:
        for controller, recorder in self._recorders.items():
            recording = recorder.take()
            if len(recording.stamps_ns):
                self._bag.controller_states(controller, recording)
                self._trace.controller_states(controller, recording)

    def _hear(self, event: ControlEvent) -> None:
        if isinstance(event, (ControllerChanged, HardwareChanged)):
            self._bag.diagnostics(event.stamp_ns)
            self._trace.changed(event)
            self._statuses.changed(event)
        elif isinstance(event, (TrajectoryEnded, GripperEnded)):
            self._statuses.ended(event)
