"""A task node under test: the cell serves its goals, and follows from outside what it does in each step.

The watchdogs of the played task run on: what ends an attempt there ends it here, and the node must act on it by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from time import monotonic, sleep

from cellc.contract.attempt import CancelRecord, PacketStep
from cellc.contract.contract import Contract
from cellc.contract.devices import ContractGripper
from cellc.contract.rehearsals import StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.control import GoalStatus, GripperGoal
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.evidence.bag import messages
from cellc.mock.evidence.topics import pose_topic
from cellc.mock.plant import Plant
from cellc.mock.ros.arrivals import Arrivals
from cellc.mock.ros.asked import Timing
from cellc.mock.ros.bridge import Bridge
from cellc.mock.ros.conduct import Conduct
from cellc.mock.ros.graph import Graph
from cellc.mock.ros.judgment import Judgment, Violation
from cellc.mock.ros.servers import SERVED, ActionServers, ServedGoal
from cellc.mock.task.bounds import cancel_bound_s, grip_timeout_s
from cellc.mock.task.context import Attempt, AttemptError, TaskContext, current_state
from cellc.mock.task.execute import (
    RESPONSE_S,
    SentGoal,
    held_since,
    look_for_motion,
    note_result,
    require_active,
    require_success,
)
from cellc.mock.task.grip import require_arrival, require_part
from cellc.mock.task.move import move_timeout_s, state_since
from cellc.mock.task.task import EXECUTED, Steps

IDLE_S = 30.0
"""Of the run: how long a node may take to send the goal of a step."""
REACTION_S = 0.1
"""Of the run: how long a node may take to ask for a cancel; the joints must stand still within the bound after that."""
_QUIET_NS = 1_000_000_000
"""Of the run: how long a node is watched after the end."""
_LOOK_NS = 10_000_000
_TICK_HZ = 40.0
"""With lockstep: how often time waits until the node has handled what was published; as often as `/clock` comes."""
_FOUND_S = 2.0
"""Of the host: how long a node may take to find the actions once they are offered."""
_TICKS_TO_LOOK = 40
"""After so many it is looked again who hears what."""
_DYING_S = 2.0
"""Of the host: a node that answers within it has not ended."""
_SOON_S = 0.05
"""Of the host: how long it is waited for once it has not answered."""
_TO_STOP = (AttemptOutcome.STALE_STATE, AttemptOutcome.GRIP_FAILURE, AttemptOutcome.CANCELED)
"""What a node itself must stop a motion for; whatever else ends an attempt, the cell does."""
_NOT_FOLLOWED = (StepKind.SET, StepKind.CALL)


def can_be_left_out(contract: Contract, node: str) -> bool:
    """Tell whether the mock serves every action that a node is a client of."""
    actions = [
        each
        for each in contract.interfaces.values()
        if each.kind == "action" and any(sink.node == node for sink in each.sinks)
    ]
    return bool(actions) and all(each.type in SERVED for each in actions)


def not_followed(steps: tuple[StepEntry, ...]) -> str:
    """Say which step of a rehearsal cannot be followed from outside; nothing where each can."""
    return next((step.title for step in steps if step.kind in _NOT_FOLLOWED), "")


class OverdueError(AttemptError):
    """A goal has no result within its bound, where its client has to cancel it."""


class TaskUnderTest:
    """Follows the steps of a rehearsal as a node takes them."""

    def __init__(
        self, node: str, full: str, bridge: Bridge, arrivals: Arrivals, judgment: Judgment, timing: Timing
    ) -> None:
        """Take the place of the task of the contract."""
        self._node, self._full, self._bridge, self._arrivals = node, full, bridge, arrivals
        self._judgment, self._timing = judgment, timing
        self._servers: ActionServers | None = None
        self._conduct: Conduct | None = None
        self._seen = 0
        """Goals that belong to a step."""
        self._offered = False
        self._blocked = False
        self._told: set[str] = set()
        """Kinds of goals whose cancel the node was asked for."""

    @property
    def steps(self) -> Steps:
        """What follows each kind of step."""
        followed = {StepKind.MOVE: self._move, StepKind.GRIP: self._grip, StepKind.ACKNOWLEDGE: self._acknowledge}
        return {kind: partial(self._follow, followed.get(kind, EXECUTED[kind])) for kind in EXECUTED}

    def begin(self, plant: Plant, graph: Graph) -> None:
        """Bind the plant; the actions are offered when the cell is up."""
        self._conduct = Conduct(plant, self._full, self._judgment)
        self._servers = ActionServers(plant, graph, self._bridge, self._conduct.judge)
        self._arrivals.go_to(self._node, self._servers.take)
        plant.simulation.every(plant.now_ns, _TICK_HZ, partial(self._tick, plant, graph))

    def end(self, plant: Plant, graph: Graph) -> None:
        """Watch the node for a while after the end of the rehearsal, and show it a pose that is no number."""
        plant.simulation.run_process(_idle(plant.now_ns + _QUIET_NS))
        nowhere = Pose((math.nan,) * 3, (0.0, 0.0, 0.0, 1.0))
        for frame in plant.task.observations if self._offered else ():
            topic = pose_topic(plant.contract, frame)
            if topic is not None:
                stamp_ns = plant.clocks.of(self._node).read(plant.now_ns)
                data = messages.pose_stamped(stamp_ns, plant.contract.frames[frame].parent, nowhere)
                graph.write(graph.declare(topic.name, topic.kind, topic.qos), data, plant.now_ns)
                self._await_end_of(topic.name)

    def _await_end_of(self, topic: str) -> None:
        """Note a node that ends on what it was shown on a topic."""
        problem = self._bridge.settle(self._full, _DYING_S)
        until_s = monotonic() + self._timing.patience_s
        while problem and self._bridge.exit_code() is None and monotonic() < until_s:
            sleep(_SOON_S)
        if self._bridge.exit_code():
            text = f"`{self._full}` ended on a pose on `{topic}` whose position is no number"
            self._judgment.note(Violation.ENDED, topic, text)

    def _tick(self, plant: Plant, graph: Graph, number: int) -> None:
        """Ask for a cancel where the rehearsal has one, and let the node handle what it was sent."""
        if number % _TICKS_TO_LOOK == 0:
            graph.look()
        for goal in () if self._servers is None else self._servers.open_goals():
            kind = "grip" if goal.is_grip else "move"
            if goal.sent is not None and plant.task.requests.is_cancel_asked(kind):
                self._ask_to_cancel(kind)
        if self._timing.pace is None and self._offered:
            self._settle()
        self._arrivals.hear_all()

    def _settle(self) -> None:
        """Let the host's time pass until the node has handled what was published."""
        problem = self._bridge.settle(self._full, _SOON_S if self._blocked else self._timing.patience_s)
        self._blocked = bool(problem)
        if problem:
            text = f"`{self._full}` has handled no message for {self._timing.patience_s:g} s of the host: {problem}"
            self._judgment.note(Violation.BLOCKED, self._full, text)

    def _ask_to_cancel(self, kind: str) -> None:
        if kind not in self._told:
            self._told.add(kind)
            self._ask(f"{self._full}/cancel")

    def _ask(self, service: str) -> None:
        """Call a service of the node by which people tell it something."""
        problem = self._bridge.trigger(service, self._timing.patience_s)
        if problem:
            self._judgment.note(
                Violation.CANCEL_IGNORED, service, f"`{service}` of type std_srvs/srv/Trigger: {problem}"
            )

    # -- steps -------------------------------------------------------------------------------------------------------

    def _follow(
        self,
        step_of: Callable[[TaskContext, Attempt, StepEntry], Waiting[None]],
        context: TaskContext,
        attempt: Attempt,
        step: StepEntry,
    ) -> Waiting[None]:
        servers, conduct = self._bound()
        if not self._offered:
            self._offered = True
            servers.offer()
            if self._timing.pace is None:
                servers.await_client(self._node, self._full, min(_FOUND_S, self._timing.patience_s))
        try:
            yield from step_of(context, attempt, step)
        except AttemptError as failure:
            if failure.outcome in _TO_STOP or isinstance(failure, OverdueError):
                yield from self._see_it_stop(context, attempt, failure)
            if failure.outcome is AttemptOutcome.CANCELED:
                conduct.canceled_ns = context.now_ns
            raise

    def _bound(self) -> tuple[ActionServers, Conduct]:
        if self._servers is None or self._conduct is None:
            raise AssertionError("the plant is bound before its first step")
        return self._servers, self._conduct

    def _acknowledge(self, context: TaskContext, attempt: Attempt, step: StepEntry) -> Waiting[None]:
        """Let a person acknowledge, and tell the node."""
        yield from EXECUTED[StepKind.ACKNOWLEDGE](context, attempt, step)
        self._ask(f"{self._full}/acknowledge")

    def _next(self, context: TaskContext, step: StepEntry) -> Waiting[ServedGoal]:
        """Wait for the next goal of the node, which stays where it is until a step takes it.

        Raises:
            AttemptError: none comes in time, or the cell stops.
        """
        servers, conduct = self._bound()
        until_ns = context.now_ns + round(IDLE_S * 1e9)
        while self._seen >= len(servers.goals):
            if context.now_ns >= until_ns:
                text = f"`{self._full}` has sent no goal for {IDLE_S:g} s; `{step.title}` is next"
                raise AttemptError(AttemptOutcome.TIMEOUT, text)
            look_ns = until_ns
            if step.kind is StepKind.MOVE:
                current_state(context.plant)
                conduct.require_known(context, step.target)  # where nothing is known, a node sends no goal
                look_ns = context.now_ns + _LOOK_NS
            yield from context.pause(look_ns, servers.changed)
        return servers.goals[self._seen]

    def _move(self, context: TaskContext, attempt: Attempt, step: StepEntry) -> Waiting[None]:
        """Follow goals until the arm is where the step has it."""
        _, conduct = self._bound()
        conduct.rely(context, step.target)
        away = ""
        while True:
            try:
                goal = yield from self._next(context, step)
            except AttemptError:
                self._note_away(step, "sends no more goals", away)
                raise
            if goal.is_grip:
                self._note_away(step, f"goes on with `{goal.action}`", away or f"without a goal to `{step.target}`")
                return
            self._seen += 1
            yield from conduct.examine(context, attempt, step.target, goal)
            yield from self._executed(context, attempt, "move", goal)
            away = conduct.away(context.now_ns, step.target)
            if not away:
                return

    def _note_away(self, step: StepEntry, what: str, away: str) -> None:
        if away:
            self._judgment.note(Violation.GOAL_ELSEWHERE, step.title, f"`{self._full}` {what}, {away}")

    def _grip(self, context: TaskContext, attempt: Attempt, step: StepEntry) -> Waiting[None]:
        """Follow the goal of a gripper, and look whether it holds what it should."""
        servers, _ = self._bound()
        closes = (step.command or "close") == "close"
        goal = yield from self._next(context, step)
        aim = servers.fingers.aim(goal.controller, goal.asked) if isinstance(goal.asked, GripperGoal) else None
        if aim != (step.target, closes):
            text = f"`{self._full}` sent a goal to `{goal.action}`, expected one that {step.title}"
            self._judgment.note(Violation.UNEXPECTED_GOAL, step.title, text)
            return
        self._seen += 1
        if not closes:
            context.bands.pop(step.target, None)
        yield from self._executed(context, attempt, "grip", goal)
        facts, last = context.contract.devices[step.target].gripper, servers.fingers.last.get(goal.controller)
        if facts is None or goal.sent is None or last is None:
            return
        state = yield from state_since(context, context.ended[goal.sent.key].decided_ns)
        parts = context.plant.parts
        grasp, band = parts.grasp(step.part), parts.band(step.part, step.target)
        if closes and band is not None:
            require_part(state, facts, band)
            context.bands[step.target] = band
        elif not closes or grasp is None or grasp.width_m is None:
            require_arrival(state, facts, _target(facts, closes=closes))
        if last.part is not None:
            context.acting_on = None
        if (failure := servers.fingers.failures.get(goal.controller)) is not None:
            raise failure

    # -- a goal ------------------------------------------------------------------------------------------------------

    def _executed(self, context: TaskContext, attempt: Attempt, kind: str, goal: ServedGoal) -> Waiting[None]:
        """Follow a goal to its end.

        Raises:
            AttemptError: it did not succeed, or the cell stops.
        """
        servers, requests = self._bound()[0], context.node.requests
        attempt.mark(PacketStep.GOAL_SENT, goal.arrived_ns)
        if goal.accepted is None:
            yield from context.rest(RESPONSE_S)
            raise AttemptError(AttemptOutcome.TIMEOUT, f"no answer from {goal.server} within {RESPONSE_S:g} s")
        accepted = False
        try:
            while goal.is_open:
                look_ns = context.deadline_ns
                if goal.sent is not None:
                    if not accepted:
                        accepted = True
                        self._note_accepted(context, attempt, goal)
                    if requests.is_cancel_asked(kind):
                        self._ask_to_cancel(kind)
                        raise AttemptError(AttemptOutcome.CANCELED, f"the {kind} was canceled as requested")
                    look_ns = min(look_for_motion(context, goal.sent), self._result_due_ns(context, goal, goal.sent))
                yield from context.pause(look_ns, servers.changed, requests.changed)
            if kind in self._told:  # it ended while the node was asked: nothing follows all the same
                raise AttemptError(AttemptOutcome.CANCELED, f"the {kind} was canceled as requested")
        finally:
            if goal.sent is not None:
                note_result(context, attempt, goal.sent)
            requests.withdraw_cancel(kind)
            self._told.discard(kind)
        yield from self._require_success(context, goal)

    def _result_due_ns(self, context: TaskContext, goal: ServedGoal, sent: SentGoal) -> int:
        """Return when the result of a goal must be there.

        Raises:
            AttemptError: it is overdue.
        """
        timeout_s = _timeout_s(context, goal)
        due_ns = require_active(context, [sent], sent.sent_ns + round(timeout_s * 1e9))
        if context.now_ns >= due_ns:
            raise OverdueError(AttemptOutcome.TIMEOUT, f"no result from {goal.controller} within {timeout_s:g} s")
        return due_ns

    def _note_accepted(self, context: TaskContext, attempt: Attempt, goal: ServedGoal) -> None:
        attempt.controller_name = goal.controller
        attempt.plan_result = None if goal.trajectory is None else "success"
        attempt.mark(PacketStep.PLANNED, context.now_ns)
        attempt.mark(PacketStep.ACCEPTED, context.now_ns)
        context.node.milestones.announce("accepted")

    def _require_success(self, context: TaskContext, goal: ServedGoal) -> Waiting[None]:
        if goal.failure is not None:
            raise goal.failure
        if goal.status is GoalStatus.CANCELED:
            yield from context.rest(REACTION_S)  # what the node saw first, the watchdogs see by then
            timeout_s = _timeout_s(context, goal)
            if goal.sent is not None and context.now_ns >= goal.sent.sent_ns + round(timeout_s * 1e9):
                text = f"`{self._full}` canceled its goal of `{goal.action}` after {timeout_s:g} s"
                raise AttemptError(AttemptOutcome.TIMEOUT, text)
            raise AttemptError(
                AttemptOutcome.CANCELED, f"`{self._full}` canceled its goal of `{goal.action}` by itself"
            )
        if goal.sent is not None:
            require_success(context.ended[goal.sent.key], context)

    def _see_it_stop(self, context: TaskContext, attempt: Attempt, failure: AttemptError) -> Waiting[None]:
        """Wait until the node has canceled what executes, and its joints stand still; note where they do not in time.

        Raises:
            AttemptError: a cancel was asked for, and did not come in time.
        """
        servers, since_ns, plant = self._bound()[0], context.now_ns, context.plant
        goals = servers.open_goals()
        if not goals:
            return
        until_ns = since_ns + round((REACTION_S + cancel_bound_s(context.contract)) * 1e9)
        held_ns: int | None = None
        while (held_ns is None or any(goal.is_open for goal in goals)) and plant.now_ns < until_ns:
            yield Wait(min(until_ns, plant.now_ns + _LOOK_NS), (plant.control.changed, servers.changed))
            joints = tuple(joint for goal in goals if goal.sent is not None for joint in goal.sent.joints)
            held_ns = held_since(plant, joints, since_ns) if joints else plant.now_ns
        late = [goal for goal in goals if goal.cancel_ns is None and goal.is_open]
        latency_s = None if held_ns is None or late else (held_ns - since_ns) / 1e9
        attempt.cancel = CancelRecord(since_ns, None if late else held_ns, latency_s, None if late else 0)
        for goal in late:
            asked = failure.outcome is AttemptOutcome.CANCELED
            text = (
                f"`{self._full}` let its goal of `{goal.action}` execute for {(until_ns - since_ns) / 1e9:g} s more: "
            )
            kind = Violation.CANCEL_IGNORED if asked else Violation.NOT_STOPPED
            self._judgment.note(kind, goal.action, text + failure.fault_code)


def _timeout_s(context: TaskContext, goal: ServedGoal) -> float:
    """Return the bound of a goal from acceptance to result."""
    if goal.is_grip:
        return grip_timeout_s(context.contract, goal.controller)
    duration_ns = 0 if goal.trajectory is None else goal.trajectory.duration_ns
    return move_timeout_s(context, goal.controller, duration_ns * 1e-9)


def _target(facts: ContractGripper, *, closes: bool) -> float:
    return facts.closed if closes else facts.open


def _idle(until_ns: int) -> Waiting[None]:
    yield Wait(until_ns)
