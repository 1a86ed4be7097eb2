"""The rights that the access policy of a package grants to each enclave, as sros2 reads it.

An enclave is a process: it has what all of its profiles grant. What a profile includes of ``security/common.xml`` is
resolved here, for fragments of the form that cellc writes; anything else in a profile is reported as it is written.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from cellc.robot.description.xml_tree import XmlElement
from cellc.tools.review.leaves import Leaf, Path, Prose

POLICY, COMMON = "security/policy.xml", "security/common.xml"
_FRAGMENT = re.compile(r"xpointer\(/common/(\w+)/\*\)")
_GROUPS = ("topics", "services", "actions")
# A spawner names itself after the first of its controllers, whose order says nothing.
_SPAWNER = re.compile(r"^spawner_.+")
_CHECKLIST = "gates/promotion.md"
_PAYLOAD = re.compile(
    r"^- \[ \] Payload of (\w+): ([^\n]+?) with tool, center of mass ([^\n]+?)(?:, inertia [^\n]*?)? in (\S+)\. ",
    re.MULTILINE,
)


def rights(policy: XmlElement, common: XmlElement | None, cell: str) -> Iterator[tuple[Path, Leaf]]:
    """Yield the names that each enclave may use, by right, such as ``publish``; a denied right begins with ``DENY``.

    Args:
        common: what the policy includes; None in a package that has no such file.
        cell: name of the cell, with which each enclave begins.
    """
    kinds = {} if common is None else {kind.tag: kind.children for kind in common.children}
    for enclave in (child for group in policy.all("enclaves") for child in group.children):
        found: dict[str, set[str]] = {}
        for profile in (child for group in enclave.children for child in group.children):
            for right, name in _of_profile(profile, kinds):
                found.setdefault(right, set()).add(name)
        path = enclave.attributes.get("path", "").removeprefix(f"/{cell}")
        yield from ((("right", path, right), tuple(sorted(names))) for right, names in found.items())


def _of_profile(profile: XmlElement, kinds: Mapping[str, list[XmlElement]]) -> Iterator[tuple[str, str]]:
    home = profile.attributes.get("ns", "").rstrip("/")
    node = f"{home}/{_SPAWNER.sub('spawner', profile.attributes.get('node', ''))}"
    for group in (group for child in profile.children for group in _included(child, kinds)):
        if group.tag not in _GROUPS:
            yield "other", " ".join((group.tag, *group.attributes.values()))
            continue
        names = [entry.text.strip() for entry in group.children]
        full = [node + name[1:] if name.startswith("~") else name for name in names]
        for right, qualifier in group.attributes.items():
            kind = right if qualifier == "ALLOW" else f"{qualifier} {right}"
            yield from ((kind, name if name.startswith("/") else f"{home}/{name}") for name in full)


def _included(child: XmlElement, kinds: Mapping[str, list[XmlElement]]) -> list[XmlElement]:
    """Return a child of a profile, or the fragment that it includes."""
    fragment = _FRAGMENT.fullmatch(child.attributes.get("xpointer", ""))
    if child.tag != "xi:include" or child.attributes.get("href") != "common.xml" or fragment is None:
        return [child]
    return kinds.get(fragment[1], [child])


def of_checklist(files: Mapping[str, str]) -> Iterator[tuple[Path, Prose]]:
    """Yield the payloads that people set where no program can compare them: the checklist alone has them."""
    for device, *values in _PAYLOAD.findall(files.get(_CHECKLIST, "")):
        for what, value in zip(("mass", "center_of_mass", "frame"), values, strict=True):
            yield ("check", "payload", device, what), Prose(value)
