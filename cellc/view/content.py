"""Everything that the page shows, computed: what stands in the cell, and its rehearsals as they ran."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cellc.printing import progress
from cellc.view.playback import Run
from cellc.view.scene import Scene, scene_of
from cellc.view.skeleton import Skeleton
from cellc.view.subject import Subject


@dataclass(frozen=True, slots=True)
class Content:
    """What the page shows; ``scene`` is None where an error keeps the package from being made."""

    subject: Subject
    scene: Scene | None
    runs: tuple[Run, ...]


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

    contract, description = subject.folder.contract, subject.folder.description
    skeleton = Skeleton(contract, description)
    cell = cell_of(subject.folder)
    runs = []
    with progress("view") as update:
        for name in dict.fromkeys(rehearsals) or cell.rehearsals:
            update(f"rehearsal {name}")
            runs.append(play(cell, name, skeleton, seed))
    return Content(subject, scene_of(contract, description, subject.views, skeleton), tuple(runs))
