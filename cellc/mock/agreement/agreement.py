"""Which files of a folder are executed, which are compared with those, and why the rest shows in no run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from cellc.contract.contract import ContractFiles
from cellc.mock.agreement.control import bring_up, qos_overrides, real_controllers, recording
from cellc.mock.agreement.description import frames, limits, other_description
from cellc.mock.agreement.launch import launched
from cellc.mock.agreement.motion import joint_limits, moveit_controllers, semantics
from cellc.mock.agreement.said import CONTRACT, Edited
from cellc.mock.errors import MockError
from cellc.mock.folder import GeneratedFolder, read_text

Comparison = Callable[[Edited, str], Iterator[str]]


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of file.

    Attributes:
        pattern: path, with stars.
        compare: yields what it says otherwise than what is executed; None where nothing is compared.
        compared: what is compared of it.
        not_shown: what of it no run shows, and why; empty where all of it is executed.
    """

    pattern: str
    compare: Comparison | None
    compared: str
    not_shown: str


_MOVE_GROUP = "move_group alone reads it; the mock has a planner of its own"

KINDS = (
    Kind("config/joint_limits.yaml", joint_limits, "limits of every joint", f"default scaling: {_MOVE_GROUP}"),
    Kind("config/moveit/controllers*.yaml", moveit_controllers, "actions, types, joints", "names of plugins"),
    Kind("config/moveit/*.yaml", None, "", _MOVE_GROUP),
    Kind(
        "config/frames.yaml", frames, "parents, authorities, rates, transforms, calibrations", "how they were measured"
    ),
    Kind("config/qos_overrides.yaml", qos_overrides, "every policy of every end", ""),
    Kind(
        "config/recording_qos.yaml", recording, "topics of the contract", "topics of actions: nothing is recorded by it"
    ),
    Kind("config/uncertainty.json", None, "", "a rehearsal draws nothing; a sweep takes the whole of it"),
    Kind("config/*.real.yaml", real_controllers, "rates, types, joints", "other parameters: real hardware alone"),
    Kind("config/*.yaml", None, "", "a program that the mock does not have reads it: a driver, or a node of yours"),
    Kind("urdf/*", other_description, "links, joints, limits, shapes, joints of hardware", "plugins of real hardware"),
    Kind(
        "launch/*", launched, "processes, controllers, phases, files, gates", "names, remaps and arguments of processes"
    ),
    Kind("scripts/*", None, "", "it runs with ROS 2; the mock takes the same plan by itself"),
    Kind("middleware/*", None, "", "the network of the mock is that of the contract"),
    Kind("security/*", None, "", "nothing is encrypted or denied on the mock"),
    Kind("gates/*", None, "", "people read it"),
    Kind("graph/*", None, "", "people look at it"),
    Kind("*.md", None, "", "people read it"),
    Kind("*", None, "", "it builds and installs the package"),
)
"""Kinds of files, the first that matches counts; below them what the contract names."""

_URDF = Kind("the URDF of the mock", limits, "limits of joints", "masses, efforts, looks: no dynamics")
_SRDF = Kind("the SRDF", semantics, "groups, end effectors, poses", "")
_PLAN = Kind(
    "config/bring_up.json",
    bring_up,
    "controllers that each target activates",
    "steps of the real target without a rehearsal of it",
)
EXECUTED = (_URDF, _SRDF, _PLAN)
"""Files that are executed in part."""


def kind_of(name: str, files: ContractFiles) -> Kind | None:
    """Return the kind of a file; None where the whole of it is executed."""
    part = {files.urdf_mock: _URDF, files.srdf: _SRDF, files.bring_up: _PLAN}.get(name)
    if part is not None:
        return part
    if name in (CONTRACT, files.rehearsals, *files.parameters.values()):
        return None
    return next(kind for kind in KINDS if fnmatchcase(name, kind.pattern))


def refuse_disagreement(root: Path, folder: GeneratedFolder) -> tuple[str, ...]:
    """Return what of the edits no run shows, one line for each file.

    Raises:
        MockError: an edited file says otherwise than what is executed.
    """
    edited = _edited(root, folder)
    notes: list[str] = []
    for name in folder.edits:
        kind = kind_of(name, folder.contract.files)
        if kind is None:
            continue
        if kind.compare is not None:
            _refuse(name, tuple(kind.compare(edited, name)))
        if kind.not_shown:
            why = "is not executed" if kind.compare is None else "says what is executed; no run shows"
            notes.append(f"`{name}` {why}: {kind.not_shown}")
    return tuple(notes)


def _refuse(name: str, found: tuple[str, ...]) -> None:
    if found:
        more = f", and {len(found) - 1} more" if len(found) > 1 else ""
        raise MockError(
            name, f"{found[0]}{more}; no run would show it: have every file say the same, or build it again"
        )


def _edited(root: Path, folder: GeneratedFolder) -> Edited:
    compared = {name for name in folder.edits if _compared(name, folder)}
    if any(name.startswith("launch/") for name in compared):
        compared |= {name for name in folder.listed if name.startswith("launch/")}
    return Edited(
        contract=folder.contract,
        description=folder.description,
        mock=folder.bring_up,
        real=folder.real_bring_up,
        watches=folder.watches,
        texts={name: read_text(root, name) for name in sorted(compared)},
        listed=frozenset(folder.listed),
    )


def _compared(name: str, folder: GeneratedFolder) -> bool:
    kind = kind_of(name, folder.contract.files)
    return kind is not None and kind.compare is not None
