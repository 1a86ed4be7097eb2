"""What a cell's shapes and joints allow, computed with the kinematics and kept in the cache.

The robot library is imported where an answer has to be computed and not before: a warm check does without.
"""

from cellc.geometry.answers import BodyContact, DisabledAnswer, DisabledLinks, GoalAnswer, MotionAnswer, PoseAnswer
from cellc.geometry.disabled import MARGIN_M, RNG_SEED, disabled_links
from cellc.geometry.motion import motion_answer

__all__ = [
    "MARGIN_M",
    "RNG_SEED",
    "BodyContact",
    "DisabledAnswer",
    "DisabledLinks",
    "GoalAnswer",
    "MotionAnswer",
    "PoseAnswer",
    "disabled_links",
    "motion_answer",
]
