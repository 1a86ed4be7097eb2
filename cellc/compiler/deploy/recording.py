"""What an attempt records: topics with a QoS that suits every publisher, and the command that does it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Interface
from cellc.compiler.deploy.files import RECORDING
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.formats.urdf.hardware import credentials
from cellc.contract.entities import Qos
from cellc.contract.qos import DEFAULT, recorder_depth, weakest
from cellc.contract.vocabulary import TRAJECTORIES, Feature, InterfaceKind, features


def record_command(cell: Cell, bag: str) -> tuple[str, ...]:
    """Return the command that records an attempt, in parts of one line each; it goes on until it is interrupted.

    Args:
        bag: name of the folder below that of the attempt, ``$E``; there must be none of it yet.
    """
    return (
        "ros2 bag record --storage mcap --include-hidden-topics",
        f"--qos-profile-overrides-path generated/{cell.name}/{RECORDING}",
        f'--output "$E/{bag}"',
        *(("--topics",) if Feature.RECORD_TOPICS_OPTION in features(cell.distro) else ()),
        *map(shell_word, recorded_topics(cell)),
    )


def recorded_topics(cell: Cell) -> dict[str, Qos]:
    """Return every recorded topic with a profile that each of its publishers satisfies; none of the mock alone.

    A description with the password of a device is not recorded: bags are handed on.
    """
    secret = any(credentials(device) != ((), ()) for device in cell.devices)
    topics = {
        interface.name: _offered(interface)
        for interface in cell.interfaces
        if _on_the_path(interface) and not (secret and interface.name.endswith("/robot_description"))
    }
    # Goals and results of actions are hidden services; feedback and status tell what became of them.
    for action in (i for i in cell.interfaces if i.kind is InterfaceKind.ACTION and "real" in i.targets):
        topics[f"{action.name}/_action/feedback"] = DEFAULT
        topics[f"{action.name}/_action/status"] = replace(DEFAULT, durability="transient_local", depth=1)
    for name in _controller_states(cell):
        topics.setdefault(name, replace(DEFAULT, depth=1000))
    for manager in reporting(cell):  # values without their names say nothing
        topics[f"{manager}/statistics/names"] = replace(DEFAULT, durability="transient_local", depth=1)
        topics[f"{manager}/statistics/values"] = replace(DEFAULT, depth=1000)
    topics.setdefault("/rosout", replace(DEFAULT, durability="transient_local", depth=1000))
    for name in ("/diagnostics", *cell.recording.topics):
        topics.setdefault(name, DEFAULT)
    return topics


_CYCLES = "~/statistics/values"
"""Topic below a controller manager with what each of its cycles took."""


def reporting(cell: Cell) -> tuple[str, ...]:
    """Return the controller managers that publish what their cycles take: not those of every release do."""
    published = {node.full_name: node.endpoints.publishes for node in cell.nodes}
    return tuple(manager.node for manager in cell.managers if _CYCLES in published.get(manager.node, ()))


def _controller_states(cell: Cell) -> Iterator[str]:
    """Yield where trajectory controllers of the real target publish reference, feedback and error."""
    for manager in cell.managers:
        for controller in manager.controllers:
            if controller.behavior in TRAJECTORIES and "real" in controller.targets:
                yield f"{controller.full_name}/controller_state"


def _on_the_path(interface: Interface) -> bool:
    on_real = "real" in interface.targets
    return on_real and interface.kind is InterfaceKind.TOPIC and not interface.type.endswith(("/Image", "/PointCloud2"))


def _offered(interface: Interface) -> Qos:
    """Return a profile that every publisher satisfies, the weakest that one of them offers, with a queue for all."""
    offered = [source.qos for source in interface.sources]
    reliability, durability = weakest(offered)
    depth = recorder_depth((qos.depth for qos in offered), interface.rate_hz)
    return replace(DEFAULT, reliability=reliability, durability=durability, depth=depth)
