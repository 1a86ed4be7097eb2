"""Everything that the page shows, computed: what stands in the cell, and its rehearsals as they ran."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cellc.contract.review import Review
from cellc.mock.folder import GeneratedFolder
from cellc.printing import progress
from cellc.view.playback import Run
from cellc.view.scene import Scene, scene_of
from cellc.view.skeleton import Skeleton
from cellc.view.subject import Subject, read_subject


@dataclass(frozen=True, slots=True)
class Before:
    """Another state of the cell that this one is put against, and what changed since."""

    scene: Scene
    review: Review


@dataclass(frozen=True, slots=True)
class Content:
    """What the page shows; ``scene`` is None where an error keeps the package from being made."""

    subject: Subject
    scene: Scene | None
    runs: tuple[Run, ...]
    before: Before | None = None


def content_of(subject: Subject, rehearsals: Sequence[str], seed: int) -> Content:
    """Compute what is shown of a subject.

    Args:
        rehearsals: those that are played back; all of them if empty.

    Raises:
        MockError: the package has no rehearsal of a name, or its parts do not fit together.
    """
    if subject.folder is None:
        return Content(subject, None, ())
    # Planning libraries load where there is a package to run.
    from cellc.mock.cell import cell_of
    from cellc.view.playback import play

    scene, skeleton = _drawn(subject.folder, subject)
    cell = cell_of(subject.folder)
    runs = []
    with progress("view") as update:
        for name in dict.fromkeys(rehearsals) or cell.rehearsals:
            update(f"rehearsal {name}")
            runs.append(play(cell, name, skeleton, seed))
    return Content(subject, scene, tuple(runs))


def before_of(other: str, path: str) -> Before:
    """Return the state of the cell that another spec, folder or git revision of it has, and what changed since.

    Raises:
        SideError: a side cannot be compared, or holds errors.
    """
    # Comparing loads the compiler.
    from cellc.review.review import review
    from cellc.review.sides import SideError, packages, sides

    with packages(*sides((other, path))) as ((before, place), (after, _)):
        subject = read_subject(place)
        if subject.folder is None:
            raise SideError(f"{other}: an error keeps the package from being made")
        return Before(_drawn(subject.folder, subject)[0], review(before, after))


def _drawn(folder: GeneratedFolder, subject: Subject) -> tuple[Scene, Skeleton]:
    skeleton = Skeleton(folder.contract, folder.description)
    return scene_of(folder.contract, folder.description, subject.views, skeleton), skeleton
