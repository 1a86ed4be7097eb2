"""The environment of one host: middleware, domain, discovery, profile."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.emit.middleware.binding import Binding, origins
from cellc.formats.header import Header

_RANGE = {"multicast": "SUBNET", "unicast": "LOCALHOST", "localhost": "LOCALHOST", "off": "OFF"}
_VARIABLES = {
    ".cyclonedds.xml": ("CYCLONEDDS_URI",),
    ".zenoh_router.json5": ("ZENOH_ROUTER_CONFIG_URI",),
    ".zenoh_session.json5": ("ZENOH_SESSION_CONFIG_URI",),
    # Fast DDS 2 reads the old name and 3 the new one; the other is ignored.
    ".fastdds.xml": ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"),
}


def environment(cell: Cell, header: Header, binding: Binding, profiles: tuple[str, ...]) -> str:
    """Return a shell file that sets the variables; no secret stands in it."""
    lines = [f'export {name}="{value}"' for name, value in _variables(cell, binding, profiles)]
    share = f'_cell_share="$(ros2 pkg prefix --share {cell.name})"'
    origin = f"# {', '.join(origins(binding))}"
    return header.commented("#") + "\n".join([origin, share, *lines, "unset _cell_share"]) + "\n"


def _variables(cell: Cell, binding: Binding, profiles: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    rmw = cell.spec.versions.rmw.split()[0]
    if rmw != "UNKNOWN":
        yield "RMW_IMPLEMENTATION", rmw
    yield "ROS_DOMAIN_ID", str(cell.spec.network.domain_id)
    yield from _discovery(cell, binding)
    for path in profiles:
        suffix = path[path.index(".") :]
        scheme = "file://" if suffix == ".cyclonedds.xml" else ""
        yield from ((variable, f"{scheme}${{_cell_share}}/{path}") for variable in _VARIABLES[suffix])


def _discovery(cell: Cell, binding: Binding) -> Iterator[tuple[str, str]]:
    discovery = cell.spec.network.discovery
    if cell.distro == "humble":  # its only switch; peers stand in the profile
        yield "ROS_LOCALHOST_ONLY", "1" if discovery in ("localhost", "off") else "0"
        return
    # Without multicast a host finds others by their addresses alone: a static peer reaches out of LOCALHOST too.
    yield "ROS_AUTOMATIC_DISCOVERY_RANGE", _RANGE[discovery]
    if binding.peers:
        yield "ROS_STATIC_PEERS", ";".join(binding.peers)
