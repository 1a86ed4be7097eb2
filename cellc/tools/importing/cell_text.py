"""A first cell around an imported robot: it is at home, goes a little way, and comes back."""

from __future__ import annotations

from dataclasses import dataclass, field

from cellc.compiler.formats.numbers import shortest
from cellc.robot.description.model import Joint
from cellc.tools.importing.beside import ControllerFacts
from cellc.tools.importing.chain import Chain, home_of, range_of
from cellc.tools.importing.role import Role

_WIDEST = {False: 0.2, True: 0.02}
_SHARE = 0.25
"""Of a joint's range that a path tolerance is at most."""


@dataclass(frozen=True, slots=True)
class FirstCell:
    """What a first cell is made of.

    Attributes:
        away: where the joints of the chain go, rad or m.
        packages: folders of the repository in which packages of the description lie, relative to the spec.
    """

    role: Role
    away: tuple[float, ...]
    controllers: ControllerFacts = field(default_factory=ControllerFacts)
    ros: str = "jazzy"
    packages: tuple[str, ...] = ()


def cell_text(name: str, folder: str, first: FirstCell) -> str:
    """Write the spec of a cell whose one device is the folder, named relative to the spec."""
    chain, moved, device, group = first.role.chain, first.controllers, first.role.device, first.role.group
    joints = ", ".join(f"{device}/{joint.name}" for joint in chain.joints)
    base, tip = f"{device}/{chain.base}", f"{device}/{chain.tip}"
    return "\n".join(
        (
            "format: 1",
            f"cell: {name}",
            f"summary: {name} on the mock, as `cellc import` made it",
            f"versions: {{ros: {first.ros}}}        # what is missing here is UNKNOWN and blocks the real target",
            *([f"packages: [{', '.join(first.packages)}]"] if first.packages else []),
            "devices:",
            f"  {device}: {{model: {folder}, mount: {{parent: world}}}}",
            "control:",
            f"  update_rate: {moved.update_rate_hz:g} Hz",
            "  controllers:",
            "    joint_states: {type: joint_state_broadcaster}",
            f"    {device}_trajectory:",
            "      type: joint_trajectory",
            f"      device: {device}",
            f"      joints: [{joints}]",
            f"      goal_time: {moved.goal_time_s:g} s",
            f"      path_tolerance: {_tolerance(chain, 1.0)}",
            f"      goal_tolerance: {_tolerance(chain, 0.1)}",
            "motion:",
            f"  groups: {{{group}: {{base: {base}, tip: {tip}}}}}",
            "  poses:",
            f"    home: {{{group}: {_positions([(joint, home_of(joint)) for joint in chain.joints])}}}",
            f"    away: {{{group}: {_positions(list(zip(chain.joints, first.away, strict=True)))}}}",
            "rehearsals:",
            "  first_move: {steps: [move: away, move: home]}",
            "",
        )
    )


def _tolerance(chain: Chain, share: float) -> str:
    """Return one figure for each kind of joint of the chain, small beside what the shortest of them moves."""
    parts = []
    for slides, unit in ((False, "rad"), (True, "m")):
        ranges = [range_of(joint) for joint in chain.joints if joint.slides == slides]
        if ranges:
            parts.append(f"{share * min(_WIDEST[slides], _SHARE * min(ranges)):.3g} {unit}")
    return " ".join(parts)


def _positions(values: list[tuple[Joint, float]]) -> str:
    """Write positions, a unit wherever the kind of joint changes."""
    texts = []
    for number, (joint, value) in enumerate(values):
        last = number + 1 == len(values) or values[number + 1][0].slides != joint.slides
        texts.append(shortest(value) + (f" {'m' if joint.slides else 'rad'}" if last else ""))
    return " ".join(texts)
