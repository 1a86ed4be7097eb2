"""Layers L1 to L6: from the cable to the command path, drives disabled."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.interface import Endpoint, Interface, InterfaceKind
from cellc.deploy.gates import Check, Gate
from cellc.deploy.processes import described_by, movers, started_by_a_person
from cellc.deploy.releases import start_mock
from cellc.formats.numbers import shortest
from cellc.graph.cell_graph import CellGraph


def network_gates(graph: CellGraph) -> tuple[Gate, ...]:
    """Return the layers in order."""
    cell = graph.cell
    return (_physical(graph), _vendor(cell), _discovery(cell), _data(cell), _time(cell), _command(cell))


def _physical(graph: CellGraph) -> Gate:
    cards = tuple(
        Check(f"Card {nic.full_name} has {nic.text} and carries {', '.join(nic.carries) or 'nothing stated'}")
        for nic in graph.network.nics
    )
    routes = tuple(
        Check(
            f"On {device.host}: {device.device} answers over card {device.nic or 'not stated'}",
            (f"ip route get {device.text}", f"ping -c 5 {device.text}"),
        )
        for device in graph.network.devices
        if device.text is not None
    )
    return Gate(
        code="L1",
        title="Physical",
        shows="cables, addresses and routes keep control traffic on its own card",
        state="drives off",
        checks=(Check("Links, addresses and routes are saved", ("ip -br addr", "ip route")), *cards, *routes),
        evidence="L1-links.txt",
        owner=graph.cell.owners.approvals.network,
        stop=("a duplicate address", "a link that comes and goes", "control traffic on a card that is not for it"),
    )


def _vendor(cell: Cell) -> Gate:
    identities = tuple(
        Check(
            f"{device.name} shows serial `{device.versions.serial}`, firmware `{device.versions.firmware}` and its "
            "safety state"
        )
        for device in cell.devices
    )
    return Gate(
        code="L2",
        title="Vendor interface",
        shows="each device is the one in the spec, and says that it is safe to read",
        state="drives disabled",
        checks=identities,
        evidence="L2-identity.md",
        owner=cell.owners.approvals.vendor,
        stop=("an unexpected remote-control mode", "another device than the one in the spec"),
    )


def _discovery(cell: Cell) -> Gate:
    domain = cell.network.domain_id
    ends = tuple(
        Check(f"`{interface.name}` has its declared ends: {_ends(cell, interface)}", (_info(interface),))
        for interface in cell.interfaces
        if "real" in interface.targets
    )
    return Gate(
        code="L3",
        title="Discovery",
        shows="every interface has its declared ends, and nobody else",
        state="drives disabled",
        checks=(
            Check(
                f"Every shell and node is in domain {domain}",
                ("printenv ROS_DOMAIN_ID RMW_IMPLEMENTATION", "ros2 node list"),
            ),
            *ends,
        ),
        evidence="L3-endpoints.txt",
        owner=cell.owners.approvals.graph,
        stop=("an unknown publisher of commands", "two servers of one action"),
    )


def _data(cell: Cell) -> Gate:
    return Gate(
        code="L4",
        title="Topics and QoS",
        shows="samples arrive at their rate, and none is too old",
        state="drives disabled",
        checks=tuple(_freshness(cell)),
        evidence="L4-age.txt",
        owner=cell.owners.approvals.data,
        stop=("a stale sample that is taken for a fresh one", "a topic without samples although it is listed"),
    )


def _freshness(cell: Cell) -> Iterator[Check]:
    for interface in cell.interfaces:
        if interface.kind is InterfaceKind.TOPIC and interface.rate_hz is not None and "real" in interface.targets:
            age = "" if interface.max_age_s is None else f", no sample older than {shortest(interface.max_age_s)} s"
            yield Check(
                f"`{interface.name}` arrives at {_rate(interface.rate_hz, len(interface.sources))}{age}",
                (f"timeout 60 ros2 topic hz {interface.name}", f"timeout 60 ros2 topic delay {interface.name}"),
            )


def _rate(rate_hz: float, sources: int) -> str:
    # What is measured is the sum of all sources, and the interface has the rate of the slowest controller manager.
    return f"{shortest(rate_hz)} Hz" if sources < 2 else f"{shortest(rate_hz)} Hz or more: {sources} sources add up"


def _time(cell: Cell) -> Gate:
    clocks = tuple(
        Check(
            f"On {name}: its clock is within {cell.text(*host.path, 'clock', 'max_offset')} of the others",
            ("chronyc tracking",),
        )
        for name, host in cell.hosts.items()
        if host.clock.max_offset_s is not None
    )
    tips = tuple(
        Check(
            f"{group.tip_frame} is found in {group.base_link}",
            (f"timeout 10 ros2 run tf2_ros tf2_echo {group.base_link} {group.tip_frame}",),
        )
        for group in cell.groups
    )
    return Gate(
        code="L5",
        title="Time and TF",
        shows="clocks agree, and every frame has one authority",
        state="drives disabled",
        checks=(
            *clocks,
            *tips,
            Check(
                "Every frame has one authority, that of `config/frames.yaml`",
                ("timeout 600 ros2 run tf2_ros tf2_monitor",),
            ),
        ),
        evidence="L5-tf.txt",
        owner=cell.owners.approvals.time_tf,
        stop=("a jump of a clock", "two authorities of one frame", "another configuration id than this package's"),
    )


def _command(cell: Cell) -> Gate:
    return Gate(
        code="L6",
        title="Command path",
        shows="a goal is taken, cancelled and refused, with no route to a drive",
        state="mock, or drives off",
        checks=(
            Check("The real target has ended, and the mock runs in its place", (start_mock(cell),)),
            Check(
                "Every plugin of the description that runs is a mock",
                tuple(f"ros2 param get {node} robot_description | grep plugin" for node in described_by(cell)),
            ),
            Check(
                "A goal reaches the mock's controller, is cancelled, and violates a tolerance",
                (f"cellc mock generated/{cell.name} --gates",),
            ),
        ),
        evidence="L6-command.md",
        owner=cell.owners.approvals.controller,
        stop=("a route to a real interface",),
    )


def _ends(cell: Cell, interface: Interface) -> str:
    late = {node.name for node in movers(cell) if started_by_a_person(cell, node)}

    def names(ends: tuple[Endpoint, ...]) -> str:
        return ", ".join(end.node + (" (from G7 on)" if end.node in late else "") for end in ends) or "nobody"

    return f"{names(interface.sources)} → {names(interface.sinks)}"


def _info(interface: Interface) -> str:
    if interface.kind is InterfaceKind.ACTION:
        return f"ros2 action info {interface.name}"
    if interface.kind is InterfaceKind.SERVICE:
        return f"ros2 service type {interface.name}"
    return f"ros2 topic info -v {interface.name}"
