"""What changed from one package to another under what causes it: names first, then lines of the spec."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics.wording import count
from cellc.contract.review import ReviewCause, ReviewChange
from cellc.contract.vocabulary import Grade
from cellc.tools.review.acts import Cause, causes_between, flow_of
from cellc.tools.review.causes import Brought, State, as_cause, attributed, package_of_document, without_lines
from cellc.tools.review.change import Change, Written, in_units
from cellc.tools.review.compare import change_of, reported
from cellc.tools.review.device_folders import by_folders, folder_causes
from cellc.tools.review.facts import Facts
from cellc.tools.review.folder_names import facts_with_names, renames_between_folders
from cellc.tools.review.groups import NAME_OF
from cellc.tools.review.kept import kept_beside
from cellc.tools.review.leaves import Leaf, Path, Prose, differences, same
from cellc.tools.review.merging import merged
from cellc.tools.review.renames import TF_FRAME, Names, Rename, names_of, renamed, renames_between
from cellc.tools.review.repeated import follows
from cellc.tools.review.sides import Package
from cellc.tools.review.units import units_in

_FEW = 4
_LETTERS = "[A-Za-z0-9]"
"""What goes on with a name where it is a part of another: `arm` is one of `arm_base_link`."""


@dataclass(frozen=True, slots=True)
class Explained:
    """Causes in the order in which they are listed, changes with the number of theirs, and the names that changed."""

    causes: tuple[ReviewCause, ...]
    changes: tuple[ReviewChange, ...]
    renames: tuple[Rename, ...] = ()
    brought: tuple[Brought, ...] = ()
    """What the findings say that each cause brings."""


def explained(before: Package, after: Package) -> Explained:
    """Return every change with what causes it; of folders, of which no spec is there, the changes alone."""
    if before.document is None or after.document is None:
        return _of_folders(before, after)
    was, now = (
        State(document, side.facts, side.findings)
        for side, document in ((before, before.document), (after, after.document))
    )
    renames, base = _with_names_after(was, now)
    leading = _leading(renames)
    names = [_of_rename(rename, was.facts, base.facts) for rename in leading]
    changes = reported(base.facts, now.facts)
    causes, found, brought = attributed(changes, causes_between(base.document, now.document), base, now)
    first = [_as_cause(rename, now.document) for rename in leading]
    in_folders = folder_causes(was.document, now.document) if any(number is None for number, _ in found) else ()
    wanted = [_units_of(cause) for cause in causes]
    of_folders, found = by_folders(found, in_folders, len(causes), base.facts, now.facts)
    found = without_lines(found)
    of_lines = [*wanted, *map(_units_written, of_folders)]
    found = [(number, change if number is None else in_units(change, of_lines[number])) for number, change in found]
    numbered: list[tuple[int | None, Change]] = list(enumerate(names))
    numbered += [(0, change) for change in _beside_names(renames, was.facts, base.facts)]
    numbered += [(None if number is None else number + len(first), change) for number, change in found]
    return Explained(
        (
            *first,
            *(
                as_cause(cause, now.document).model_copy(
                    update={"kept": kept_beside(cause, was.document, now.document)}
                )
                for cause in causes
            ),
            *of_folders,
        ),
        merged(numbered, before.facts, after.facts),
        renames,
        (*(frozenset() for _ in first), *brought),
    )


def _units_of(cause: Cause) -> Written:
    """Return the units in which the lines of a cause were written, and are; of what is new or gone, those of it."""
    sides = [[edit.before or edit.after for edit in cause], [edit.after or edit.before for edit in cause]]
    was, now = (_in_texts(flow_of(child) for child in side if child is not None) for side in sides)
    return was, now


def _units_written(cause: ReviewCause) -> Written:
    values = [(cause.before, cause.after), *((value.before, value.after) for value in cause.values)]
    return _in_texts(was or now for was, now in values), _in_texts(now or was for was, now in values)


def _in_texts(texts: Iterable[str | None]) -> frozenset[str]:
    return frozenset().union(*(units_in(text) for text in texts if text))


def _of_folders(before: Package, after: Package) -> Explained:
    """Return the changes between packages of which no spec is there: their names are those of their contracts."""
    renames = renames_between_folders(before.facts.contract, after.facts.contract)
    base = facts_with_names(before, after, renames) if renames else None
    if base is None:
        bare: list[tuple[int | None, Change]] = [(None, change) for change in reported(before.facts, after.facts)]
        return Explained((), merged(bare, before.facts, after.facts))
    leading = _leading(renames)
    found: list[tuple[int | None, Change]] = [
        (number, _of_rename(rename, before.facts, base)) for number, rename in enumerate(leading)
    ]
    found += [(0, change) for change in _beside_names(renames, before.facts, base)]
    found += [(None, change) for change in reported(base, after.facts)]
    return Explained(tuple(map(_as_cause, leading)), merged(found, before.facts, after.facts), renames)


def _as_cause(rename: Rename, document: SourceDocument | None = None) -> ReviewCause:
    child = None if document is None else document.child((*rename.section, rename.after))
    place = "" if child is None else str(child.key_span or child.span)
    return ReviewCause(line=_line(rename), before=rename.before, after=rename.after, place=place, renamed=True)


def _with_names_after(was: State, now: State) -> tuple[tuple[Rename, ...], State]:
    """Return the names that changed, and the state before with those after; none where that is no valid spec."""
    renames = renames_between(was.document, now.document)
    if not renames:
        return (), was
    document = renamed(was.document, now.document, renames)
    package = package_of_document(document, was.errors)
    return ((), was) if package is None else (renames, State(document, package.facts, package.findings))


def _leading(renames: Sequence[Rename]) -> tuple[Rename, ...]:
    """Return the renames that no other implies: a group and a topic that are named after a device follow it."""
    return tuple(
        rename
        for number, rename in enumerate(renames)
        if not any(
            names_of([other], inside=_LETTERS).in_text(rename.before) == rename.after
            and (other.before != rename.before or at < number)
            for at, other in enumerate(renames)
            if at != number
        )
    )


def _line(rename: Rename) -> str:
    return ".".join((*map(str, rename.section), rename.after))


def _of_rename(rename: Rename, before: Facts, after: Facts) -> Change:
    """Return another name as one change: what follows it, and what of it consumers outside the cell know."""
    followed = _followed(rename, before, after)
    known = [name for name in _known_outside(before) if name in followed or name == rename.before]
    more = f" and {len(known) - _FEW} more" if len(known) > _FEW else ""
    names = names_of([rename], inside=_LETTERS)
    told = [name if name == rename.before else f"{name} -> {names.in_text(name)}" for name in known[:_FEW]]
    return Change(
        rename.area,
        rename.after,
        f"{NAME_OF}{rename.noun}",
        rename.before,
        rename.after,
        Grade.REVIEW,
        f"{count(len(followed), 'name')} follow{'s' * (len(followed) == 1)}" if followed else "",
        breaking=bool(known),
        why=f"consumers {'that look up' if rename.noun == TF_FRAME else 'of'} {', '.join(told)}{more}" if known else "",
        approval="graph" if known else None,
    )


def _beside_names(renames: Sequence[Rename], before: Facts, after: Facts) -> Iterator[Change]:
    """Yield what else changed where names alone should have: nothing, as a rule."""
    if not renames:
        return
    bare = [replace(rename, before=rename.before.strip("/"), after=rename.after.strip("/")) for rename in renames]
    names = names_of(bare, inside=_LETTERS)
    was, now = (
        {_path_with(names, path): _with_names(leaf, names) for path, leaf in facts.leaves.items()}
        for facts in (before, after)
    )
    for delta in differences(was, now):
        is_order = (
            delta.before is not None and delta.after is not None and same(delta.before, delta.after, ordered=False)
        )
        change = None if is_order or follows(delta.path) else change_of(delta, before, after)
        if change is not None:
            yield change


def _path_with(names: Names, path: Path) -> Path:
    now = tuple(map(names.in_text, path))
    return (*now[:-1], " and ".join(sorted(now[-1].split(" and ")))) if path[0] == "pair" else now


def _with_names(leaf: Leaf, names: Names) -> Leaf:
    if isinstance(leaf, str):
        return names.in_text(leaf)
    if isinstance(leaf, Prose):
        return Prose(names.in_text(leaf.text))
    if isinstance(leaf, tuple):
        return tuple(names.in_text(item) if isinstance(item, str) else item for item in leaf)
    return leaf


def _followed(rename: Rename, before: Facts, after: Facts) -> frozenset[str]:
    """Return the names of a package that were removed with a name, where the same were added with the other."""
    names = names_of([rename], inside=_LETTERS)
    was, now = _names_in(before), _names_in(after)
    come = now - was
    return frozenset(
        name for name in was - now if name != rename.before and any(read in come for read in names.readings(name))
    )


def _names_in(facts: Facts) -> frozenset[str]:
    """Return the names that a package gives: of interfaces, frames, joints, controllers, devices and what moves."""
    contract, controllers = facts.contract, [m.controllers for m in facts.contract.managers.values()]
    body = facts.description
    return frozenset(
        (
            *_known_outside(facts),
            *(name for held in controllers for name in held),
            *(name for held in (contract.devices, contract.groups, contract.goals, contract.clock_of) for name in held),
            *(link.name for link in body.links),
            *(joint.name for joint in body.joints),
            *(component.name for component in body.hardware),
        )
    )


def _known_outside(facts: Facts) -> Sequence[str]:
    """Return the names by which others know a cell: of interfaces and of frames."""
    return (*facts.contract.interfaces, *facts.contract.frames)
