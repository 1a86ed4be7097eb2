"""Planning groups, poses and goals with their joints and frames bound."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.cell.entity import Entity
from cellc.transforms import Pose, Vector3


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanningGroup(Entity):
    """A chain of joints from ``base_link`` to ``tip_frame``; ``controllers`` drive its joints."""

    base_link: str
    tip_frame: str
    joints: tuple[str, ...]
    controllers: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedPose(Entity):
    """Joint positions of one group, rad or m, in the order of ``joints``."""

    group: str
    joints: tuple[str, ...]
    positions: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CartesianGoal(Entity):
    """Where the tip of a group goes in ``frame``; ``approach`` is in the tip's own axes, m."""

    group: str
    frame: str
    transform_tip_to_frame: Pose
    approach: Vector3 | None
    transform_at: str
