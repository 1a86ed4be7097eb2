"""Profile of Fast DDS: UDP on the listed cards alone, shared memory within the host."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.emit.middleware.binding import Binding
from cellc.formats.xml_text import element

_UDP, _SHARED = "cell_udp", "cell_shared_memory"
# Fast DDS 2.x, of Humble and Jazzy, and 3.x name the same elements under different namespaces.
_OLD = ("humble", "jazzy")
_OLD_NAMESPACE = "http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"
_NAMESPACE = "http://www.eprosima.com"


def fast_profile(cell: Cell, binding: Binding) -> Element:
    """Return the default profile of every participant on a host."""
    namespace = _OLD_NAMESPACE if cell.distro in _OLD else _NAMESPACE
    return element(
        "dds", {"xmlns": namespace}, [element("profiles", children=[_transports(binding), _all(cell, binding)])]
    )


def _transports(binding: Binding) -> Element:
    # interfaceWhiteList is the one list that every supported version reads.
    cards = element("interfaceWhiteList", children=[element("address", text=a) for a in binding.addresses])
    udp = [element("transport_id", text=_UDP), element("type", text="UDPv4"), cards]
    shared = [element("transport_id", text=_SHARED), element("type", text="SHM")]
    return element(
        "transport_descriptors",
        children=[element("transport_descriptor", children=udp), element("transport_descriptor", children=shared)],
    )


def _all(cell: Cell, binding: Binding) -> Element:
    used = [element("transport_id", text=name) for name in (_SHARED, _UDP)]
    rtps = [
        *_peers(cell, binding),
        element("userTransports", children=used),
        element("useBuiltinTransports", text="false"),
    ]
    return element(
        "participant",
        {"profile_name": "cell", "is_default_profile": "true"},
        [element("rtps", children=rtps)],
    )


def _peers(cell: Cell, binding: Binding) -> Iterator[Element]:
    if cell.distro != "humble" or not binding.peers:  # later ones take ROS_STATIC_PEERS
        return
    locators = [
        element("locator", children=[element("udpv4", children=[element("address", text=address)])])
        for address in (*binding.addresses[:1], *binding.peers)
    ]
    yield element("builtin", children=[element("initialPeersList", children=locators)])
