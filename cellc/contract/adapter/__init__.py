"""The boundary around a device that is driven by its vendor's own library: implement `DeviceAdapter` for yours.

Nothing here needs ROS, the compiler or the mock. `cellc.contract.adapter.conformance` has the checks that every
implementation passes, the mock's and yours; `TrajectoryFollower` turns trajectories into the bounded
commands that an adapter takes.
"""

from cellc.contract.adapter.device import (
    AdapterModel,
    DeviceAdapter,
    DeviceState,
    JointCommand,
    JointModel,
    Phase,
    Refusal,
    RefusalReason,
    Unit,
    check_command,
)
from cellc.contract.adapter.follow import FollowerResult, FollowerStatus, Trajectory, TrajectoryFollower, Waypoint

__all__ = [
    "AdapterModel",
    "DeviceAdapter",
    "DeviceState",
    "FollowerResult",
    "FollowerStatus",
    "JointCommand",
    "JointModel",
    "Phase",
    "Refusal",
    "RefusalReason",
    "Trajectory",
    "TrajectoryFollower",
    "Unit",
    "Waypoint",
    "check_command",
]
