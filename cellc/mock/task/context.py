"""What the steps of a task share: the attempt that runs, the current joint state, and the watchdogs of every wait."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, fields

from cellc.contract.attempt import AttemptFields, AttemptRecord, PacketStep, TracePoint
from cellc.contract.contract import Contract, ContractBand
from cellc.contract.diagnostics.wording import both
from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.control import ControlEvent, ControllerChanged, GripperEnded, TrajectoryEnded
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.process import Signal, Wait, Waiting
from cellc.mock.errors import OversleptError
from cellc.mock.nodes.observations import ObservationInbox
from cellc.mock.nodes.robot_state_publisher import JointStateFeed
from cellc.mock.plant import Plant, TaskNode
from cellc.mock.stops import EMERGENCY_STOP, FAULT, PROTECTIVE_STOP
from cellc.mock.task.bounds import joint_state_age_s
from cellc.mock.task.starved import starved_observation, starved_states
from cellc.mock.task.watch import WATCH_NS, is_undisturbed, next_look_ns

OUTCOME_OF_STOP = {
    PROTECTIVE_STOP: AttemptOutcome.PROTECTIVE_STOP,
    EMERGENCY_STOP: AttemptOutcome.EMERGENCY_STOP,
    FAULT: AttemptOutcome.HARDWARE_FAULT,
}


@dataclass(frozen=True, slots=True)
class Identity:
    """What all attempts of a rehearsal share."""

    rehearsal: str
    configuration_id: str
    version_tuple: Mapping[str, str]

    def begin(self, number: int, step: str, started_ns: int) -> Attempt:
        """Return an attempt of which nothing else is known; its identifier is the same in every run."""
        return Attempt(
            attempt_id=f"{self.rehearsal}-{number:03d}",
            rehearsal=self.rehearsal,
            step=step,
            configuration_id=self.configuration_id,
            version_tuple=self.version_tuple,
            started_ns=started_ns,
        )


@dataclass(slots=True, kw_only=True)
class Attempt(AttemptFields[None]):
    """The record to be, filled in as its fields become known."""

    def mark(self, step: PacketStep, stamp_ns: int) -> None:
        """Note when one of the eight steps of the packet happened."""
        self.trace = tuple(sorted((*self.trace, TracePoint(step, stamp_ns)), key=lambda point: point.step.value))

    def close(
        self, outcome: AttemptOutcome, fault_code: str, safety_state: str, intervention_due: str, now_ns: int
    ) -> AttemptRecord:
        """Return the record of the attempt; what a person did in it means what a person would have to do."""
        self.outcome, self.fault_code, self.safety_state = outcome, fault_code, safety_state
        self.operator_intervention = self.operator_intervention or intervention_due
        self.ended_ns = now_ns
        return AttemptRecord(**{each.name: getattr(self, each.name) for each in fields(self)})


class AttemptError(CellcError):
    """Ends the attempt that is running; raised anywhere inside a step and caught by the task alone.

    Args:
        outcome: how the attempt ends.
        fault_code: the reason, in the words of the failed part.
    """

    def __init__(self, outcome: AttemptOutcome, fault_code: str) -> None:
        super().__init__(f"{outcome.value}: {fault_code}")
        self.outcome = outcome
        self.fault_code = fault_code


@dataclass(frozen=True, slots=True)
class CurrentState:
    """Positions of all joints as the task knows them; the stamp is the oldest of those that were put together.

    Attributes:
        stamp_ns: on the clock of the broadcaster.
        taken_ns: the same in simulated time.
        age_s: on the clock of the task.
    """

    stamp_ns: int
    taken_ns: int
    age_s: float
    positions: dict[str, float]


def current_state(plant: Plant) -> CurrentState:
    """Return the newest joint state that has arrived.

    Raises:
        AttemptError: stale_state, where none has arrived, it is older than its interface allows, or it is stamped as
            far in the future: a clock was set back.
    """
    allowed_s = joint_state_age_s(plant.contract)
    stamps: list[tuple[int, int, JointStateFeed]] = []
    positions: dict[str, float] = {}
    for feed in plant.task.feeds:
        history, newest = feed.history, feed.newest(plant.now_ns)
        if newest is None:
            why = starved_states(plant, feed, allowed_s)
            raise AttemptError(AttemptOutcome.STALE_STATE, f"no joint state has arrived; {why}")
        taken_ns = int(history.stamps[newest])
        stamps.append((plant.clocks.of(history.broadcaster).read(taken_ns), taken_ns, feed))
        positions |= dict(zip(history.names, history.positions[newest].tolist(), strict=True))
    if not stamps:
        raise AttemptError(AttemptOutcome.STALE_STATE, "no joint states reach the task")
    stamp_ns, taken_ns, oldest = min(stamps, key=lambda one: one[:2])
    age_s = plant.clocks.age_ns(plant.task.name, stamp_ns) / 1e9
    if abs(age_s) > allowed_s:
        age, allowed = both(abs(age_s), allowed_s)
        aged = f"{age} s old" if age_s > 0 else f"stamped {age} s in the future"
        why = starved_states(plant, oldest, allowed_s)
        raise AttemptError(AttemptOutcome.STALE_STATE, f"joint state is {aged}, {allowed} s allowed; {why}")
    return CurrentState(stamp_ns, taken_ns, age_s, positions)


GoalEnded = TrajectoryEnded | GripperEnded


@dataclass(slots=True)
class TaskContext:
    """State of the task between steps.

    Attributes:
        deadline_ns: end of the whole rehearsal.
        seed: seed of every random draw.
        is_disturbed: returns whether a fault has started.
        may_oversleep: no fault can begin, and a run whose task slept too long is made again.
        observed: stamp of the kept observation, by dynamic frame.
        retreats: pose of the tip link in the base from which a group's goal was approached, while it is there.
        bands: where the joint of each gripper must stay that holds a part.
        acting_on: dynamic frame whose observation the present motion rests on; it must keep arriving.
        ended: results that have arrived, by controller and goal.
        deactivated_ns: when each controller was deactivated last.
    """

    plant: Plant
    deadline_ns: int
    seed: int
    is_disturbed: Callable[[], bool]
    may_oversleep: bool = False
    observed: dict[str, int] = field(default_factory=dict)
    retreats: dict[str, Pose] = field(default_factory=dict)
    bands: dict[str, ContractBand] = field(default_factory=dict)
    acting_on: str | None = None
    ended: dict[tuple[str, int], GoalEnded] = field(default_factory=dict)
    deactivated_ns: dict[str, int] = field(default_factory=dict)

    @property
    def contract(self) -> Contract:
        """The contract of the cell."""
        return self.plant.contract

    @property
    def control(self) -> ControlStack:
        """The controllers that take the goals of the task."""
        return self.plant.control

    @property
    def node(self) -> TaskNode:
        """The node that the task represents."""
        return self.plant.task

    @property
    def now_ns(self) -> int:
        """The simulated time."""
        return self.plant.simulation.now_ns

    def hear(self, event: ControlEvent) -> None:
        """Keep the results of goals, unless their server answers no client, and the states of controllers."""
        if isinstance(event, ControllerChanged):
            if event.state != "active":
                self.deactivated_ns[event.controller] = event.stamp_ns
        elif isinstance(event, GoalEnded) and self.plant.network.answers(event.controller):
            self.ended[(event.controller, event.goal_id)] = event

    def pause(self, until_ns: int, *signals: Signal) -> Waiting[None]:
        """Wait for a signal, an event of the control stack, or ``until_ns``, whatever comes first; may wake early.

        Raises:
            AttemptError: the cell stopped, missed cycles, or the rehearsal's time is over.
        """
        slept_ns, trusted = self.now_ns, self._trusted()
        until_ns = min(until_ns, self.deadline_ns)
        if trusted is None:
            until_ns = min(until_ns, self._observed_until_ns())
        if until_ns > self.now_ns + WATCH_NS:
            disturbed = self.is_disturbed() or any(signal.from_background for signal in signals)
            until_ns = min(until_ns, next_look_ns(self.plant, disturbed=disturbed))
        yield Wait(until_ns, (self.control.changed, *signals))
        if trusted is not None and trusted.lapsed_since(slept_ns):
            raise OversleptError
        self.check_cell()

    def _trusted(self) -> ObservationInbox | None:
        """Return what brings the observation that is acted on, where it is asked afterwards whether it arrived in time.

        That is where a run may be made again, and nothing else can happen.
        """
        if not self.may_oversleep or self.acting_on is None or not is_undisturbed(self.plant):
            return None
        inbox = self.node.observations.get(self.acting_on)
        return None if inbox is None or inbox.newest is None else inbox

    def let_take_effect(self) -> Waiting[None]:
        """Wait until what was asked of controller managers and adapters at this instant has been carried out."""
        until_ns = self.now_ns + self.control.longest_period_ns
        while self.now_ns < until_ns:
            yield Wait(until_ns)

    def rest(self, duration_s: float) -> Waiting[None]:
        """Let time pass while the cell is watched."""
        until_ns = self.now_ns + round(duration_s * 1e9)
        while self.now_ns < until_ns:
            yield from self.pause(until_ns)

    def stand_by(self, duration_s: float) -> Waiting[None]:
        """Let time pass while the cell is stopped."""
        until_ns = min(self.now_ns + round(duration_s * 1e9), self.deadline_ns)
        while self.now_ns < until_ns:
            yield Wait(until_ns)

    def check_cell(self) -> None:
        """Raise AttemptError for what ends any attempt, a motion or stop first; each is a watchdog of the task."""
        self._check_effects()
        self._check_owner()
        self._check_cycles()
        self._check_states()
        self._check_observation()
        self._check_parts()
        self._check_time()

    def _check_effects(self) -> None:
        """Raise AttemptError where something moved without a command or stopped, or a claim is no longer one."""
        for motion in self.plant.effects.motions:
            raise AttemptError(AttemptOutcome.UNCOMMANDED_MOTION, str(motion))
        for stop in self.plant.stops.present():
            raise AttemptError(OUTCOME_OF_STOP[stop.state], str(stop))
        for controller, why in self.plant.watches.given_up.items():
            raise AttemptError(AttemptOutcome.CLAIM_FAILURE, f"{controller} gave up its claim: {why}")
        for why in self.plant.effects.ignored.values():
            raise AttemptError(AttemptOutcome.CLAIM_FAILURE, why)

    def _check_owner(self) -> None:
        """Raise AttemptError where another client commands: the status of an action names every goal that it has."""
        for goal in self.node.actions.foreign:
            raise AttemptError(AttemptOutcome.WRONG_OWNER, f"{goal.client} sent a goal to {goal.controller}")

    def _check_cycles(self) -> None:
        missed = sum(history.missed_until(self.now_ns) for history in self.control.histories.values())
        allowed = self.contract.kpis.missed_cycles
        if allowed is not None and missed > allowed:
            raise AttemptError(AttemptOutcome.MISSED_CYCLE, f"{missed} update cycles missed, {allowed} allowed")

    def _check_states(self) -> None:
        """Raise AttemptError where a goal executes without current joint states."""
        if self.node.actions.is_executing():
            current_state(self.plant)

    def _check_parts(self) -> None:
        """Raise AttemptError where fingers that held a part are reported elsewhere: it was lost on the way."""
        for device, band in self.bands.items():
            for feed in self.node.feeds:
                newest = feed.newest(self.now_ns) if band.joint in feed.history.names else None
                if newest is not None:
                    position = float(feed.history.positions[newest, feed.history.names.index(band.joint)])
                    if not band.lower <= position <= band.upper:
                        gripper = self.contract.devices[device].gripper
                        unit = "" if gripper is None else f" {gripper.unit}"
                        text = f"lost: joint {band.joint} of {device} is at {position:.4g}{unit}, with a part expected"
                        text += f" from {band.lower:.4g} to {band.upper:.4g}{unit}"
                        raise AttemptError(AttemptOutcome.GRIP_FAILURE, text)

    def _check_time(self) -> None:
        if self.now_ns >= self.deadline_ns:
            raise AttemptError(AttemptOutcome.TIMEOUT, "the timeout of the rehearsal expired")

    def _observed_until_ns(self) -> int:
        """Return when the observation that is acted on turns stale; the deadline where none is."""
        inbox = None if self.acting_on is None else self.node.observations.get(self.acting_on)
        if inbox is None or inbox.newest is None or inbox.on_stale == "continue":
            return self.deadline_ns
        return max(self.now_ns + 1, inbox.stale_from_ns(inbox.newest.stamp_ns))  # time goes on, however a clock rounds

    def _check_observation(self) -> None:
        """Raise AttemptError where the frame that is acted on is no longer observed: a frozen camera stops the arm."""
        self.check_authorities(() if self.acting_on is None else (self.acting_on,))
        inbox = None if self.acting_on is None else self.node.observations.get(self.acting_on)
        if inbox is None or (inbox.newest is not None and not inbox.is_stale(inbox.newest.stamp_ns)):
            return
        raise self.stale(self.acting_on or "", inbox.describe(self.acting_on or ""))

    def stale(self, frame: str, observation: str) -> AttemptError:
        """Return what ends an attempt whose observation of a frame is stale, with the link that is starved.

        Three values of ``on_stale`` are played alike: the reason says so where the contract states another one.
        """
        inbox = self.node.observations[frame]
        why = starved_observation(self.plant, frame, inbox.max_age_s)
        alike = f"; `on_stale: {inbox.on_stale}` is played as `reject_goal`, your node may react in another way"
        return AttemptError(
            AttemptOutcome.STALE_STATE, f"{observation}; {why}{'' if inbox.on_stale == 'reject_goal' else alike}"
        )

    def check_authorities(self, frames: Iterable[str]) -> None:
        """Raise AttemptError where two nodes publish one of the frames: lookups would jump from one to the other."""
        for frame in frames:
            if (authorities := self.node.buffer.authorities(frame))[1:]:
                names = " and ".join(authorities)
                raise AttemptError(AttemptOutcome.TF_FAILURE, f"frame {frame} is published by {names}")
