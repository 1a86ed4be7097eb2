"""Rules on what the plugin of an own device gets of its connection."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.cell.device import Connection, Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule

_ADDRESS = re.compile(r"\d{1,3}(?:\.\d{1,3}){3}")
_PORT = re.compile(r"/dev/\S+|v?s?l?can\d+")
_REAL = ("control", "hardware", "real", "parameters")


@rule(Severity.ERROR, assumes=("address-of-a-carried-device", "malformed-address", "tool-serial-mismatch"))
def parameter_against_connection(graph: CellGraph) -> Findings:
    """Yield parameters in a `device.yaml` that name another address or port than the spec, or one that it lacks."""
    cards = {nic.address.partition("/")[0] for host in graph.cell.hosts.values() for nic in host.nics.values()}
    for device in graph.cell.devices:
        link, places = device.site.connection, device.body.places
        by_carrier = device.site.network is not None and device.site.network.by_carrier
        for path, text in _parameters(device) if link is not None and not by_carrier else ():
            assert places is not None  # its parameters were read from there
            key, message = _wrong(text, link, cards) if link is not None else ("", "")
            if message:
                message = f"`{path[-1]}` of the plugin of `{device.name}` {message}"
                related = (Related("its `device.yaml` has it", places.locate(path)),)
                advice = f"write `{{{key}}}` there, and the {key} here"
                yield found(graph, (*device.path, "connection", key), message, advice, related)


def _parameters(device: Device) -> Iterator[tuple[YamlPath, str]]:
    """Yield the parameters of the real plugin and of nodes as the user wrote them."""
    places = device.body.places
    texts = {} if places is None else places.texts
    may_lack = {text for path, text in texts.items() if path[:4] == (*_REAL[:3], "left_out_when_empty")}
    for path, text in texts.items():
        if (path[:4] == _REAL and path[-1] not in may_lack) or (path[0] == "nodes" and path[2:3] == ("parameters",)):
            yield path, text


def _wrong(text: str, link: Connection, cards: set[str]) -> tuple[str, str]:
    """Return which key of the connection a parameter contradicts, and how; empty where it contradicts none."""
    for key, stated in (("address", link.address), ("port", link.port)):
        if f"{{{key}}}" in text and stated is None:
            return key, f"needs the {key} of the connection, which states none"
    if _ADDRESS.fullmatch(text) and link.address is not None and text not in (link.address, *cards):
        return "address", f"must be the address of the connection, {link.address}, got {text}"
    if _PORT.fullmatch(text) and link.port is not None and text != link.port:
        return "port", f"must be the port of the connection, {link.port}, got {text}"
    return "", ""
