"""What one node may do, and its element in the policy."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.formats.xml_text import element


@dataclass(frozen=True, slots=True)
class Profile:
    """Rights of one node; names are absolute, or ``~/…`` below the node's own."""

    namespace: str
    node: str
    publish: tuple[str, ...] = ()
    subscribe: tuple[str, ...] = ()
    reply: tuple[str, ...] = ()
    request: tuple[str, ...] = ()
    execute: tuple[str, ...] = ()
    call: tuple[str, ...] = ()


def profile_element(profile: Profile) -> Element:
    """Return ``<profile>`` with one list a right; a name stands once in each, in alphabetical order."""
    return element("profile", {"ns": profile.namespace or "/", "node": profile.node}, _lists(profile))


def _lists(profile: Profile) -> Iterator[Element]:
    for plural, right, names in (
        ("topics", "publish", profile.publish),
        ("topics", "subscribe", profile.subscribe),
        ("services", "reply", profile.reply),
        ("services", "request", profile.request),
        ("actions", "execute", profile.execute),
        ("actions", "call", profile.call),
    ):
        if names:
            entries = (element(plural[:-1], text=name) for name in sorted(set(names)))
            yield element(plural, {right: "ALLOW"}, entries)
