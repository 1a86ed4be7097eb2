"""A rehearsal among real nodes: who is on the graph, when it may begin, and what is left when it has ended."""

from __future__ import annotations

import os
import shlex
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from time import monotonic, sleep

from cellc.contract.bring_up import Transition
from cellc.contract.compute.processes import process_number
from cellc.contract.contract import Contract
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry, RehearsalEntry
from cellc.mock.bus.qos import task_node
from cellc.mock.cell import MockCell, Watch
from cellc.mock.control.manager.settings import NODE_NAME
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.errors import MockError
from cellc.mock.evidence.bag.messages import TF_MESSAGE
from cellc.mock.evidence.images.photographer import Photographer
from cellc.mock.evidence.listener import RunListener
from cellc.mock.evidence.run_bag import RunBag
from cellc.mock.evidence.run_trace import RunTrace
from cellc.mock.plant import Plant
from cellc.mock.result import RehearsalResult
from cellc.mock.ros.arrivals import Arrivals
from cellc.mock.ros.asked import AmongNodes
from cellc.mock.ros.bridge import Bridge, GraphEnd
from cellc.mock.ros.graph import Graph, refuse_others
from cellc.mock.ros.judgment import Judgment, Violation
from cellc.mock.ros.lifecycles import LifecycleServices
from cellc.mock.ros.managers import ManagerServices
from cellc.mock.ros.parameters import played_parameters
from cellc.mock.ros.perception import PerceptionUnderTest
from cellc.mock.ros.servers import ActionServers
from cellc.mock.ros.task import TaskUnderTest, can_be_left_out, not_followed
from cellc.mock.task.task import EXECUTED

_DISCOVERY_S = 4.0
"""Of the host: how long who else is there is looked for before the first run on a domain publishes anything: a mock
that was there for 10 s was seen after 3 s, the period at which participants of Fast DDS announce themselves:
https://docs.ros.org/en/rolling/p/fastdds/generated/classeprosima_1_1fastdds_1_1rtps_1_1DiscoverySettings.html"""
_AGAIN_S = 1.0
"""Of the host: the same before a later run of this process."""
_MEET_S = 2.0
"""Of the host: how long nodes under test may take to find each other, which only they themselves see: a pose that is
published before the task has found the perception is lost, and half of the runs of a loaded host ended so."""
DOMAIN_OF_LAUNCH = "CELLC_MOCK_DOMAIN"
"""By which `launch/among_mock.launch.xml` of a package knows the domain."""
_looked_at: set[int] = set()
"""Domains on which this process has played."""
_LOOK_S = 0.1
_LATE_S = 0.02
"""A host that is later than this is reported: nodes saw time jump."""
_IDLE_NS = 2_000_000_000
"""Of the run: passes before anything is brought up, so that a clock that is set back reads no negative time."""
_TICK_HZ = 200.0
"""How often what arrives is taken, at a pace."""


@dataclass(frozen=True, slots=True)
class Judged:
    """A result, and what depends on the host and is in no record.

    Attributes:
        notes: one line each.
    """

    result: RehearsalResult
    notes: tuple[str, ...]


def tested_nodes(contract: Contract, without: Sequence[str]) -> dict[str, str]:
    """Return the full names of nodes under test by their names in the contract.

    Raises:
        MockError: there is no such node, or it is not one that can be left out.
    """
    ends = [end for each in contract.interfaces.values() for end in (*each.sources, *each.sinks)]
    known = {end.node: end.full_name for end in ends}
    able = sorted((_observers(contract) | _tasks(contract)) & set(known))
    for name in without:
        if name not in able:
            what = "is played by the mock alone" if name in known else "is no node of the contract"
            others = ", ".join(f"`{each}`" for each in able) or "none"
            raise MockError("", f"`{name}` {what}; nodes that can be left out: {others}")
    return {name: known[name] for name in without}


def _needs(contract: Contract, node: str) -> Iterator[tuple[str, bool]]:
    """Yield the topics that a node must be on before a run, each with whether it publishes it.

    Transforms are not among them: a listener of tf2 may have a node of its own.
    """
    for name, interface in contract.interfaces.items():
        if interface.kind == "topic" and interface.type != TF_MESSAGE:
            if any(end.node == node for end in interface.sinks):
                yield name, False
            if any(end.node == node for end in interface.sources):
                yield name, True


def _talk(contract: Contract, tested: Collection[str]) -> bool:
    """Tell whether a node under test hears another one."""
    topics = (each for each in contract.interfaces.values() if each.kind == "topic")
    return any(
        source.node in tested and sink.node in tested and source.node != sink.node
        for each in topics
        for source in each.sources
        for sink in each.sinks
    )


def _observers(contract: Contract) -> set[str]:
    return {frame.authority for frame in contract.frames.values() if frame.simulated_parent is not None}


def _tasks(contract: Contract) -> set[str]:
    """Return the task, where the mock serves all that it asks for."""
    task = task_node(contract)
    return {task} if can_be_left_out(contract, task) else set()


_NOT_ON_THE_GRAPH = (FaultKind.MISMATCH_QOS, FaultKind.UNREACHABLE, FaultKind.DOUBLE_FRAME)
"""Faults of the played task alone: what it requests, where it has its goals, and what reaches its listener."""


def concerns(contract: Contract, without: Collection[str], fault: FaultEntry) -> bool:
    """Tell whether nodes under test can see a fault.

    An observer sees those in its images, topics, transforms and clocks, or of a part; a task all that are on the graph.
    """
    cameras = {device: facts.camera.topic for device, facts in contract.devices.items() if facts.camera is not None}
    interface = contract.interfaces.get(cameras.get(fault.target, fault.target))
    ends = () if interface is None else (*interface.sources, *interface.sinks)
    task = task_node(contract)
    if task in without:
        return fault.kind not in _NOT_ON_THE_GRAPH
    observers = set(without) - {task}
    seen = fault.target in contract.frames or fault.kind is FaultKind.JUMP_CLOCK
    return any(end.node in observers for end in ends) or (bool(observers) and seen)


def rehearse_among(
    cell: MockCell, entry: RehearsalEntry, seed: int, asked: AmongNodes, watch: Watch | None = None
) -> Judged:
    """Run a rehearsal around nodes that are not played.

    Args:
        watch: sees the plant too, before anything runs.

    Raises:
        MockError: there is no ROS environment, it is another distribution's, somebody is on the graph who must not be,
            or the nodes do not appear.
    """
    tested, environment = tested_nodes(cell.contract, asked.without), _environment(asked)
    if task_node(cell.contract) in tested and (step := not_followed(entry.steps)):
        raise MockError(
            "", f"step `{step}` of `{entry.name}` cannot be followed from outside: only the mock's task has it"
        )
    with Bridge(asked.interpreter, environment) as bridge:
        _require_distro(bridge, cell.contract)
        sleep(_AGAIN_S if asked.domain in _looked_at else _DISCOVERY_S)
        refuse_others(bridge, cell.contract, tested.values())
        _looked_at.add(asked.domain)
        around = _Around(cell, bridge, tested, asked)
        if asked.launch:
            rehearsal, _, _ = entry.name.partition("/")  # a run of a campaign is named `rehearsal/fault`
            bridge.start(_words(asked.launch.replace("{rehearsal}", rehearsal)))
        result = cell.rehearse(entry, seed=seed, watch=partial(_both, watch, around.begin), steps=around.steps)
        around.end()
    return Judged(replace(result, violations=around.judgment.lines()), tuple(around.notes))


def rehearse_on_own_domain(
    asked: AmongNodes, cell: MockCell, entry: RehearsalEntry, seed: int, watch: Watch
) -> RehearsalResult:
    """Run a rehearsal around nodes that are not played, on the domain that is this process's alone.

    Raises:
        MockError: as `rehearse_among` raises it.
    """
    own = replace(asked, domain=asked.domain - process_number())
    return rehearse_among(cell, entry, seed, own, watch).result


def _idle(until_ns: int) -> Waiting[None]:
    yield Wait(until_ns)


def _both(watch: Watch | None, begin: Watch, plant: Plant) -> None:
    if watch is not None:
        watch(plant)
    begin(plant)


def _words(command: str) -> list[str]:
    """Return the words of a command, which no shell reads."""
    try:
        return shlex.split(command)
    except ValueError as error:
        raise MockError("", f"`{command}` is no command: {error}") from None


def _environment(asked: AmongNodes) -> dict[str, str]:
    """Return the environment of the bridge and of the nodes: a domain of their own, on this host alone."""
    alone = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_LOCALHOST_ONLY": "1"}
    domain = str(asked.domain)
    return {**os.environ, "ROS_DOMAIN_ID": domain, DOMAIN_OF_LAUNCH: domain, **alone}


def _require_distro(bridge: Bridge, contract: Contract) -> None:
    found = bridge.environment()["distro"]
    if found != contract.distro:
        text = f"the ROS environment is `{found or 'unknown'}`, the folder is built for `{contract.distro}`"
        raise MockError("", f"{text}; source that distribution, or build the cell for this one")


class _Pacer:
    """Lets the time of a run pass no faster than its pace.

    Attributes:
        latest_s: by how much the host was late at most.
    """

    def __init__(self, pace: float) -> None:
        """Begin with the first instant that is kept."""
        self.latest_s = 0.0
        self._pace = pace
        self._start: tuple[float, int] | None = None

    def keep(self, now_ns: int) -> None:
        """Sleep until an instant of the run has come."""
        if self._start is None:
            self._start = monotonic(), now_ns
        began_s, began_ns = self._start
        early_s = began_s + (now_ns - began_ns) / 1e9 / self._pace - monotonic()
        if early_s > 0.0:
            sleep(early_s)
        else:
            self.latest_s = max(self.latest_s, -early_s)


class _Around:
    """The cell around the nodes under test, in one rehearsal.

    Attributes:
        notes: what depends on the host, one line each.
    """

    def __init__(self, cell: MockCell, bridge: Bridge, tested: Mapping[str, str], asked: AmongNodes) -> None:
        self.judgment = Judgment()
        self.notes: list[str] = []
        self._cell, self._bridge, self._tested, self._asked = cell, bridge, tested, asked
        self._arrivals = Arrivals(bridge, self.judgment)
        self._plant: Plant | None = None
        self._graph: Graph | None = None
        self._task: TaskUnderTest | None = None
        name = task_node(cell.contract)
        if name in tested:
            self._task = TaskUnderTest(name, tested[name], bridge, self._arrivals, self.judgment, asked.timing)
        self.steps = EXECUTED if self._task is None else self._task.steps
        self._listener: RunListener | None = None
        self._pacer: _Pacer | None = None
        self._nodes: list[PerceptionUnderTest] = []

    def begin(self, plant: Plant) -> None:
        """Put the cell on the graph, and wait for the nodes under test; nothing has run yet.

        Raises:
            MockError: a node does not appear, or is not on the topics that the contract has it on.
        """
        plant.simulation.run_process(_idle(_IDLE_NS))
        self._plant = plant
        clock = plant.clocks.of(next(iter(self._tested)))
        parameters = played_parameters(self._cell.folder)
        graph = Graph(self._bridge, plant.contract, self._tested.values(), clock, plant.simulation, parameters)
        plant.simulation.heard_outside = True
        self._graph = graph
        bag = RunBag(graph, plant)
        bag.begin(self._cell.folder.urdf)
        photographer = Photographer(plant, self._cell.folder.description, self._cell.folder.mesh_roots)
        bag.images(photographer.topics())
        self._listener = RunListener(plant, bag, RunTrace(plant))
        self._nodes = [
            PerceptionUnderTest(
                name, plant, graph, self._arrivals, bag, photographer, self.judgment, self._asked.timing
            )
            for name in self._tested
            if name in _observers(plant.contract)
        ]
        self._serve(plant, graph)
        graph.tick(plant.now_ns)
        for name, full in self._tested.items():
            self._await_node(full)
            self._bring_up(plant, full)
            for topic, publishes in _needs(plant.contract, name):
                self._await_end(plant.contract, name, topic, publishes=publishes)
        if _talk(plant.contract, self._tested):
            sleep(_MEET_S)
        graph.look()
        if self._asked.timing.pace is not None:
            self._keep_pace(plant, _Pacer(self._asked.timing.pace))

    def _serve(self, plant: Plant, graph: Graph) -> None:
        """Offer actions and services; those of a task under test are offered when the cell is up."""
        if self._task is not None:
            self._task.begin(plant, graph)
        else:
            servers = ActionServers(plant, graph, self._bridge)
            servers.offer()
            self._arrivals.go_to(NODE_NAME, servers.take)
        managers = ManagerServices(plant, self._bridge)
        if missing := managers.offer(graph):
            self.notes.append(missing)
        self._arrivals.go_to(NODE_NAME, managers.take)
        lifecycles = LifecycleServices(plant, self._bridge, self._tested.values())
        lifecycles.offer(graph)
        self._arrivals.go_to(NODE_NAME, lifecycles.take)

    def end(self) -> None:
        """Publish what is left, and note who has ended and how the host kept up."""
        if self._task is not None and self._plant is not None and self._graph is not None:
            self._task.end(self._plant, self._graph)
        if self._listener is not None:
            self._listener.end()
        for node in self._nodes:
            node.end()
        code = self._bridge.exit_code()
        if code is not None and (code or self._task is None):  # a task that is done may end
            text = f"`{self._asked.launch}` ended with exit code {code} before the rehearsal did"
            self.judgment.note(Violation.ENDED, self._asked.launch, text)
        if self._pacer is not None and self._pacer.latest_s > _LATE_S:
            self.notes.append(f"the host was up to {self._pacer.latest_s * 1e3:.0f} ms late: nodes saw time jump")

    def _await_node(self, full: str) -> None:
        until_s = monotonic() + self._asked.appear_s
        while full not in self._bridge.nodes():
            if (code := self._bridge.exit_code()) is not None:
                raise MockError("", f"`{self._asked.launch}` ended with exit code {code} before `{full}` appeared")
            if monotonic() > until_s:
                seen = ", ".join(f"`{node}`" for node in sorted(self._bridge.nodes())) or "no node"
                where = f"domain {self._asked.domain}, on which there is {seen}"
                raise MockError("", f"`{full}` does not appear within {self._asked.appear_s:g} s on {where}")
            sleep(_LOOK_S)

    def _bring_up(self, plant: Plant, full: str) -> None:
        """Ask for the transitions of a lifecycle node that its bring-up has."""
        for step in plant.bring_up:
            if isinstance(step.request, Transition) and step.request.node == full:
                problem = self._bridge.transition(full, step.request.transition, step.deadline_s)
                if problem:
                    raise MockError("", f"step `{step.name}` of the bring-up: {problem}")

    def _await_end(self, contract: Contract, name: str, topic: str, *, publishes: bool) -> None:
        """Wait until a node is on a topic, and hold its profile against the contract's."""
        full, until_s = self._tested[name], monotonic() + self._asked.appear_s
        while not (mine := [end for end in self._ends(topic, publishes=publishes) if end.node == full]):
            if monotonic() > until_s:
                what = "publishes no" if publishes else "does not subscribe to"
                raise MockError("", f"`{full}` {what} `{topic}`, which the contract has it on")
            sleep(_LOOK_S)
        interface = contract.interfaces[topic]
        stated = next(end.qos for end in (interface.sources if publishes else interface.sinks) if end.node == name)
        for end in mine:
            for policy in ("reliability", "durability"):
                got, expected = getattr(end, policy), getattr(stated, policy)
                if got != expected:
                    text = f"`{full}` is on `{topic}` as `{got}`, the contract states `{expected}`"
                    self.judgment.note(Violation.QOS, f"{topic} {policy}", text)
            if end.type != interface.type:
                text = f"`{full}` is on `{topic}` with type `{end.type}`, the contract states `{interface.type}`"
                self.judgment.note(Violation.QOS, topic, text)
        others = [end.node for end in self._ends(topic, publishes=True) if end.node != full] if publishes else []
        for node in others:
            text = f"`{node}` publishes `{topic}` too, which only `{full}` may"
            self.judgment.note(Violation.SECOND_PUBLISHER, topic, text)

    def _ends(self, topic: str, *, publishes: bool) -> tuple[GraphEnd, ...]:
        return self._bridge.publishers(topic) if publishes else self._bridge.subscriptions(topic)

    def _keep_pace(self, plant: Plant, pacer: _Pacer) -> None:
        self._pacer = pacer

        def tick(_: int) -> None:
            pacer.keep(plant.now_ns)
            self._arrivals.hear_all()

        plant.simulation.every(plant.now_ns, _TICK_HZ, tick)
