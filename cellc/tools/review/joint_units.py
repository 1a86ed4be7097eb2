"""The units of what joints have: of one that slides and one that turns, on each side of a change its own."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Sequence

from cellc.robot.description.model import Joint
from cellc.tools.review.facts import Facts
from cellc.tools.review.leaves import Delta, Leaf, Path, Prose
from cellc.tools.review.units import unit_in

_OF_JOINTS = {"effort": ("N", "N m"), "stiffness": ("N/m", "N m/rad"), "damping": ("N s/m", "N m s/rad")}
"""Units of what differs between joints that slide and joints that turn."""


def units_of(unit: str, names: Sequence[str], before: Facts, after: Facts) -> tuple[str, str]:
    """Return the unit of a value on each side; of a joint, of the joints of a group, or of the fingers of a gripper.

    Args:
        unit: as a row of the table has it.
        names: those of the subject; a joint that one side alone has counts for both.
    """
    if not unit.startswith(("joint", *_OF_JOINTS)):
        return unit, unit
    joints = [_joints(names, facts) for facts in (before, after)]
    return _unit(unit, joints[0] or joints[1]), _unit(unit, joints[1] or joints[0])


def unit_of_leaf(path: Path, before: Facts, after: Facts) -> str:
    """Return the unit of a value that its name ends in, or that a value beside it gives, as for a spread."""
    beside = (*path[:-1], "unit")
    known = [side.leaves[beside] for side in (after, before) if path[-1] == "spread" and beside in side.leaves]
    return str(known[0]) if known else unit_in(path[-1])


def of_joints(delta: Delta, before: Facts, after: Facts) -> tuple[Leaf | None, Leaf | None]:
    """Return the values of a change; positions of a group with joints of both kinds as a text with both units."""
    if delta.path[:2] != ("contract", "poses"):
        return delta.before, delta.after
    was, now = (_positions(leaf, delta.path[3], side) for leaf, side in ((delta.before, before), (delta.after, after)))
    return was, now


def _positions(leaf: Leaf | None, group: str, facts: Facts) -> Leaf | None:
    types = {joint.name: joint.type for joint in facts.description.joints}
    names = facts.contract.groups[group].joints if group in facts.contract.groups else ()
    slides = [types.get(name) == "prismatic" for name in names]
    if not isinstance(leaf, tuple) or len(leaf) != len(slides) or len({*slides}) < len((True, False)):
        return leaf
    told = list[str]()
    for is_length, run in itertools.groupby(zip(leaf, slides, strict=True), key=lambda each: each[1]):
        factor, unit = (1e3, "mm") if is_length else (math.degrees(1.0), "deg")
        figures = [float(value) * factor for value, _ in run if isinstance(value, (int, float))]
        told += [*(f"{round(figure, 6) + 0.0:.7g}" for figure in figures), unit]
    return Prose(" ".join(told))


def _unit(unit: str, joints: Collection[Joint]) -> str:
    slides = any(joint.type == "prismatic" for joint in joints)
    return _OF_JOINTS[unit][not slides] if unit in _OF_JOINTS else unit.replace("joint", "m" if slides else "rad")


def _joints(names: Sequence[str], facts: Facts) -> Collection[Joint]:
    groups = [facts.contract.groups[name] for name in names if name in facts.contract.groups]
    devices = [facts.contract.devices[name] for name in names if name in facts.contract.devices]
    wanted = {*names, *(joint for group in groups for joint in group.joints)}
    wanted |= {device.gripper.joint for device in devices if device.gripper is not None}
    motions = () if facts.cell is None else facts.cell.bringup.first_motions
    wanted |= {
        f"{facts.contract.devices[first.device].prefix}{first.local_joint}"
        for first in motions
        if not {first.device, first.name}.isdisjoint(names)
    }
    parts = [facts.contract.frames[name].grasp for name in names if name in facts.contract.frames]
    wanted |= {band.joint for part in parts if part is not None for of, band in part.bands.items() if of in names}
    return [joint for joint in facts.description.joints if joint.name in wanted]
