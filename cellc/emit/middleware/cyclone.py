"""Profile of Cyclone DDS: the listed cards alone.

Only elements that 0.10.5 and 11.0.1 share: an element that a version does not know makes the domain fail.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.emit.middleware.binding import Binding
from cellc.formats.xml_text import element

_MOST_PROCESSES = "99"  # rmw_cyclonedds stops at 32 participants where discovery is unicast


def cyclone_profile(cell: Cell, binding: Binding) -> Element:
    """Return the configuration of the cell's domain on a host."""
    domain = {"Id": str(cell.spec.network.domain_id)}
    parts = [*_general(cell, binding), *_discovery(cell, binding)]
    return element("CycloneDDS", {"xmlns": "https://cdds.io/config"}, [element("Domain", domain, parts)])


def _general(cell: Cell, binding: Binding) -> Iterator[Element]:
    cards = [element("NetworkInterface", {"address": address}) for address in binding.addresses]
    multicast = "true" if cell.spec.network.discovery == "multicast" else "false"
    yield element(
        "General",
        children=[element("Interfaces", children=cards), element("AllowMulticast", text=multicast)],
    )


def _discovery(cell: Cell, binding: Binding) -> Iterator[Element]:
    if cell.spec.network.discovery == "multicast":
        return
    # Later distributions add the peers of ROS_STATIC_PEERS themselves.
    peers = binding.peers if cell.distro == "humble" else ()
    listed = [element("Peer", {"Address": address}) for address in (*binding.addresses[:1], *peers)]
    yield element(
        "Discovery",
        children=[
            element("ParticipantIndex", text="auto"),
            element("MaxAutoParticipantIndex", text=_MOST_PROCESSES),
            element("Peers", children=listed),
        ],
    )
