"""The grade of one value that changed, by the rules of the table."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from cellc.contract.contract import Contract
from cellc.contract.grading import UNAVOIDED, Rule
from cellc.contract.transforms import identity
from cellc.contract.vocabulary import UNKNOWN, ApprovalArea, Grade, ReviewArea
from cellc.robot.description.model import Collision
from cellc.tools.review.carried import is_reaching, longer_link
from cellc.tools.review.covering import covers
from cellc.tools.review.facts import Facts
from cellc.tools.review.leaves import Delta, Leaf, Prose, said
from cellc.tools.review.loads import is_measured_again, left_behind, unexplained_load
from cellc.tools.review.measured import unmeasured
from cellc.tools.review.rooms import is_part_of_scene, keeps_apart, obstacle_covers
from cellc.tools.review.rules import approval_of
from cellc.tools.review.tokens import tokens
from cellc.tools.review.units import shown


@dataclass(frozen=True, slots=True)
class Verdict:
    """A grade, with what it rests on where the rule says more than the row; area and approval where it decides them."""

    grade: Grade
    why: str = ""
    area: ReviewArea | None = None
    approval: ApprovalArea | None = None


def grade(rule: Rule, delta: Delta, before: Facts, after: Facts) -> Verdict:
    """Return the grade of a change by a rule; what a calibration measured does not change without a new revision."""
    verdict = Verdict(Grade.SAFE) if _is_only_known(rule, delta) else _by_rule(rule, delta, before, after)
    names = unmeasured(delta, before.contract, after.contract)
    if not names or (verdict.why and rule is not Rule.REPLACED):
        return verdict
    area = verdict.area if verdict.grade is Grade.DANGEROUS or rule is Rule.REPLACED else ReviewArea.CALIBRATION
    return Verdict(Grade.DANGEROUS, _unmeasured(names, before.contract), area)


_KNOWN = (Rule.REVIEW, Rule.NAMED)
"""Rules of values that are no hazard by themselves."""


_OF_PEOPLE = (("contract", "approvals"), ("contract", "responsibilities"))


def _is_only_known(rule: Rule, delta: Delta) -> bool:
    """Tell whether a value that was not known is stated now, and nothing else: what it was is the same."""
    is_known = rule in _KNOWN or delta.path[:2] in _OF_PEOPLE
    return is_known and _is_unknown(delta.before) and not _is_unknown(delta.after) and delta.after is not None


def _is_unknown(leaf: Leaf | None) -> bool:
    return leaf is not None and str(leaf).split()[-1:] == [UNKNOWN]


def _by_rule(rule: Rule, delta: Delta, before: Facts, after: Facts) -> Verdict:
    if rule in _FIXED:
        return Verdict(_FIXED[rule], approval=approval_of(delta.path))
    if rule is Rule.PLACED:
        return _of_placement(delta, before, after)
    if rule is Rule.COVERED:
        return _of_shapes(delta, before, after)
    if rule is Rule.APART:
        # A larger one keeps arms apart in more room, and stops none that is in it from leaving.
        return _of_area(delta, before, after)
    if rule is Rule.COMPARED:
        return Verdict(_compared(delta, after))
    if rule is Rule.MEASURED:
        return _of_measurement(delta, before, after)
    if rule is Rule.MATRIX and (taken := _matrix(delta.before, delta.after)) is Grade.DANGEROUS:
        return Verdict(taken, "the matrix says that these versions do not work together")
    if rule in _OF_BOTH_SIDES:
        return _OF_BOTH_SIDES[rule](delta, before, after)
    return Verdict(_GRADES[rule](delta.before, delta.after), approval=approval_of(delta.path))


UNMEASURED = "no new revision"
"""How a reason ends that rests on calibrations that keep their revision."""


def _unmeasured(names: Sequence[str], before: Contract) -> str:
    told = ", ".join(f"`{name}` (revision {before.calibrations[name].revision})" for name in names)
    return f"{told} {'has' if len(names) == 1 else 'have'} {UNMEASURED}"


_FIXED = {Rule.SAFE: Grade.SAFE, Rule.REVIEW: Grade.REVIEW, Rule.DANGEROUS: Grade.DANGEROUS}


def _more(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.DANGEROUS if after is None or _greater(after, before) else Grade.SAFE


def _less(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.DANGEROUS if after is None or _greater(before, after) else Grade.SAFE


_SLIGHTLY = 1.05
"""What a bound may grow by, all in all, before it is another: less is a matter of rounding and of units."""
_A_TENTH = 1.1
"""What a part may be heavier by before force, payload and motion must be chosen again."""


def _looser(before: Leaf | None, after: Leaf | None) -> Grade:
    """Zero is no bound at all: ros2_control checks no tolerance and no time that is zero."""
    is_bound, was_bound = after is not None and after != 0, before is not None and before != 0
    if is_bound and not (was_bound and _greater(after, before)):
        return Grade.SAFE
    return _figure(before, after)


def _figure(before: Leaf | None, after: Leaf | None) -> Grade:
    """A lower one is no bound that holds by itself: the part may slip, the device may take longer all the same."""
    was_bound = before is not None and before != 0
    allowed = before * _SLIGHTLY if isinstance(before, (int, float)) else before
    loosened = after is None or after == 0 or _greater(after, allowed)
    return Grade.DANGEROUS if was_bound and loosened else Grade.REVIEW


def _restated(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.REVIEW if before is None else Grade.DANGEROUS


def _heavier(before: Leaf | None, after: Leaf | None) -> Grade:
    allowed = _A_TENTH * before if isinstance(before, (int, float)) else before
    return Grade.DANGEROUS if before is not None and _greater(after, allowed) else Grade.REVIEW


def _stricter(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.SAFE if after is not None and (before is None or _greater(before, after)) else Grade.REVIEW


def _back(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.DANGEROUS if after is None or _greater(before, after) else Grade.REVIEW


def _named(before: Leaf | None, after: Leaf | None) -> Grade:
    if before is None:
        return Grade.REVIEW
    return Grade.DANGEROUS if after is None or _is_unknown(after) else Grade.REVIEW


def _matrix(before: Leaf | None, after: Leaf | None) -> Grade:
    was, now = (str(item).partition(":")[0] for item in (before, after))
    if now == "INCOMPATIBLE" != was:
        return Grade.DANGEROUS
    return Grade.SAFE if now == "OK" != was else Grade.REVIEW


def _claim(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.REVIEW if after is None else Grade.DANGEROUS


def _lost(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.DANGEROUS if _entries(before) - _entries(after) else Grade.REVIEW


def _kept(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.DANGEROUS if _entries(before) - _entries(after) else Grade.SAFE


def _added(before: Leaf | None, after: Leaf | None) -> Grade:
    return Grade.REVIEW if _entries(before) - _entries(after) else Grade.SAFE


_FIGURE = re.compile(r"-?[0-9]+(?:\.[0-9]+)?(?:e[-+][0-9]+)?")
_GRADES = {
    Rule.MORE: _more,
    Rule.LESS: _less,
    Rule.LOOSER: _looser,
    Rule.FIGURE: _figure,
    Rule.HEAVIER: _heavier,
    Rule.FEWER: _back,
    Rule.STRICTER: _stricter,
    Rule.BACK: _back,
    Rule.NAMED: _named,
    Rule.RESTATED: _restated,
    Rule.MATRIX: _matrix,
    Rule.CLAIM: _claim,
    Rule.LOST: _lost,
    Rule.KEPT: _kept,
    Rule.ADDED: _added,
}


def _entries(value: Leaf | None) -> set[str]:
    if isinstance(value, tuple):
        return {said(item) for item in value}
    if isinstance(value, Prose):
        return set(value.text.split(", "))
    return set() if value is None else {str(value)}


def _greater(one: Leaf | None, other: Leaf | None) -> bool:
    """Tell whether a number is above another; what is no number counts as above, so that it is not passed over."""
    one, other = _in_si(one), _in_si(other)
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return one > other
    return one is not None and other is not None


def _in_si(leaf: Leaf | None) -> Leaf | None:
    """Return one quantity, maybe with another unit behind it, in SI; anything else as it is."""
    told = tokens(leaf.text.partition(" (")[0]) if isinstance(leaf, Prose) else ()
    return float(told[0]) if len(told) == 1 and _FIGURE.fullmatch(told[0]) else leaf


def _of_placement(delta: Delta, before: Facts, after: Facts) -> Verdict:
    """A transform that was measured does not change without another measurement; an arm that moved is elsewhere."""
    frame = delta.path[1]
    if delta.before is not None and delta.after is not None and (longer := longer_link(frame, before, after)):
        return Verdict(Grade.DANGEROUS, longer, approval="controller")
    if delta.before is not None and delta.after is not None and frame in bases(before) & bases(after):
        return Verdict(Grade.DANGEROUS, ELSEWHERE, approval="safety")
    if delta.before is not None and delta.after is not None and is_part_of_scene(frame, before):
        if obstacle_covers(frame, before, after):
            return Verdict(Grade.REVIEW, "it still takes up all the room that it took", ReviewArea.MODEL)
        return Verdict(Grade.DANGEROUS, UNAVOIDED, ReviewArea.MODEL)
    was, now = (side.contract.frames.get(frame) for side in (before, after))
    name = None if now is None else now.calibration
    if was is None or name is None or was.calibration != name:
        return Verdict(Grade.REVIEW)
    old, new = (side.contract.calibrations.get(name) for side in (before, after))
    if old is None or new is None:
        return Verdict(Grade.DANGEROUS, f"calibration `{name}` is not declared", ReviewArea.CALIBRATION)
    if new.revision > old.revision:
        return Verdict(Grade.REVIEW, f"calibration `{name}` changed from revision {old.revision} to {new.revision}")
    return Verdict(Grade.DANGEROUS, _unmeasured((name,), before.contract), ReviewArea.CALIBRATION)


def _compared(delta: Delta, after: Facts) -> Grade:
    """A version that another computer compares from now on is not lost."""
    still = {
        item
        for path, leaf in after.leaves.items()
        if path[:2] == delta.path[:2] and path[3:] == delta.path[3:]
        for item in _entries(leaf)
    }
    lost = {_part(item) for item in _entries(delta.before)} - {_part(item) for item in still}
    return Grade.DANGEROUS if lost else Grade.REVIEW


def _part(compared: str) -> str:
    """Return which part a step compares, whose package or version may be another one."""
    return compared.partition("=")[0]


def _of_shapes(delta: Delta, before: Facts, after: Facts) -> Verdict:
    """Shapes that take up less room, or other room, are avoided no longer where they were."""
    was, now = (
        next((link.collisions for link in side.description.links if link.name == delta.path[2]), ())
        for side in (before, after)
    )
    in_parent = obstacle_covers(delta.path[2], before, after)
    if in_parent is None:
        in_parent = covers(_in_mount(delta.path[2], was, before), _in_mount(delta.path[2], now, after))
    return Verdict(Grade.REVIEW if in_parent else Grade.DANGEROUS)


def _in_mount(link: str, shapes: tuple[Collision, ...], facts: Facts) -> tuple[Collision, ...]:
    """Return shapes where they are in the frame by which their device is mounted; how that moved is its own change."""
    roots = {device.root_link for device in facts.contract.devices.values()}
    joints = {joint.child: joint for joint in facts.description.joints}
    place = identity()
    for _ in joints:
        joint = joints.get(link)
        if link in roots or joint is None or joint.movable:
            break
        place, link = joint.pose @ place, joint.parent
    return tuple(replace(shape, pose=place @ shape.pose) for shape in shapes)


def _of_measurement(delta: Delta, before: Facts, after: Facts) -> Verdict:
    """A residual that grew is that of a new measurement, or it is not."""
    old, new = (side.contract.calibrations.get(delta.path[3]) for side in (before, after))
    if old is not None and new is not None and new.revision > old.revision:
        return Verdict(Grade.REVIEW)
    return Verdict(_looser(delta.before, delta.after))


def _of_load(delta: Delta, before: Facts, after: Facts) -> Verdict:
    why = unexplained_load(delta, before, after)
    return Verdict(Grade.REVIEW) if why is None else Verdict(Grade.DANGEROUS, why)


def _of_tool(delta: Delta, before: Facts, after: Facts) -> Verdict:
    is_known = delta.after is not None and is_measured_again(delta.path[2], before, after)
    return Verdict(Grade.REVIEW if is_known else Grade.DANGEROUS)


def _of_model(delta: Delta, before: Facts, after: Facts) -> Verdict:
    why = left_behind(delta.path[2], before, after)
    return Verdict(Grade.DANGEROUS, why) if why else Verdict(Grade.REVIEW)


def _of_clock(delta: Delta, before: Facts, after: Facts) -> Verdict:
    """A stamp that nothing is decided by may be further off."""
    limited = _decided_by(delta.path[2], after)
    if not limited or _looser(delta.before, delta.after) is not Grade.DANGEROUS:
        return Verdict(Grade.REVIEW)
    ages = [f"`{name}` to {shown(age, 's')}" for name, age in sorted(limited.items(), key=lambda item: item[1])]
    more = f" and {len(ages) - _NAMED} more" if len(ages) > _NAMED else ""
    told = f"its stamps may be further off, and ages are limited: of {', '.join(ages[:_NAMED])}{more}"
    return Verdict(Grade.DANGEROUS, told)


_NAMED = 2
"""Topics that a reason names."""
_OF_AGE = 0.1
"""Share of an age limit that the clock of who judges it may be off before it counts."""


def _decided_by(clock: str, facts: Facts) -> Mapping[str, float]:
    """Return the age limits, in s, of topics whose stamps a clock makes, or judges while it may be far off."""
    of, clocks = facts.contract.clock_of, facts.contract.clocks
    bound = clocks[clock].max_offset_s if clock in clocks else None
    limited = dict[str, float]()
    for name, interface in facts.contract.interfaces.items():
        if interface.max_age_s is None:
            continue
        is_made = clock in (interface.time_source, *(of.get(end.node) for end in interface.sources))
        is_judged = clock in {of.get(end.node) for end in interface.sinks}
        if is_made or (is_judged and (bound is None or bound > _OF_AGE * interface.max_age_s)):
            limited[name] = interface.max_age_s
    return limited


_OF_BOTH_SIDES: Mapping[Rule, Callable[[Delta, Facts, Facts], Verdict]] = {
    Rule.LOAD: _of_load,
    Rule.TOOL: _of_tool,
    Rule.REPLACED: _of_model,
    Rule.CLOCK: _of_clock,
}


def _of_area(delta: Delta, before: Facts, after: Facts) -> Verdict:
    """A larger area keeps arms apart in more room, and stops none that is in it from leaving."""
    area = delta.path[1]
    granted_by = after.leaves.get(("area", area, "granted_by"))
    granting = f"`{granted_by}`, which grants access, must be set to the same box" if granted_by else ""
    if keeps_apart(area, before, after):
        return Verdict(Grade.REVIEW, "; ".join(filter(None, ("arms meet in no more room than before", granting))))
    is_box = delta.path[2] in ("transform_to_parent", "size") and granting
    return Verdict(Grade.DANGEROUS, f"arms may meet where they were kept apart; {granting}" if is_box else "")


ELSEWHERE = "the arm reaches where people at the cell do not expect it"


def bases(facts: Facts) -> set[str]:
    """Return the root links of what takes things to other places."""
    contract = facts.contract
    return {device.root_link for name, device in contract.devices.items() if is_reaching(contract, name)}
