"""Answers about geometry: plain values, so that they can be kept."""

from __future__ import annotations

from cellc.contract.frozen import dataclass

RNG_SEED = 0
MARGIN_M = 0.005
"""Two links that come nearer than this in any sample stay checked, so that no near miss passes for "never"."""


@dataclass(frozen=True, slots=True, order=True)
class DisabledLinks:
    """Two links that need no collision check, the lesser name first; ``reason`` is adjacent, never, always or user."""

    first: str
    second: str
    reason: str


@dataclass(frozen=True, slots=True)
class DisabledAnswer:
    """All such pairs, sorted by name.

    Attributes:
        samples: number of configurations behind "never" and "always".
        refused: why the description cannot be used; empty where it can.
        limit: the row of the limits that it exceeds; empty where it exceeds none.
    """

    pairs: tuple[DisabledLinks, ...]
    samples: int
    refused: str = ""
    limit: str = ""


@dataclass(frozen=True, slots=True)
class BodyContact:
    """Two links, or a link and a box of the scene, that touch."""

    first: str
    second: str


@dataclass(frozen=True, slots=True)
class PoseAnswer:
    """What touches when all groups of a named pose stand in it.

    Attributes:
        least: group → least singular value of its tip's Jacobian there, rows in m and rad.
    """

    name: str
    contacts: tuple[BodyContact, ...]
    least: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class GoalAnswer:
    """Whether a goal can be taken, from the solution nearest to where the cell begins.

    Attributes:
        failure: word of the planner for why the tip cannot be there, empty where it can.
        detail: one line with figures.
        approach_failure: why no straight line leads to the goal, empty where one does or none is asked for.
        min_singular_value: least singular value of the tip's Jacobian at the goal, rows in m and rad.
        limit_joint: joint nearest to one of its limits there, as a share of its range; empty where none has a range.
        limit_share: its distance to that limit as a share of its range.
        limit_distance: the same in rad or m.
        configuration: joint positions of the solution in the order of the group, rad or m; empty without one.
    """

    name: str
    failure: str = ""
    detail: str = ""
    approach_failure: str = ""
    min_singular_value: float | None = None
    limit_joint: str = ""
    limit_share: float = 1.0
    limit_distance: float = 0.0
    configuration: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class ViewAnswer:
    """Where an object lies for the camera that detects it: in the optical frame, m, from a pose or goal of the arm."""

    name: str
    camera_frame: str
    posture: str
    place: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class HoldingAnswer:
    """What holds a joint still, Nm or N without sign, where it takes most of what it has.

    Attributes:
        posture: name of the pose or goal, empty for where the cell begins.
        towards: pose or goal on the way to which it is, from the posture; empty in the posture itself.
    """

    joint: str
    effort: float
    posture: str
    towards: str = ""


@dataclass(frozen=True, slots=True)
class DroopAnswer:
    """How far a joint is from its command at rest, where that is farthest; places as in `HoldingAnswer`.

    Attributes:
        droop: from the joint to its command, rad or m.
        effort: what its spring gives there, Nm or N.
        holding: whether a part is held.
    """

    joint: str
    droop: float
    effort: float
    posture: str
    towards: str
    holding: bool


@dataclass(frozen=True, slots=True)
class TipAnswer:
    """How far the tip of a group is from where it is commanded, at rest in a pose or goal; ``below_m`` along gravity.

    Attributes:
        contacts: what touches there, and would not where it is commanded.
        towards: pose or goal on the way to which it is, from the posture; empty in the posture itself.
    """

    group: str
    posture: str
    holding: bool
    distance_m: float
    below_m: float
    contacts: tuple[BodyContact, ...] = ()
    towards: str = ""


@dataclass(frozen=True, slots=True)
class AreaAnswer:
    """Which links stand in a volume that arms share, in a pose or at a goal; the empty name is the beginning."""

    area: str
    posture: str
    links: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MotionAnswer:
    """All answers of a cell; ``refused`` and ``limit`` as in `DisabledAnswer`.

    Attributes:
        views: where detected objects lie for their cameras.
        rigid: links that touch whatever the joints do, neighbors in the tree apart.
        holding: joints that have a limit of effort, each where gravity takes most of it.
        droops: joints behind springs, each in the pose or goal in which it droops most.
        on_paths: the same on the paths of rehearsals.
        outside: the same where it is outside its limits by more than motions may begin.
        tips: of groups with such joints, in each pose and goal with each load that rehearsals have there.
        tips_on_paths: the same on the paths of rehearsals, at the first place of each path where something touches.
        areas: volumes that arms share, with what is in them.
    """

    start: tuple[BodyContact, ...] = ()
    poses: tuple[PoseAnswer, ...] = ()
    goals: tuple[GoalAnswer, ...] = ()
    refused: str = ""
    limit: str = ""
    views: tuple[ViewAnswer, ...] = ()
    rigid: tuple[BodyContact, ...] = ()
    holding: tuple[HoldingAnswer, ...] = ()
    areas: tuple[AreaAnswer, ...] = ()
    droops: tuple[DroopAnswer, ...] = ()
    on_paths: tuple[DroopAnswer, ...] = ()
    outside: tuple[DroopAnswer, ...] = ()
    tips: tuple[TipAnswer, ...] = ()
    tips_on_paths: tuple[TipAnswer, ...] = ()
