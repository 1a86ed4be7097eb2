"""What changed from one state of a plant to another: its own lines, and which of its cells, by name.

What changed in a cell is reviewed with that cell, by its owner. A cell counts as changed where its spec says something
else, or where what its evidence rests on does: its configuration ID.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack
from typing import TypeVar

from cellc.compiler.deploy.configuration import configuration_id, configuration_inputs
from cellc.compiler.pipeline import check_buildable, compile_cell
from cellc.compiler.plant.plant import Crossing, Part, Plant, PlantArea
from cellc.contract.review import Review, ReviewChange, ReviewSide
from cellc.contract.transforms import Pose, apart
from cellc.contract.vocabulary import UNKNOWN, ApprovalArea, Grade, ReviewArea
from cellc.tools.review.sides import Side, SideError, first_error, located

_Thing = TypeVar("_Thing")
_APPROVAL: Mapping[ReviewArea, ApprovalArea] = {ReviewArea.SAFETY: "safety", ReviewArea.FRAMES: "time_tf"}
_MOVED = "arms of other cells may be nearer than before"
_MEET = "arms may meet where they were kept apart"


def plant_review(before: Side, after: Side) -> Review:
    """Return what changed from one plant to another.

    Raises:
        SideError: a side cannot be read, holds errors, or is no plant.
    """
    with ExitStack() as stack:
        (was, was_files), (now, now_files) = (_plant(side, stack) for side in (before, after))
        changes = sorted(_changes(was, now), key=lambda change: -tuple(Grade).index(change.grade))
        return Review(
            format=1,
            before=ReviewSide(name=before.name, cell=was.name, configuration_id=_digest(was_files)),
            after=ReviewSide(name=after.name, cell=now.name, configuration_id=_digest(now_files)),
            changes=tuple(changes),
            files=tuple(
                path for path in sorted({*was_files, *now_files}) if was_files.get(path) != now_files.get(path)
            ),
        )


def _plant(side: Side, stack: ExitStack) -> tuple[Plant, Mapping[str, str]]:
    path = located(side, stack)
    checked = check_buildable(path.as_posix())
    compiled = compile_cell(checked)
    if checked.plant is None or compiled.value is None:
        if not checked.findings.ok:
            raise SideError(first_error(side.name, checked.diagnostics))
        raise SideError(f"{side.name} is no plant: a plant is compared with a plant")
    return checked.plant, {artifact.path: artifact.text for artifact in compiled.value}


def _digest(files: Mapping[str, str]) -> str:
    return str(json.loads(files["manifest.json"])["configuration_id"])


def _changes(was: Plant, now: Plant) -> Iterator[ReviewChange]:
    if was.name != now.name:
        yield _change(ReviewArea.DOCUMENTS, was.name, "name of the plant", was.name, now.name, "", Grade.REVIEW)
    if was.summary != now.summary:
        yield _change(ReviewArea.DOCUMENTS, now.name, "summary", was.summary, now.summary, "", Grade.SAFE)
    for key, part, other in _both(was.parts, now.parts):
        yield from _part(key, part, other)
    topics = (_topics(was.crossings), _topics(now.crossings))
    for name, ends, others in _both(*topics):
        yield from _crossing(name, ends, others)
    areas = ({area.name: area for area in each.areas} for each in (was, now))
    for name, area, new in _both(*areas):
        yield from _area(name, area, new)


def _both(was: Mapping[str, _Thing], now: Mapping[str, _Thing]) -> Iterator[tuple[str, _Thing | None, _Thing | None]]:
    yield from ((name, was.get(name), now.get(name)) for name in dict.fromkeys((*was, *now)))


def _part(key: str, was: Part | None, now: Part | None) -> Iterator[ReviewChange]:
    owner = next(each.owner for each in (now, was) if each is not None)
    if was is None or now is None:
        before, after = (None if part is None else part.spec for part in (was, now))
        grade, why = (Grade.DANGEROUS, _MOVED) if was is None else (Grade.REVIEW, "")
        yield _change(ReviewArea.DEVICES, key, "cell", before, after, owner, grade, why, breaking=now is None)
        return
    if was.spec != now.spec:
        yield _change(ReviewArea.DEVICES, key, "spec of the cell", was.spec, now.spec, owner, Grade.REVIEW)
    if was.owner != now.owner:
        yield _change(ReviewArea.OWNERS, key, "owner", was.owner, now.owner, owner, Grade.REVIEW)
    yield from _pose(ReviewArea.FRAMES, key, "mount", was.pose, now.pose, owner, _MOVED)
    (was_id, was_said), (now_id, now_said) = _state(was), _state(now)
    if (was_id, was_said) != (now_id, now_said):
        why = f"reviewed with the cell: `cellc diff` of `{now.spec}`"
        spec_alone = was_id == now_id
        before, after = ("as it was", "says something else") if spec_alone else (was_id, now_id)
        yield _change(ReviewArea.DEVICES, key, "cell itself", before, after, owner, Grade.REVIEW, why)


def _state(part: Part) -> tuple[str, str]:
    """Return the configuration ID of a cell, and a digest of what its spec says."""
    said = json.dumps(part.document.data, sort_keys=True)
    return configuration_id(configuration_inputs(part.graph)), hashlib.sha256(said.encode()).hexdigest()


def _topics(crossings: Iterable[Crossing]) -> dict[str, tuple[Crossing, ...]]:
    found: dict[str, tuple[Crossing, ...]] = {}
    for crossing in crossings:
        found[crossing.name] = (*found.get(crossing.name, ()), crossing)
    return found


def _crossing(name: str, was: tuple[Crossing, ...] | None, now: tuple[Crossing, ...] | None) -> Iterator[ReviewChange]:
    owner = (now or was or ())[0].owner
    if not was or not now:
        before, after = (f"{each[0].type} {_from(each)} to {_to(each)}" if each else None for each in (was, now))
        grade = Grade.REVIEW if now else Grade.DANGEROUS
        yield _change(ReviewArea.INTERFACES, name, "topic between cells", before, after, owner, grade, breaking=not now)
        return
    for quantity, before, after, breaks in (
        ("type", was[0].type, now[0].type, True),
        ("publisher", _from(was), _from(now), False),
        ("subscribers", _to(was), _to(now), not _ends(was) <= _ends(now)),
    ):
        if before != after:
            grade = Grade.DANGEROUS if breaks else Grade.REVIEW
            yield _change(ReviewArea.INTERFACES, name, quantity, before, after, owner, grade, breaking=breaks)
    if was[0].owner != now[0].owner:
        yield _change(ReviewArea.OWNERS, name, "owner", was[0].owner, now[0].owner, owner, Grade.REVIEW)


def _from(crossings: tuple[Crossing, ...]) -> str:
    return f"{crossings[0].source.key}/{crossings[0].source_node}"


def _ends(crossings: tuple[Crossing, ...]) -> frozenset[str]:
    return frozenset(f"{each.receiver.key}/{each.receiver_node}" for each in crossings)


def _to(crossings: tuple[Crossing, ...]) -> str:
    return ", ".join(sorted(_ends(crossings)))


def _area(name: str, was: PlantArea | None, now: PlantArea | None) -> Iterator[ReviewChange]:
    if was is None or now is None:
        before, after = (None if area is None else f"granted by {area.granted_by}" for area in (was, now))
        yield _change(ReviewArea.SAFETY, name, "shared area", before, after, "", Grade.DANGEROUS, _MEET)
        return
    yield from _pose(ReviewArea.SAFETY, name, "pose of the shared area", was.pose, now.pose, "", _MEET)
    for quantity, before, after in (
        ("size of the shared area", _edges(was), _edges(now)),
        ("who grants access", was.granted_by, now.granted_by),
        ("why arms may be in it together", was.released or "not stated", now.released or "not stated"),
    ):
        if before != after:
            yield _change(ReviewArea.SAFETY, name, quantity, before, after, "", Grade.DANGEROUS, _MEET)


def _edges(area: PlantArea) -> str:
    return " x ".join(f"{edge:g}" for edge in area.size) + " m"


def _pose(
    area: ReviewArea, subject: str, quantity: str, was: Pose, now: Pose, owner: str, why: str
) -> Iterator[ReviewChange]:
    way_m, turn_rad = apart(was, now)
    if way_m > 1e-9 or turn_rad > 1e-9:
        delta = f"{way_m * 1000.0:g} mm, {math.degrees(turn_rad):g} deg"
        yield _change(area, subject, quantity, _shown(was), _shown(now), owner, Grade.DANGEROUS, why, delta=delta)


def _shown(pose: Pose) -> str:
    place = " ".join(f"{round(way, 6) + 0.0:g}" for way in pose.position)
    turn = " ".join(f"{round(math.degrees(angle), 4) + 0.0:g}" for angle in pose.rpy())
    return f"{place} m, {turn} deg"


def _change(
    area: ReviewArea,
    subject: str,
    quantity: str,
    before: str | None,
    after: str | None,
    owner: str,
    grade: Grade,
    why: str = "",
    *,
    breaking: bool = False,
    delta: str = "",
) -> ReviewChange:
    return ReviewChange(
        area=area,
        subjects=(subject,),
        quantity=quantity,
        before=before,
        after=after,
        delta=delta,
        grade=grade,
        breaking=breaking,
        why=why,
        approval=_APPROVAL.get(area, "graph"),
        owner=owner or UNKNOWN,
    )
