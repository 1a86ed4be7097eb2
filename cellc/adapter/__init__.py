"""The boundary around a device that is driven by its vendor's own library: implement `DeviceAdapter` for yours.

Nothing here needs ROS, the compiler or the mock. `cellc.adapter.conformance` has the checks that every implementation
passes, the mock's and yours; `TrajectoryFollower` turns trajectories into the bounded commands that an adapter takes.
"""

from cellc.adapter.bounds import check_command
from cellc.adapter.device import DeviceAdapter
from cellc.adapter.follow import FollowerResult, FollowerStatus, TrajectoryFollower
from cellc.adapter.messages import DeviceState, JointCommand, Refusal, RefusalReason
from cellc.adapter.model import AdapterModel, JointModel, Unit
from cellc.adapter.phase import Phase
from cellc.adapter.trajectory import Trajectory, Waypoint

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
