"""All controller managers of the cell behind the simulated clock, and what they tell of goals and joint states."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from itertools import chain
from typing import Protocol

from cellc.contract.contract import ContractManager
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.contract.vocabulary import Behavior
from cellc.mock.adapter.server import AdapterServer
from cellc.mock.control import (
    ControlEvent,
    ControllerChanged,
    ControllerManager,
    GoalResponse,
    GripperGoal,
    HardwareChanged,
    JointStateBlock,
    TrajectoryGoal,
)
from cellc.mock.engine.process import Signal
from cellc.mock.errors import LimitReachedError
from cellc.mock.physics.dynamics import Dynamics
from cellc.mock.world.joint_states import JointStateHistory


@dataclass(frozen=True, slots=True)
class GoalSent:
    """A goal that was sent to the action of a controller, and the answer.

    Attributes:
        uuid: id that its client gave it; None where that is of no interest.
    """

    stamp_ns: int
    controller: str
    goal: TrajectoryGoal | GripperGoal
    response: GoalResponse
    uuid: str | None = None


class ControlWatcher(Protocol):
    """Listens to the control stack of one run."""

    def configured(self) -> None:
        """Take note that all controllers are configured and none has published anything."""
        ...

    def joint_states(self, manager: str, controller: str, block: JointStateBlock) -> None:
        """Take joint states that a broadcaster of a manager published."""
        ...

    def goal_sent(self, sent: GoalSent) -> None:
        """Take note of a goal."""
        ...


def dangers(controller: str, goal: TrajectoryGoal | GripperGoal) -> Iterator[str]:
    """Say of an accepted goal what makes it dangerous; nothing for a sound one."""
    if not all(map(math.isfinite, _values(goal))):
        yield (
            f"dangerous: `{controller}` accepted a goal with NaN or an infinite value, as the real controller does; "
            "a joint of NaN stays where it is, and the goal succeeds"
        )
    if isinstance(goal, GripperGoal):
        return
    if len(set(goal.joint_names)) < len(goal.joint_names):
        yield (
            f"dangerous: `{controller}` accepted a goal that names a joint twice, as the real controller does; "
            "the last value counts, and a joint that is not named stays where it is"
        )
    if any(point.positions and point.accelerations and not point.velocities for point in goal.points):
        yield (
            f"dangerous: `{controller}` accepted accelerations without velocities, as the real controller does; its "
            "reference is zero for every joint until the last point"
        )


def _values(goal: TrajectoryGoal | GripperGoal) -> Iterator[float]:
    if isinstance(goal, GripperGoal):
        return chain(goal.position, goal.velocity, goal.effort)
    points = ((point.positions, point.velocities, point.accelerations, point.effort) for point in goal.points)
    return chain.from_iterable(chain.from_iterable(points))


GoalServer = ControllerManager | AdapterServer
"""What takes goals, runs in simulated time and tells of events."""
_LOCKSTEP_NS = 10_000_000
"""With several managers none may run ahead of an event of another by more than this."""
_LONGEST_STRETCH = 100_000
"""Update cycles after which it is looked at how many there were; so many take a second or two."""


class ControlStack:
    """Advances the managers in blocks, gathers their joint states, and hands their events on.

    Attributes:
        managers: by the name they have in the contract.
        adapters: of devices that no manager drives, by device.
        dynamics: what moves joints and parts; None where they are where they are led to.
        changed: fires after a manager had something to tell.
        unready_hardware: hardware components that are not active, with their state.
        dangers: what was dangerous in goals that controllers accepted all the same.
    """

    def __init__(
        self,
        managers: Mapping[str, ControllerManager],
        contracts: Mapping[str, ContractManager],
        horizon_s: float,
        adapters: Mapping[str, AdapterServer] | None = None,
        dynamics: Dynamics | None = None,
    ) -> None:
        """Bind the managers and adapters; ``horizon_s`` bounds the history of joint states."""
        self.dynamics = dynamics
        self.managers = dict(managers)
        self.adapters = dict(adapters or {})
        self._servers: tuple[GoalServer, ...] = (*self.managers.values(), *self.adapters.values())
        self.changed = Signal()
        self.events: list[ControlEvent] = []
        self.unready_hardware: dict[str, str] = {}
        self.dangers: list[str] = []
        self.histories: dict[tuple[str, str], JointStateHistory] = {}
        self._samples = 0
        self._joints: dict[GoalServer, int] = {
            **{manager: max(1, len(manager.joint_positions())) for manager in self.managers.values()},
            **{server: max(1, len(server.adapter.model.joint_names)) for server in self.adapters.values()},
        }
        self._listeners: list[Callable[[ControlEvent], None]] = []
        self._watchers: list[ControlWatcher] = []
        self._manager_of = {
            controller: name for name, manager in contracts.items() for controller in manager.controllers
        }
        adapted = {joint for server in self.adapters.values() for joint in server.adapter.model.joint_names}
        for name, manager in contracts.items():
            for controller, facts in manager.controllers.items():
                if facts.behavior is Behavior.JOINT_STATE_BROADCASTER:
                    foreign = _joints(entry for other, entry in contracts.items() if other != name) | adapted
                    history = JointStateHistory(horizon_s, managers[name].period_ns, foreign, controller)
                    self.histories[(name, controller)] = history

        for device, server in self.adapters.items():
            history = JointStateHistory(horizon_s, server.period_ns, broadcaster=device)
            self.histories[(device, device)] = history

    def __getstate__(self) -> dict[str, object]:
        """Return what a copy has: it begins without listeners."""
        return {**self.__dict__, "_listeners": [], "_watchers": []}

    @property
    def longest_period_ns(self) -> int:
        """The time after which every manager and every adapter has gone through a cycle."""
        return max((server.period_ns for server in self.servers()), default=0)

    @property
    def is_watched(self) -> bool:
        """Tell whether somebody takes what is published as it comes."""
        return bool(self._watchers)

    def manager_of(self, controller: str) -> ControllerManager:
        """Return the manager of a controller of the contract."""
        return self.managers[self._manager_of[controller]]

    def server_of(self, name: str) -> GoalServer:
        """Return what takes the goals of a controller, or of a device behind an adapter."""
        return self.adapters[name] if name in self.adapters else self.manager_of(name)

    def servers_of_joint(self, joint: str) -> Iterator[GoalServer]:
        """Yield the managers whose hardware has a joint, or the adapter whose device has it."""
        for manager in self.managers.values():
            if joint in manager.joint_positions():
                yield manager
        for server in self.adapters.values():
            if joint in server.adapter.model.joint_names:
                yield server

    def servers_of_component(self, component: str) -> Iterator[GoalServer]:
        """Yield the managers that have a hardware component, or the adapter of the device of this name."""
        yield from self.managers_of_component(component)
        if component in self.adapters:
            yield self.adapters[component]

    def managers_of_component(self, component: str) -> Iterator[ControllerManager]:
        """Yield the managers that have a hardware component."""
        for manager in self.managers.values():
            if any(entry.name == component for entry in manager.list_hardware_components()):
                yield manager

    def listen(self, listener: Callable[[ControlEvent], None]) -> None:
        """Call ``listener`` with every event of every manager, in order."""
        self._listeners.append(listener)

    def watch(self, watcher: ControlWatcher) -> None:
        """Tell ``watcher`` from now on what is published and asked for."""
        self._watchers.append(watcher)

    def send_goal(
        self, controller: str, goal: TrajectoryGoal | GripperGoal, uuid: str | None = None, *, feedback: bool = False
    ) -> GoalResponse:
        """Send a goal, under the id of its client, to the action of a controller of the contract.

        Args:
            feedback: whether a controller tells how far the goal has come; an adapter never does.
        """
        server = self.server_of(controller)
        if isinstance(server, ControllerManager):
            response = server.send_goal(controller, goal, feedback)
        else:
            response = server.send_goal(controller, goal)
        for watcher in self._watchers:
            watcher.goal_sent(GoalSent(server.now_ns, controller, goal, response, uuid))
        if response.accepted:
            self.dangers += [danger for danger in dangers(controller, goal) if danger not in self.dangers]
        return response

    def subscribe_joint_states(self, read: Container[str]) -> None:
        """Collect from now on what the broadcasters publish; they must be configured.

        Args:
            read: broadcasters whose local topics somebody reads; the others are heard on the common topic alone.
        """
        for (manager, controller), history in self.histories.items():
            if manager in self.managers:
                if self.managers[manager].has_local_topics(controller) and controller not in read:
                    continue
                self.managers[manager].subscribe_joint_states(controller)
            history.subscribed = True
        for watcher in self._watchers:
            watcher.configured()

    def advance(self, until_ns: int) -> int:
        """Advance to ``until_ns`` or to the first event before it; return the time reached.

        A single manager or adapter stops at its events. Several go on together in short steps, and are heard after
        each step.
        """
        servers = self._servers
        before_ns = {server: server.now_ns for server in servers}
        if servers:
            stretch_ns = _LONGEST_STRETCH * min(server.period_ns for server in servers)
            until_ns = min(until_ns, min(before_ns.values()) + stretch_ns)
        if len(servers) == 1:
            servers[0].advance(until_ns)
            until_ns = servers[0].now_ns
        elif servers:
            lockstep_ns = _LOCKSTEP_NS if self.dynamics is None else min(server.period_ns for server in servers)
            until_ns = min(until_ns, min(server.now_ns for server in servers) + lockstep_ns)
            for server in servers:
                while server.now_ns < until_ns:
                    server.advance(until_ns)
        self._count({server: server.now_ns - start_ns for server, start_ns in before_ns.items()})
        for server in servers:
            self.events += server.take_events()
        self._collect()
        return until_ns

    def _count(self, passed_ns: Mapping[GoalServer, int]) -> None:
        """Count the joint values that were computed in a time."""
        for server, time_ns in passed_ns.items():
            self._samples += self._joints[server] * time_ns // server.period_ns
        most = limits().mock_samples
        if self._samples > most:
            now_s = max(server.now_ns for server in passed_ns) / 1e9
            raise LimitReachedError(f"{now_s:.0f} s with more than {most} joint values are simulated", "mock-samples")

    def interrupt(self) -> None:
        """Void what was computed ahead: somebody changes what no manager is asked about."""
        for manager in self.managers.values():
            manager.interrupt()

    def dispatch(self, now_ns: int) -> None:
        """Hand what happened, and what was asked for just now, to the listeners; then wake who waits for it."""
        for server in self.servers():
            self.events += server.take_events()
        if not self.events:
            return
        events, self.events = self.events, []
        for event in events:
            if isinstance(event, HardwareChanged):
                self._note_hardware(event)
            elif isinstance(event, ControllerChanged):
                self._note_controller(event)
            for listener in self._listeners:
                listener(event)
        self.changed.fire(now_ns)

    def _note_hardware(self, event: HardwareChanged) -> None:
        if event.state == "active":
            self.unready_hardware.pop(event.component, None)
        else:
            self.unready_hardware[event.component] = event.state

    def _note_controller(self, event: ControllerChanged) -> None:
        for (_, controller), history in self.histories.items():
            if controller == event.controller:
                history.note_active(event.state == "active")

    def _collect(self) -> None:
        for (manager, controller), history in self.histories.items():
            if history.subscribed:
                for block in self._take_joint_states(manager, controller):
                    history.append(block)
                    for watcher in self._watchers:
                        watcher.joint_states(manager, controller, block)

    def servers(self) -> tuple[GoalServer, ...]:
        """Return every manager, then every adapter."""
        return self._servers

    def _take_joint_states(self, manager: str, controller: str) -> tuple[JointStateBlock, ...]:
        if manager in self.managers:
            return self.managers[manager].take_joint_states(controller)
        return (self.adapters[manager].take_joint_states(),)


def _joints(managers: Iterable[ContractManager]) -> frozenset[str]:
    """Return the joints that the controllers of some managers drive."""
    controllers = (controller for manager in managers for controller in manager.controllers.values())
    return frozenset(joint for controller in controllers for joint in controller.joints)
