"""QoS profiles in the metadata of a channel, as rosbag2 writes them, so that a player offers what the cell offered."""

from __future__ import annotations

import yaml

from cellc.contract.contract import ContractQos

_INFINITE = {"sec": 9223372036, "nsec": 854775807}
"""RMW_DURATION_INFINITE: the largest int64 of nanoseconds."""
# Values of rmw_qos_*_policy_e in rmw/types.h.
_HISTORY = {"keep_last": 1, "keep_all": 2}
_RELIABILITY = {"reliable": 1, "best_effort": 2}
_DURABILITY = {"transient_local": 1, "volatile": 2}
_LIVELINESS = {"automatic": 1, "manual_by_topic": 3}

DEFAULT = ContractQos(
    reliability="reliable",
    durability="volatile",
    history="keep_last",
    depth=10,
    deadline_s=None,
    lifespan_s=None,
    liveliness="automatic",
    lease_duration_s=None,
)
"""rmw_qos_profile_default."""
LATCHED = DEFAULT.model_copy(update={"durability": "transient_local", "depth": 1})
"""What robot_state_publisher offers for the description and for static transforms."""


def offered_qos_profiles(qos: ContractQos) -> str:
    """Return the list of the one profile that is offered, as YAML.

    Policies are numbers: Humble reads nothing else, and later decoders try numbers first (ros2/rosbag2, `qos.cpp`).
    """
    profile = {
        "history": _HISTORY[qos.history],
        "depth": qos.depth,
        "reliability": _RELIABILITY[qos.reliability],
        "durability": _DURABILITY[qos.durability],
        "deadline": _duration(qos.deadline_s),
        "lifespan": _duration(qos.lifespan_s),
        "liveliness": _LIVELINESS[qos.liveliness],
        "liveliness_lease_duration": _duration(qos.lease_duration_s),
        "avoid_ros_namespace_conventions": False,
    }
    return yaml.safe_dump([profile], sort_keys=False)


def _duration(seconds: float | None) -> dict[str, int]:
    if seconds is None:
        return dict(_INFINITE)
    nanoseconds = round(seconds * 1e9)
    return {"sec": nanoseconds // 1_000_000_000, "nsec": nanoseconds % 1_000_000_000}
