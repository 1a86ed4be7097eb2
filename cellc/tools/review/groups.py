"""Changes under what causes them: the worst first, then by who approves; with the figures that say the most."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cellc.contract.diagnostics import Severity
from cellc.contract.review import Review, ReviewCause, ReviewChange, ReviewFinding
from cellc.contract.vocabulary import ApprovalArea, Grade, ReviewArea
from cellc.tools.review.carried import ENDS_ELSEWHERE
from cellc.tools.review.change import PRESENT
from cellc.tools.review.grading import UNMEASURED
from cellc.tools.review.headings import Deltas, Quote, farthest, is_act, moves_of, plain
from cellc.tools.review.order import MANIFOLD, is_manifold, order_of
from cellc.tools.review.ranks import Rank, rank_of
from cellc.tools.review.replaced import LENGTH, MASS, PAIRS, SHAPES
from cellc.tools.review.titles import WHOLE_SPEC, leading_first, shortest_of, title_of, where_of

_ASKED: Sequence[ApprovalArea] = ("safety", "vendor", "controller", "time_tf", "network", "graph", "data")
_SEEN = tuple(f"{what} of {of}" for of in ("depth", "color") for what in ("range", "field of view", "resolution"))
_VALUED = (
    *("stroke", "grip force", "least grip force", "reach", "largest payload"),
    *(*_SEEN, "rate of images", LENGTH, SHAPES, MASS),
)
"""Quantities of a model: a heading has their values, before and after."""
_PLACED = (
    "base in its parent",
    "base in the root frame",
    "tip",
    "pose in its parent",
    "place in the root frame",
)
"""Quantities that say the most about a cause with many changes, in this order."""
_OF_MEASUREMENT = (
    "pose in its parent",
    "base in its parent",
    "residual",
    "measurement measured",
    "measurement samples",
)
"""What the heading of a measurement says."""
_FIGURE = re.compile(r"\[?[-+]?[\d.]")
_PLACES = re.compile(r" \([^():]+:[0-9, ]+\)")
"""Files and lines in a heading."""
_MODEL = "model"
_SAID, _HOME, _TIP = 4, "home", "tip"
_WHOLE = (" added", " removed")
"""How the quantity of what was added or removed as a whole ends."""
NAME_OF = "name of the "
"""How the quantity of another name begins."""


@dataclass(frozen=True, slots=True)
class Group:
    """What one cause changes; of changes without a cause, such as those of folders, all of one area.

    Attributes:
        changes: the worst first; never empty.
        findings: new ones that follow from it, and do not fail.
    """

    cause: ReviewCause | None
    changes: tuple[ReviewChange, ...]
    findings: tuple[ReviewFinding, ...] = ()

    @property
    def grade(self) -> Grade:
        """The worst grade of a change in it."""
        return self.changes[0].grade

    @property
    def title(self) -> str:
        """The line of the spec, with its values and its place, or the area."""
        return self._title("" if self.cause is None else self.cause.line)

    @property
    def marked(self) -> str:
        """The title with each value in backticks, where it holds none itself."""
        return self._title("" if self.cause is None else self.cause.line, _in_backticks)

    def fitting(self, width: int) -> str:
        """Return the title with its place, else with how much changed, and as much of the path as there is room for."""
        if self.cause is not None and not self.cause.renamed and len(self.cause.values) < 2 and len(self.title) > width:
            return self._without_place(width)
        parts = [] if self.cause is None else self.cause.line.split(".")
        if self.cause is not None and len(self.cause.values) > 1 and len(self.title) > width:
            return shortest_of(self.cause, width, self._deltas, self._moves) or self.title
        while len(parts) > 2 and len(self._title("." * 3 + ".".join(parts))) > width:
            parts = parts[1:]
        is_whole = self.cause is None or len(parts) == len(self.cause.line.split("."))
        title = self.title if is_whole else self._title("..." + ".".join(parts))
        return title if len(title) <= width else _PLACES.sub("", title)

    def _without_place(self, width: int) -> str:
        cause = self.cause
        assert cause is not None
        is_figure = _FIGURE.match(cause.before or "") is not None  # else a figure is of something that follows
        sized = next((change.delta for change in self.changes if change.delta and is_figure), "")
        tail = f" ({sized})" if sized else ""
        parts = cause.line.split(".")
        shown = [".".join(parts), *("..." + ".".join(parts[at:]) for at in range(1, len(parts) - 1))]
        heads = [_PLACES.sub("", title_of(cause, line, str, {})) for line in shown]
        fits = (head + end for end in (tail, "") for head in heads if len(head + end) <= width)
        return next(fits, heads[0])

    def _title(self, line: str, quote: Quote = str) -> str:
        cause = self.cause
        if cause is None:
            return self.changes[0].area.value
        if cause.renamed:
            named = next((change for change in self.changes if change.quantity.startswith(NAME_OF)), None)
            noun, follow = ("", "") if named is None else (named.quantity.removeprefix(NAME_OF), named.delta)
            names = f"{quote(cause.before or '')} -> {quote(cause.after or '')}"
            place = f" ({where_of(cause.place)})" if cause.place else ""
            return f"renamed: {noun} {names}{f' ({follow})' if follow else ''}{place}"
        return title_of(cause, line, quote, self._deltas, self._moves)

    @property
    def _moves(self) -> Mapping[str, str]:
        """How far what the heading places moves."""
        return moves_of(self.changes)

    @property
    def _deltas(self) -> Deltas:
        """How much each value of the heading changed, where a change has those values and nothing else says it."""
        return {
            plain(change.before, change.after): change.delta
            for change in self.changes
            if change.before is not None and change.after is not None and change.delta.endswith("%")
        }

    @property
    def is_model(self) -> bool:
        """Whether a device has another model by it."""
        return any(change.quantity == _MODEL and change.area is ReviewArea.DEVICES for change in self.changes)

    @property
    def unmeasured(self) -> tuple[str, ...]:
        """Which measurement has no new revision since a part changed, and which link of an arm is another."""
        told = [change.why for change in self.changes if change.why.endswith((UNMEASURED, ENDS_ELSEWHERE))]
        return tuple(dict.fromkeys(told))

    @property
    def whys(self) -> tuple[str, ...]:
        """Why it is dangerous, each reason once, beside what was not measured."""
        told = [why_of(change) for change in self.changes if change.grade is Grade.DANGEROUS]
        alike = dict[str, dict[str, None]]()
        for why in filter(None, told):
            start, _, last = why.rpartition(" ")
            alike.setdefault(start, {})[last] = None
        return tuple(f"{start} {_few_of([*names])}" for start, names in alike.items())

    @property
    def finds(self) -> bool:
        """Whether it says how nodes find each other."""
        lines = [] if self.cause is None else [self.cause.line, *(value.line for value in self.cause.values)]
        return any(line.startswith(FINDING) for line in lines)

    @property
    def name(self) -> str:
        """The line of the spec, of lines that have nothing in common the first; or the area."""
        if self.cause is None:
            return self.title
        return self.cause.values[0].line if self.cause.line == WHOLE_SPEC else self.cause.line

    @property
    def kept(self) -> str:
        """What the spec states for the model before, and was left as it was."""
        return "" if self.cause is None or not self.cause.kept else f"left as it was: {'; '.join(self.cause.kept)}"

    @property
    def listed(self) -> tuple[ReviewChange, ...]:
        """The changes that neither the heading nor its figures say."""
        if self._is_act:
            said = (*((_MODEL, *_VALUED) if self.is_model else self._valued), *_OF_MEASUREMENT, *_PLACED)
            return tuple(change for change in self.changes if not change.quantity.startswith(said))
        told = (*((_MODEL, *_VALUED) if self.is_model else self._valued), *((_TIP,) if self.figures else ()))
        return tuple(change for change in self.changes if change.quantity not in told) or self.changes

    @property
    def _valued(self) -> Sequence[str]:
        """Quantities of a device with another model, or of one that is new or gone, that its heading has."""
        is_device = self.is_model or any(change.quantity in _EXCHANGED for change in self.changes)
        return _VALUED if is_device and self.cause is not None else ()

    @property
    def _is_act(self) -> bool:
        return self.cause is not None and is_act(self.cause)

    @property
    def figures(self) -> tuple[str, ...]:
        """How far the most telling of its quantities changed, where it has several changes."""
        if len(self.changes) < 2:
            return ()
        valued = self._valued
        sized = [
            change
            for change in self.changes
            if change.quantity in valued or (change.delta and change.quantity in _PLACED)
        ]
        listed, tips = dict[str, None](), dict[str, list[str]]()
        for change in (each for each in sized if each.quantity == _TIP):
            tips.setdefault(change.delta, []).extend(name.partition(" in ")[2] for name in change.subjects)
        for change in sorted(
            sized, key=lambda change: ((*_VALUED, *_PLACED).index(change.quantity), _HOME not in change.subjects[0])
        ):
            if not (self._is_act and change.quantity.startswith(_OF_MEASUREMENT)):
                listed[_figure(change, tips)] = None
        return tuple(listed)[: max(_SAID, sum(change.quantity in valued for change in sized))]

    @property
    def asks(self) -> str:
        """Who approves it: area and owner of each change that is not safe."""
        return asked_of(self.changes)


_FOLLOWING = (
    "tip",
    "versions that it compares",
    "place in the root frame",
    "sweep quantity",
    "parameter",
    "inertia",
    MASS,
    LENGTH,
    SHAPES,
    *PAIRS,
)
"""What only follows from another change, whose owner is asked."""
_ASKED_OF_SAFE = (ReviewArea.LIMITS, ReviewArea.SAFETY)
"""What has an owner to ask even where it is stricter than it was."""


def _few_of(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SAID} more" if len(names) > _SAID else ""
    return ", ".join(names[:_SAID]) + more


FINDING = "network"
"""How the lines of a spec begin by which nodes find each other."""


def why_of(change: ReviewChange) -> str:
    """Return what a change means, where no other line of its group says it."""
    if change.why.endswith((UNMEASURED, ENDS_ELSEWHERE)):
        return ""
    return change.why.partition(", before ")[0].replace("`", "")


def _asks(change: ReviewChange) -> bool:
    if change.quantity.startswith(NAME_OF):
        return change.breaking
    return change.grade is not Grade.SAFE or change.area in _ASKED_OF_SAFE


def asked_of(changes: Sequence[ReviewChange]) -> str:
    """Return who approves changes, as people read it: each area with its owner."""
    return _asked_shown(asking_of(changes))


def asked_of_all(groups: Sequence[Group]) -> str:
    """Return who approves all groups: each that one of them asks by itself."""
    return _asked_shown([change for group in groups for change in asking_of(group.changes)])


def _asked_shown(asking: Sequence[ReviewChange]) -> str:
    asked = {area: owner for change in asking for area, owner in change.beside.items()}
    for change in asking:
        owners = [*(asked.get(change.approval, "").split(" and ")), *change.owner.split(" and ")]
        asked[change.approval] = " and ".join(dict.fromkeys(owner for owner in owners if owner))
    return ", ".join(f"{area} ({asked[area] or 'no owner'})" for area in _ASKED if area in asked)


def asking_of(changes: Sequence[ReviewChange]) -> Sequence[ReviewChange]:
    """Return the changes whose owners are asked: not what only follows, nor what is safe, where others ask."""
    asking = [change for change in changes if _asks(change)]
    own = [change for change in asking if change.area is not ReviewArea.DOCUMENTS]
    return [change for change in own if not change.quantity.startswith(_FOLLOWING)] or own or asking


def broken_by(changes: Sequence[ReviewChange]) -> tuple[str, ...]:
    """Return what consumers outside the cell know otherwise than it is now: a name, or a quantity of a subject."""
    told = [
        change.before or "" if change.quantity.startswith(NAME_OF) else f"{change.quantity} of {change.subjects[0]}"
        for change in changes
        if change.breaking
    ]
    return tuple(dict.fromkeys(told))


def broken_shown(names: Sequence[str]) -> str:
    """Return what consumers know otherwise, each name of them, those of one quantity together."""
    together = dict[str, list[str]]()
    for name in names:
        quantity, of, subject = name.rpartition(" of ")
        together.setdefault(quantity + of, []).append(subject)
    return ", ".join(quantity + ", ".join(subjects) for quantity, subjects in together.items())


def values_of(change: ReviewChange) -> str:
    """Return the values before and after, with a difference that has a size; of what is added or removed, that."""
    if change.quantity.endswith(_WHOLE):
        return "" if PRESENT in (change.before, change.after) else change.after or change.before or ""
    values = f"{change.before or 'not stated'} -> {change.after or 'not stated'}"
    return f"{values} ({change.delta})" if change.delta else values


def _figure(change: ReviewChange, tips: Mapping[str, Sequence[str]]) -> str:
    """Return how far a quantity of a heading changed.

    Args:
        tips: named poses in which the tip moves by as much.
    """
    if change.quantity == _TIP:
        names = sorted(dict.fromkeys(tips[change.delta]), key=lambda name: name != _HOME)
        more = f" and {len(names) - _SAID} more" if len(names) > _SAID else ""
        return f"tip in {', '.join(names[:_SAID])}{more} {change.delta}"
    if change.quantity in _VALUED:
        is_one = None in (change.before, change.after)
        return f"{change.quantity} {change.after or change.before if is_one else values_of(change)}"
    return f"{change.subjects[0]} {change.delta.partition('; ')[0]}"


def groups_of(review: Review) -> tuple[Group, ...]:
    """Return the changes of a review under their causes."""
    held: dict[tuple[int, str], list[ReviewChange]] = {}
    for change in review.changes:
        key = (-1, change.area.value) if change.cause is None else (change.cause, "")
        held.setdefault(key, []).append(change)
    groups = [
        Group(
            None if number < 0 else leading_first(review.causes[number], changes),
            tuple(changes),
            tuple(each for each in review.new_findings if each.cause == number and each.severity != Severity.ERROR),
        )
        for (number, _), changes in held.items()
    ]
    return tuple(sorted(groups, key=lambda group: _order(group, groups)))


def _order(group: Group, groups: Sequence[Group]) -> tuple[object, ...]:
    """Return the place of a group: by its grade, a device with another model by that of all that is said of it.

    Of one grade the largest act comes first, of several such by what they mean, and what moves farthest before others.
    """
    grade = group.grade
    if group.cause is not None and group.is_model:
        of = f"{group.cause.line.removesuffix(f'.{_MODEL}')}."
        grades = [each.grade for each in groups if each.cause is not None and each.cause.line.startswith(of)]
        grade = max((grade, *grades), key=tuple(Grade).index)
    # What else changed is read with the names after.
    is_name = group.cause is not None and group.cause.renamed
    place = order_of(group.changes[0])
    far, turned = farthest(group.changes) if group.cause is not None else (0.0, 0.0)
    is_far = far >= _FAR_MM or turned >= _FAR_DEG
    rank = _rank(group, is_far=is_far, is_moved=far > 0 or turned > 0)
    is_device = rank is Rank.DEVICE
    weight = min(place[1], 1) if is_far else place[1]
    of_device = not group.is_model, not group.unmeasured
    return (
        -tuple(Grade).index(grade),
        not is_name,
        rank,
        of_device if is_device else (False, False),
        weight,
        -far,
        -turned,
        place,
    )


def _rank(group: Group, *, is_far: bool, is_moved: bool) -> int:
    """Return the rank of an act by how much it is: what hardly moves is tuning, what is doubled or halved is more."""
    rank = rank_of(group.cause, group.changes[0].area)
    if rank in (Rank.BASE, Rank.PLACE) and is_moved and not is_far:
        return Rank.TUNING
    if rank is Rank.PLACE and not is_moved and group.changes[0].area is ReviewArea.CALIBRATION:
        return Rank.LOAD
    return rank if rank in (Rank.DEVICE, Rank.NOTE) or not is_manifold(group.changes[0]) else max(rank - MANIFOLD, 0)


_EXCHANGED = ("device added", "device removed")
_FAR_MM, _FAR_DEG = 1.0, 1.0
"""What moves by less is read with tolerances."""


def _in_backticks(value: str) -> str:
    return value if "`" in value else f"`{value}`"
