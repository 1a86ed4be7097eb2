"""What rules on geometry share: the findings that they assume absent, and how they sort and name contacts."""

from __future__ import annotations

from collections.abc import Sequence

from cellc.compiler.cell.frame import Frame, FrameKind
from cellc.compiler.feasibility import BodyContact, DisabledAnswer, MotionAnswer
from cellc.compiler.rules.kit import CellGraph, Findings, Related, found
from cellc.contract.diagnostics import Span
from cellc.contract.limits import option

USABLE_MESHES = ("malformed-mesh", "mesh-outside-root", "mesh-too-large")
"""What keeps shapes from being looked at; without one whose mesh is not there, the others are."""

SOUND_MODEL = (
    "circular-mimic",
    "degrees-as-radians",
    "duplicate-model-name",
    "frame-cycle",
    "mount-on-dynamic-frame",
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
    more = f", and {len(contacts) - 1} more pair{'s' if len(contacts) > 2 else ''}" if len(contacts) > 1 else ""
    return f"`{contacts[0].first}` and `{contacts[0].second}` touch{more}"


def in_the_chain(graph: CellGraph, goal_name: str) -> tuple[Related, ...]:
    """Return what a goal rests on and somebody wrote: its frame and what carries it, the tool with its tip, the arm."""
    goal = next((goal for goal in graph.cell.goals if goal.name == goal_name), None)
    group = next((group for group in graph.cell.groups if goal is not None and group.name == goal.group), None)
    if goal is None or group is None:
        return ()
    placed = placed_by(graph, goal.frame, group.tip_frame)
    return (*placed, Related("the goal is here", graph.cell.locate(*goal.path)))


def placed_by(graph: CellGraph, *frames: str) -> tuple[Related, ...]:
    """Return what frames hang on and somebody wrote, each once."""
    places = [place for frame in frames for place in _written(graph, frame)]
    return tuple(Related(f"`{frame.name}` is placed here", _placed(graph, frame)) for frame in dict.fromkeys(places))


def _placed(graph: CellGraph, frame: Frame) -> Span:
    """Return where a frame is written, or where an object is that the mock has to put somewhere."""
    return frame.span if frame.simulated_pose is None else graph.cell.locate(*frame.path, "simulated_pose")


def things(graph: CellGraph, text: str) -> tuple[Related, ...]:
    """Return the things of the scene that a text names, such as what touches."""
    return tuple(Related("it is placed here", box.span) for box in graph.cell.scene if f"`{box.name}`" in text)


def mounts(graph: CellGraph, contacts: Sequence[BodyContact]) -> tuple[Related, ...]:
    """Return where the devices are mounted whose links touch."""
    links = {link for contact in contacts for link in (contact.first, contact.second)}
    return tuple(
        Related(f"`{device.name}` is mounted here", graph.cell.locate(*device.path, "mount"))
        for device in graph.cell.devices
        if any(link.name in links for link in device.body.description.links)
    )


def _written(graph: CellGraph, name: str) -> list[Frame]:
    """Return the frames from one up to the world that the spec places; an object is where it is simulated."""
    found: list[Frame] = []
    frame = graph.frames.get(name)
    while frame is not None and frame not in found:
        if frame.kind in (FrameKind.FIXED, FrameKind.MOUNT, FrameKind.DYNAMIC):
            found.append(frame)
        simulated = frame.simulated_pose
        parent = frame.parent if simulated is None else simulated.parent
        frame = graph.frames.get(parent)
        while frame is not None and frame.kind is FrameKind.LINK:
            frame = graph.frames.get(frame.parent)
    return found
