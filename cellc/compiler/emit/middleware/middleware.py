"""``middleware/<host>.*``: environment and profile of the pinned middleware, for each host of the spec.

``<host>.sh`` is sourced before anything of the cell is started. Fast DDS, Cyclone DDS and Zenoh each get the file that
they read; only that of the pinned implementation is written. Left out: QoS of topics, which belongs to the endpoints,
and tuning of buffers, which cannot be stated without measuring. ``<host>.discovery_server_N`` starts a discovery server
of Fast DDS (``fastdds discovery`` of 2.6 to 3.6, tools/fds) where the spec has one there.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.emit.middleware.profiles import (
    Binding,
    bindings,
    cyclone_profile,
    fast_profile,
    origins,
    zenoh_router,
    zenoh_session,
)
from cellc.compiler.formats.escape import shell_quoted
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.xml_text import render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import UNKNOWN, Feature, features

_RANGE = {"multicast": "SUBNET", "unicast": "LOCALHOST", "localhost": "LOCALHOST", "server": "SUBNET", "off": "OFF"}
_FAST = ("rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp")
_VARIABLES = {
    ".cyclonedds.xml": ("CYCLONEDDS_URI",),
    ".zenoh_router.json5": ("ZENOH_ROUTER_CONFIG_URI",),
    ".zenoh_session.json5": ("ZENOH_SESSION_CONFIG_URI",),
    # Fast DDS 2 reads the old name and 3 the new one; the other is ignored.
    ".fastdds.xml": ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"),
}


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield environment and profiles."""
    for binding in bindings(graph):
        profiles = tuple(_profiles(graph, plan.header, binding))
        names = tuple(artifact.path for artifact in profiles if "." + artifact.path.partition(".")[2] in _VARIABLES)
        yield Artifact(f"middleware/{binding.host}.sh", environment(graph.cell, plan.header, binding, names))
        yield from profiles


def _profiles(graph: CellGraph, header: Header, binding: Binding) -> Iterator[Artifact]:
    rmw = graph.cell.versions.rmw_name
    stem, head = f"middleware/{binding.host}", f"{header.text}\nFrom {', '.join(origins(binding))}."
    if rmw == "rmw_cyclonedds_cpp":
        yield Artifact(f"{stem}.cyclonedds.xml", render(cyclone_profile(graph.cell, binding), head))
    elif rmw == "rmw_zenoh_cpp":
        yield Artifact(
            f"{stem}.zenoh_router.json5",
            header.commented("//") + f"// {', '.join(origins(binding))}\n" + zenoh_router(binding),
        )
        yield Artifact(f"{stem}.zenoh_session.json5", header.commented("//") + zenoh_session())
    elif rmw in _FAST:
        yield Artifact(f"{stem}.fastdds.xml", render(fast_profile(graph.cell, binding), head))
        yield from (_discovery_server(header, binding, number) for number in binding.runs)


def _discovery_server(header: Header, binding: Binding, number: int) -> Artifact:
    """Return the program of a discovery server: it runs before anything of the cell, and does not end."""
    address, port = binding.servers[number]
    start = f"exec fastdds discovery -i {number} -l {address} -p {port}"
    text = f"#!/bin/sh\n{header.commented('#')}# network.servers[{number}]\n{start}\n"
    return Artifact(f"middleware/{binding.host}.discovery_server_{number}", text, executable=True)


def environment(cell: Cell, header: Header, binding: Binding, profiles: tuple[str, ...]) -> str:
    """Return a shell file that sets the variables; no secret is in it."""
    lines = [f'export {name}="{value}"' for name, value in _variables(cell, binding, profiles)]
    share = f'_cell_share="$(ros2 pkg prefix --share {cell.name})"'
    origin = f"# {', '.join(origins(binding))}"
    return header.commented("#") + "\n".join([origin, share, *lines, "unset _cell_share"]) + "\n"


def _variables(cell: Cell, binding: Binding, profiles: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    rmw = cell.versions.rmw_name
    if rmw != UNKNOWN:
        yield "RMW_IMPLEMENTATION", shell_quoted(rmw)
    yield "ROS_DOMAIN_ID", str(cell.network.domain_id)
    yield from _discovery(cell, binding)
    for path in profiles:
        suffix = path[path.index(".") :]
        scheme = "file://" if suffix == ".cyclonedds.xml" else ""
        yield from ((variable, f"{scheme}${{_cell_share}}/{path}") for variable in _VARIABLES[suffix])


def _discovery(cell: Cell, binding: Binding) -> Iterator[tuple[str, str]]:
    discovery = cell.network.discovery
    if Feature.STATIC_PEERS not in features(cell.distro):  # one switch; peers stand in the profile
        yield "ROS_LOCALHOST_ONLY", "1" if discovery in ("localhost", "off") else "0"
        return
    if cell.versions.rmw_name in _FAST and discovery in ("unicast", "server", "localhost"):
        yield "ROS_AUTOMATIC_DISCOVERY_RANGE", "SYSTEM_DEFAULT"  # peers and cards stand in the profile, and no others
        return
    # Without multicast a host finds others by their addresses alone: a static peer reaches out of LOCALHOST too.
    yield "ROS_AUTOMATIC_DISCOVERY_RANGE", _RANGE[discovery]
    if binding.peers:
        yield "ROS_STATIC_PEERS", shell_quoted(";".join(binding.peers))
