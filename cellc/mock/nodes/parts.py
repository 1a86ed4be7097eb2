"""A robot description, cut into the parts of the contract: robots that reach each other, and what they reach."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from cellc.contract.contract import Contract
from cellc.robot.description.meshes import with_links
from cellc.robot.description.model import Description


def cut(contract: Contract, urdf: str, description: Description) -> Iterator[tuple[str, Description]]:
    """Yield the text of each part with what it says; all of it where the contract names no parts.

    A part has its devices and things, what people fixed to them, and all that they hang on. Hardware is left out.
    """
    if not contract.parts:
        yield urdf, description
        return
    parents = {joint.child: joint.parent for joint in description.joints}
    owned: dict[str, list[str]] = {}
    for link, owner in _owners(contract, description, parents).items():
        owned.setdefault(owner, []).append(link)
    places = {link.name: place for place, link in enumerate(description.links)}
    above = {joint.child: joint for joint in description.joints}
    parts = [
        sorted(_with_carriers((link for name in part for link in owned.get(name, ())), parents), key=places.__getitem__)
        for part in contract.parts
    ]
    for names, text in zip(parts, with_links(urdf, parts), strict=True):
        own = tuple(description.links[places[name]] for name in names)
        yield text, replace(description, links=own, joints=tuple(above[name] for name in names if name in above))


def _owners(contract: Contract, description: Description, parents: Mapping[str, str]) -> dict[str, str]:
    """Return the device or thing of each link: of the nearest one above it; of the world's own, none."""
    roots = {device.root_link: name for name, device in contract.devices.items()}
    owners = roots | {name: name for name, frame in contract.frames.items() if frame.kind == "scene"}
    for link in description.links:
        way = [link.name]
        while way[-1] not in owners and way[-1] in parents and len(way) <= len(parents):
            way.append(parents[way[-1]])
        owners |= dict.fromkeys(way, owners.get(way[-1], ""))
    return {link.name: owners[link.name] for link in description.links}


def _with_carriers(links: Iterable[str], parents: Mapping[str, str]) -> list[str]:
    known: dict[str, None] = {}
    for link in links:
        while link not in known:
            known[link] = None
            link = parents.get(link, link)
    return list(known)
