"""The table of DDS: on which QoS policies a publisher offers less than a subscription requests.

Rules ask it before a cell is built, the mock when two endpoints meet. A profile offers what it promises to do, and
requests what it relies on. History, depth and lifespan are never compared. The rows are those of
`qos_profile_check_compatible` in rmw_dds_common and of the ROS 2 page "About Quality of Service settings".
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from cellc.contract.entities import Durability, Qos, Reliability
from cellc.contract.frozen import dataclass

DEFAULT = Qos(
    reliability="reliable",
    durability="volatile",
    history="keep_last",
    depth=10,
    deadline_s=None,
    lifespan_s=None,
    liveliness="automatic",
    lease_duration_s=None,
)
"""rmw_qos_profile_default (rmw/qos_profiles.h); services_default is alike in every policy that is matched."""


@dataclass(frozen=True, slots=True)
class Incompatibility:
    """One policy on which a publisher offers less than a subscription requests."""

    policy: str
    offered: str
    requested: str

    def __str__(self) -> str:
        return f"{self.policy}: offered {self.offered}, requested {self.requested}"


def incompatibilities(offered: Qos, requested: Qos) -> tuple[Incompatibility, ...]:
    """Return every policy that keeps two endpoints from being matched; none where they connect."""
    return tuple(_compare(offered, requested))


def weakest(offered: Sequence[Qos]) -> tuple[Reliability, Durability]:
    """Return the reliability and durability that every publisher of a topic offers."""
    weak = any(profile.reliability == "best_effort" for profile in offered)
    volatile = any(profile.durability == "volatile" for profile in offered) or not offered
    return "best_effort" if weak else "reliable", "volatile" if volatile else "transient_local"


_LEAST_OF_A_RECORDER = 100
"""That of tf2's own listeners: every static transform of a cell may be the one message of another publisher."""
_PAUSE_S = 1.0
"""How long a recorder may wait for its disk before a sample is lost."""


def recorder_depth(offered_depths: Iterable[int], rate_hz: float | None) -> int:
    """Return the queue of a recorder, for which every sample of every publisher of a topic counts.

    It has one queue for all of them, and holds in it what comes while it waits for its disk
    (https://github.com/ros2/rosbag2/pull/1960, 2025-04).
    """
    return max(_LEAST_OF_A_RECORDER, math.ceil((rate_hz or 0.0) * _PAUSE_S), sum(offered_depths))


def _compare(offered: Qos, requested: Qos) -> Iterator[Incompatibility]:
    if offered.reliability == "best_effort" and requested.reliability == "reliable":
        yield Incompatibility("reliability", offered.reliability, requested.reliability)
    if offered.durability == "volatile" and requested.durability == "transient_local":
        yield Incompatibility("durability", offered.durability, requested.durability)
    if _longer(offered.deadline_s, requested.deadline_s):
        yield Incompatibility("deadline", _seconds(offered.deadline_s), _seconds(requested.deadline_s))
    if offered.liveliness == "automatic" and requested.liveliness == "manual_by_topic":
        yield Incompatibility("liveliness", offered.liveliness, requested.liveliness)
    if _longer(offered.lease_duration_s, requested.lease_duration_s):
        yield Incompatibility(
            "lease_duration", _seconds(offered.lease_duration_s), _seconds(requested.lease_duration_s)
        )


def _longer(offered: float | None, requested: float | None) -> bool:
    """Tell whether an offered duration exceeds the requested one; None is infinite."""
    return requested is not None and (offered is None or offered > requested)


def _seconds(duration: float | None) -> str:
    return "infinite" if duration is None else f"{duration:g} s"
