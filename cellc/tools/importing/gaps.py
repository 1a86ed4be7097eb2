"""What a vendor's description leaves out of the limits of its joints, and the careful figures that fill the gaps.

The mock runs with an assumed figure. Its source is UNKNOWN, which is a question and closes the real target.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.catalog.limit_facts import LimitFacts
from cellc.contract.vocabulary import UNKNOWN
from cellc.robot.description.model import Description, Joint, JointLimit
from cellc.tools.importing.kinds import is_wheel
from cellc.tools.importing.merge import Facts

_FIGURES = {
    "position": ({"lower": "-1 rad", "upper": "1 rad"}, {"lower": "0 m", "upper": "0.1 m"}),
    "velocity": ({"value": "0.5 rad/s"}, {"value": "0.05 m/s"}),
    "effort": ({"value": "0 N m"}, {"value": "0 N"}),
}
"""By key of `limits`: what is assumed of a joint that turns, and of one that slides."""


def assumed_limits(description: Description) -> Facts:
    """Return the entries of `limits` that fill the gaps: key, joint, figures with what the description states."""
    limits: Facts = {}
    moving = [joint for joint in description.joints if joint.movable and joint.mimic is None]
    driven = [joint for joint in moving if joint.limit is not None or joint.type != "continuous" or not is_wheel(joint)]
    for joint in driven or moving:  # a caster needs no limits, unless nothing else moves
        for key, stated in _gaps(joint):
            source = f"{UNKNOWN}, assumed by cellc import: the description states {stated}"
            limits.setdefault(key, {})[joint.name] = {**_FIGURES[key][joint.slides], "source": source}
    return limits


def with_limits(description: Description, limits: Facts) -> Description:
    """Return a description with the entries of `limits` in it."""
    return LimitFacts.model_validate(limits).on(description)


def gap_questions(limits: Facts) -> Iterator[str]:
    """Yield a question for each kind of limit that is assumed."""
    for key, joints in limits.items():
        first = next(iter(joints))
        more = f" and {len(joints) - 1} more" if len(joints) > 1 else ""
        stated = str(joints[first]["source"]).rpartition(": ")[2]
        figures = " to ".join(
            str(joints[first][field]) for field in ("lower", "upper", "value") if field in joints[first]
        )
        yield f"`limits: {key}` of `{first}`{more}: {stated}, {figures} is assumed; what does the vendor allow?"


def _gaps(joint: Joint) -> Iterator[tuple[str, str]]:
    limit = joint.limit or JointLimit(None, None, None, None)
    if joint.type != "continuous":
        if limit.lower is None or limit.upper is None:
            yield "position", "no range"
        elif limit.lower == limit.upper:
            yield "position", f"{limit.lower:g} to {limit.upper:g} {'m' if joint.slides else 'rad'}"
    if limit.velocity is None:
        yield "velocity", "no velocity"
    elif limit.velocity == 0.0:
        yield "velocity", "a velocity of 0"
    if limit.effort is None:
        yield "effort", "no effort"
