"""What a cell's shapes and joints allow, computed with the planner and kept in the cache.

The robot library is imported where an answer has to be computed and not before: a warm check does without.
"""

from cellc.compiler.feasibility.answers import (
    MARGIN_M,
    RNG_SEED,
    BodyContact,
    DisabledAnswer,
    DisabledLinks,
    DroopAnswer,
    GoalAnswer,
    HoldingAnswer,
    MotionAnswer,
    PoseAnswer,
    TipAnswer,
    ViewAnswer,
)
from cellc.compiler.feasibility.feasibility import disabled_links, meeting_links, motion_answer
from cellc.compiler.feasibility.meshes import MeshFault, mesh_faults, mesh_reach
from cellc.compiler.feasibility.parts import part_with, parts_by_name, parts_of

__all__ = [
    "MARGIN_M",
    "RNG_SEED",
    "BodyContact",
    "DisabledAnswer",
    "DisabledLinks",
    "DroopAnswer",
    "GoalAnswer",
    "HoldingAnswer",
    "MeshFault",
    "MotionAnswer",
    "PoseAnswer",
    "TipAnswer",
    "ViewAnswer",
    "disabled_links",
    "meeting_links",
    "mesh_faults",
    "mesh_reach",
    "motion_answer",
    "part_with",
    "parts_by_name",
    "parts_of",
]
