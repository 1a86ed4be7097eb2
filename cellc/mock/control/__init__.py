"""The simulated control stack: what ros2_control and its controllers would do with a URDF and a controllers.yaml.

Time is simulated, in integer nanoseconds; nothing sleeps and nothing is random.
"""

from cellc.mock.control.controllers.base import DeclaredInterfaces
from cellc.mock.control.controllers.broadcasters import JointStateBlock
from cellc.mock.control.controllers.joint_trajectory.recorder import Recording
from cellc.mock.control.errors import ManagerAbortedError
from cellc.mock.control.hardware import Disturbances, JointFault, Noise
from cellc.mock.control.log import LogLevel, LogLine
from cellc.mock.control.manager import ControllerManager
from cellc.mock.control.manager.services import SpawnResponse
from cellc.mock.control.manager.switching import Strictness
from cellc.mock.control.messages import (
    CancelResponse,
    ControlEvent,
    ControllerChanged,
    GoalEnded,
    GoalResponse,
    GoalStatus,
    GripperEnded,
    GripperGoal,
    HardwareChanged,
    HardwareStateResponse,
    JointTolerance,
    ParameterResponse,
    ServiceResponse,
    Trajectory,
    TrajectoryEnded,
    TrajectoryFeedback,
    TrajectoryGoal,
    TrajectoryPoint,
    TrajectoryStateResponse,
)

__all__ = [
    "CancelResponse",
    "ControlEvent",
    "ControllerChanged",
    "ControllerManager",
    "DeclaredInterfaces",
    "Disturbances",
    "GoalEnded",
    "GoalResponse",
    "GoalStatus",
    "GripperEnded",
    "GripperGoal",
    "HardwareChanged",
    "HardwareStateResponse",
    "JointFault",
    "JointStateBlock",
    "JointTolerance",
    "LogLevel",
    "LogLine",
    "ManagerAbortedError",
    "Noise",
    "ParameterResponse",
    "Recording",
    "ServiceResponse",
    "SpawnResponse",
    "Strictness",
    "Trajectory",
    "TrajectoryEnded",
    "TrajectoryFeedback",
    "TrajectoryGoal",
    "TrajectoryPoint",
    "TrajectoryStateResponse",
]
