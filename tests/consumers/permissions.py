"""What an emitted policy comes to in DDS: the topics that each enclave may write and read, as sros2 makes them.

Written from the design article "ROS 2 access control policies" and sros2's schema of a policy, version 0.2.0: an
enclave is one process, and has what all of its profiles grant; what nothing grants is denied; ``*`` is any characters.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal
from xml.etree.ElementTree import Element, fromstring

from lxml import etree

Right = Literal["publish", "subscribe", "reply", "request", "execute", "call"]
_SERVICES = ("cancel_goal", "get_result", "send_goal")
_TOPICS = ("feedback", "status")


@dataclass(frozen=True, slots=True)
class Permissions:
    """The patterns of one enclave: names of DDS topics."""

    write: frozenset[str]
    read: frozenset[str]

    def allow(self, right: Right, name: str) -> bool:
        """Whether a process of this enclave may make an end of an interface, by its absolute name."""
        write, read = dds_topics(right, name)
        # DDS compares by fnmatch; "[" stands in no name of ROS.
        return all(any(fnmatchcase(one, pattern) for pattern in self.write) for one in write) and all(
            any(fnmatchcase(one, pattern) for pattern in self.read) for one in read
        )

    def without(self, right: Right, name: str) -> Permissions:
        """Return the permissions without what one end needs."""
        write, read = dds_topics(right, name)
        return Permissions(
            frozenset(pattern for pattern in self.write if not any(fnmatchcase(name, pattern) for name in write)),
            frozenset(one for one in self.read if not any(fnmatchcase(gone, one) for gone in read)),
        )


def dds_topics(right: Right, name: str) -> tuple[list[str], list[str]]:
    """Return the topics that an end writes, and those that it reads."""
    if right in ("publish", "subscribe"):
        return ([f"rt{name}"], []) if right == "publish" else ([], [f"rt{name}"])
    if right in ("reply", "request"):
        ends = [f"rr{name}Reply"], [f"rq{name}Request"]
        return ends if right == "reply" else (ends[1], ends[0])
    said = [f"rr{name}/_action/{service}Reply" for service in _SERVICES] + [
        f"rt{name}/_action/{topic}" for topic in _TOPICS
    ]
    heard = [f"rq{name}/_action/{service}Request" for service in _SERVICES]
    return (said, heard) if right == "execute" else (heard, said)


def policy_text(texts: Mapping[str, str]) -> str:
    """Return the policy of a package with what it includes in its place, as sros2 loads it.

    sros2 0.13.0, sros2/policy/__init__.py: ``etree.parse(path)``, then ``xinclude()``.
    """
    return _included(texts["security/policy.xml"], texts["security/common.xml"])


@lru_cache(maxsize=64)
def _included(policy: str, common: str) -> str:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "policy.xml"
        file.write_text(policy, encoding="utf-8")
        file.with_name("common.xml").write_text(common, encoding="utf-8")
        tree = etree.parse(str(file))
        for include in tree.iter("{http://www.w3.org/2001/XInclude}include"):
            path = include.attrib["xpointer"].removeprefix("xpointer(").removesuffix(")")
            # An expression that finds nothing includes nothing, without a word.
            assert etree.fromstring(common.encode()).xpath(path), path
        tree.xinclude()
        return str(etree.tostring(tree, encoding="unicode"))


def policy_of(texts: Mapping[str, str]) -> Element:
    """Return the policy of a package as a tree, with what it includes in its place."""
    return fromstring(policy_text(texts))


def permissions(texts: Mapping[str, str]) -> dict[str, Permissions]:
    """Return the permissions of every enclave of a package's policy."""
    found = {}
    for enclave in policy_of(texts).iter("enclave"):
        ends = [dds_topics(right, name) for right, name in _grants(enclave)]
        found[enclave.attrib["path"]] = Permissions(
            frozenset(pattern for write, _ in ends for pattern in write),
            frozenset(one for _, read in ends for one in read),
        )
    return found


def _grants(enclave: Element) -> Iterator[tuple[Right, str]]:
    rights: tuple[Right, ...] = ("publish", "subscribe", "reply", "request", "execute", "call")
    for profile in enclave.iter("profile"):
        home = profile.attrib["ns"].rstrip("/")
        for kind in profile:
            assert "DENY" not in kind.attrib.values()  # it would beat every grant of the enclave
            for right in rights:
                if kind.get(right) == "ALLOW":
                    yield from ((right, _full(entry.text or "", home, profile.attrib["node"])) for entry in kind)


def _full(name: str, home: str, node: str) -> str:
    if name.startswith("~"):
        return f"{home}/{node}{name[1:]}"
    return name if name.startswith("/") else f"{home}/{name}"
