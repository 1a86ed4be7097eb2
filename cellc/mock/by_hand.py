"""What an edited folder says that no run shows: a file that is not executed, and parts of some that are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.contract.contract import ContractFiles
from cellc.contract.uncertainty import UNCERTAINTY_FILE
from cellc.mock.errors import MockError
from cellc.mock.folder import CONTRACT_FILE, GeneratedFolder, named_files
from cellc.mock.physics.reading import SCENE_FILE

FOR_PEOPLE = (".md", ".svg")
"""How files end that no program reads; an edit of one is a note."""

_SHOWN = 12
"""Files that are named in one line; all are counted."""


def partly_executed(files: ContractFiles) -> Mapping[str, str]:
    """Return the files that are executed in part, with what of them no run shows."""
    shown = {
        files.urdf_mock: "limits of joints, which the planner takes from `contract.json`; masses, efforts, looks",
        UNCERTAINTY_FILE: "it but one of a sweep",
        files.bring_up: "the steps of the real target without a rehearsal of it",
        **dict.fromkeys(files.stages.values(), "limits of straight lines and of servoing, and stages but one"),
    }
    return shown if files.srdf is None else {**shown, files.srdf: "groups, end effectors, poses: as in `contract.json`"}


def not_executed(folder: GeneratedFolder) -> tuple[str, ...]:
    """Return the files that were edited and that no run executes, but for those that only people read."""
    executed = {CONTRACT_FILE, UNCERTAINTY_FILE, *named_files(folder.contract)}
    executed |= set() if folder.scene is None else {SCENE_FILE}
    return tuple(name for name in folder.edits if name not in executed and not name.endswith(FOR_PEOPLE))


def refuse_not_executed(folder: GeneratedFolder) -> None:
    """Raise MockError where a file was edited or removed that no run executes."""
    files = not_executed(folder)
    if not files:
        return
    others = ", ".join(f"`{name}`" for name in files[1:_SHOWN])
    more = f" and {len(files) - _SHOWN} more" if len(files) > _SHOWN else ""
    also = f", as {others}{more}" if others else ""
    reason = f"was edited or removed by hand{also}, and is not executed, so no run would show it"
    raise MockError(files[0], f"{reason}; put it back, or build the folder again")


def notes_on(folder: GeneratedFolder) -> Iterator[str]:
    """Yield what of the edits no run shows, one line for each file."""
    for name in not_executed(folder):
        yield f"`{name}` was edited or removed by hand, and is not executed"
    partly = partly_executed(folder.contract.files)
    for name in folder.edits:
        if name in partly:
            yield f"`{name}` was edited by hand, and is executed in part; no run shows {partly[name]}"
