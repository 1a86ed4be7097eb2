"""What rules on geometry share: the findings that they assume absent, and how they sort and name contacts."""

from __future__ import annotations

from collections.abc import Sequence

from cellc.feasibility import BodyContact, DisabledAnswer, MotionAnswer, mesh_faults
from cellc.limits import option
from cellc.rules.kit import CellGraph, Finding, Findings, found

USABLE_MESHES = ("malformed-mesh", "mesh-not-found", "mesh-outside-root", "mesh-too-large")
"""What keeps a collision shape from being known."""

SOUND_MODEL = (
    "circular-mimic",
    "degrees-as-radians",
    "duplicate-model-name",
    "frame-cycle",
    "group-without-joints",
    "implausible-distance",
    "joint-of-unknown-link",
    "link-with-two-parents",
    "mimic-of-fixed-joint",
    "mimic-of-nothing",
    "missing-joint-limits",
    "missing-velocity-limit",
    "non-unit-axis",
    "reversed-limits",
    "several-root-links",
    "shared-prefix",
    "tip-off-the-tool-chain",
    "two-authorities",
    "zero-axis",
)

KNOWN_POSES = (*SOUND_MODEL, "pose-outside-limits", "wrong-pose-size")
"""Adds that named poses, one of which is where the cell begins, are joint positions that exist."""

KNOWN_GOALS = (*KNOWN_POSES, "goal-moves-with-tip", "goal-out-of-reach", "implausible-approach")
"""Adds that every goal is at a place worth a search."""


def unusable_meshes(graph: CellGraph, code: str) -> Findings:
    """Yield the meshes of collision shapes that cannot be used for the reason that a rule reports."""
    for fault in mesh_faults(graph):
        if fault.code == code:
            yield Finding(fault.message, fault.span, fault.path, fault.help)


def beyond_limits(graph: CellGraph, answer: MotionAnswer | DisabledAnswer) -> Findings:
    """Yield the limit that an answer is beyond."""
    if answer.limit:
        advice = f"use fewer and larger shapes in `<collision>` and in `scene`; {option(answer.limit)}"
        yield found(graph, ("motion", "groups"), answer.refused, advice)


def with_scene(graph: CellGraph, contacts: Sequence[BodyContact]) -> list[BodyContact]:
    """Return the contacts with a box of the scene."""
    boxes = {box.name for box in graph.cell.scene}
    return [contact for contact in contacts if contact.first in boxes or contact.second in boxes]


def within_robot(graph: CellGraph, contacts: Sequence[BodyContact]) -> list[BodyContact]:
    """Return the contacts of links with links."""
    others = with_scene(graph, contacts)
    return [contact for contact in contacts if contact not in others]


def named(contacts: Sequence[BodyContact]) -> str:
    """Name the first contact, and say how many more there are."""
    more = f", and {len(contacts) - 1} more such pairs" if len(contacts) > 1 else ""
    return f"`{contacts[0].first}` and `{contacts[0].second}` touch{more}"
