"""Everything that the page shows, computed: what is in the cell, and its rehearsals as they ran."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cellc.contract.diagnostics import Severity, YamlPath
from cellc.contract.diagnostics.diagnostic import format_path
from cellc.contract.printing import progress
from cellc.contract.review import Review
from cellc.tools.view.playback import Run
from cellc.tools.view.scene import Scene, scene_of
from cellc.tools.view.skeleton import Skeleton
from cellc.tools.view.standing import Standing
from cellc.tools.view.subject import Subject, ViewError, read_subject

if TYPE_CHECKING:
    from pathlib import Path

    from cellc.tools.view.attempt import Viewed


@dataclass(frozen=True, slots=True)
class Before:
    """Another state of the cell that this one is put against, and what changed since."""

    scene: Scene
    review: Review


@dataclass(frozen=True, slots=True)
class Content:
    """What the page shows.

    Attributes:
        scene: None where nothing of the spec can be linked.
        not_drawn: what the cell names and the drawing does not have, each with the reason.
        attempt: what was read from bags, where bags were named; its runs are those of the page.
    """

    subject: Subject
    scene: Scene | None
    runs: tuple[Run, ...]
    not_drawn: tuple[tuple[str, str], ...] = ()
    before: Before | None = None
    attempt: Viewed | None = None


def content_of(subject: Subject, rehearsals: Sequence[str], seed: int) -> Content:
    """Compute what is shown of a subject.

    Args:
        rehearsals: those that are played back; all of them if empty.

    Raises:
        MockError: the package has no rehearsal of a name, or its parts do not fit together.
    """
    if subject.standing is None:
        return Content(subject, None, (), tuple(_not_drawn(subject, frozenset())))
    skeleton = Skeleton(subject.standing)
    scene = scene_of(subject.standing, subject.views, skeleton)
    absent = (*_not_drawn(subject, _shown(subject.standing, scene)), *scene.left_out)
    if subject.folder is None:
        return Content(subject, scene, (), absent)
    # Planning libraries load where there is a package to run.
    from cellc.mock.cell import cell_of, in_turn
    from cellc.tools.view.playback import play

    cell = cell_of(subject.folder)
    runs = []
    with progress("view") as update:
        for name in in_turn(cell, dict.fromkeys(rehearsals) or cell.rehearsals):
            update(f"rehearsal {name}")
            runs.append(play(cell, name, skeleton, seed))
    return Content(subject, scene, tuple(runs), absent)


def attempt_content(
    subject: Subject, bags: tuple[Path, ...], task: str | None, against: str | None, seed: int
) -> Content:
    """Compute what is shown of an attempt that was recorded in a cell.

    Args:
        task: rehearsal whose steps the task made; that which the bag is named after where it is None.
        against: a rehearsal, a bag or a file of records to compare with; the rehearsal of the task where it is None.

    Raises:
        BagError: a bag cannot be read, or is of another cell.
        MockError: what it is compared with cannot be run.
        ViewError: there is no package to read it with.
    """
    if subject.standing is None or subject.folder is None:
        raise ViewError(f"{subject.name}: a bag needs the package of its cell, and errors keep it from being made")
    # Readers of bags load where there is one.
    from cellc.tools.view.attempt import viewed

    skeleton = Skeleton(subject.standing)
    scene = scene_of(subject.standing, subject.views, skeleton)
    absent = (*_not_drawn(subject, _shown(subject.standing, scene)), *scene.left_out)
    attempt = viewed(subject.folder, skeleton, bags, task, against, seed)
    return Content(subject, scene, attempt.runs, absent, attempt=attempt)


def before_of(other: str, path: str) -> Before:
    """Return the state of the cell that another spec, folder or git revision of it has, and what changed since.

    Raises:
        SideError: a side cannot be compared, or holds errors.
    """
    # Comparing loads the compiler.
    from cellc.tools.review.review import review
    from cellc.tools.review.sides import SideError, packages, sides

    with packages(*sides((other, path))) as ((before, place), (after, _)):
        subject = read_subject(place)
        if subject.standing is None:
            raise SideError(f"{other}: an error keeps the package from being made")
        scene = scene_of(subject.standing, subject.views, Skeleton(subject.standing))
        return Before(scene, review(before, after))


def _shown(standing: Standing, scene: Scene) -> frozenset[YamlPath]:
    """Return what the drawing has of what a cell names."""
    frames = [frame.name for frame in scene.frames]
    return frozenset(
        (
            *(("devices", name) for name in standing.roots),
            *((section, name) for section in ("frames", "scene") for name in frames),
            *(("motion", "poses", pose.name) for pose in scene.poses),
            *(("motion", "goals", goal.name) for goal in scene.goals),
        )
    )


def _not_drawn(subject: Subject, shown: Container[YamlPath]) -> Iterator[tuple[str, str]]:
    """Yield what a reader may look for and not find: its own error, or that nothing says where it is."""
    findings = () if subject.findings is None else subject.findings.diagnostics
    errors = [finding for finding in findings if finding.severity is Severity.ERROR]
    if errors and not subject.wanted:
        yield "the whole cell", f"{errors[0].message} ({errors[0].span})"
    for path, error in subject.wanted.items():
        if path not in shown:
            # What links and is still not drawn may stand in a circle, which a rule tells.
            reason = error or next(
                (diagnostic for diagnostic in errors if diagnostic.yaml_path[: len(path)] == path), None
            )
            yield format_path(path), _unplaced(subject) if reason is None else f"{reason.message} ({reason.span})"


def _unplaced(subject: Subject) -> str:
    return "it needs what is not drawn" if subject.folder is None else "no pose on the mock is stated"
