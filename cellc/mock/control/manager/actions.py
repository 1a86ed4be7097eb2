"""Goals of all action servers: numbering, acceptance, cancellation."""

from __future__ import annotations

from cellc.mock.control.controllers.gripper import GripperController
from cellc.mock.control.controllers.joint_trajectory import JointTrajectoryController
from cellc.mock.control.controllers.joint_trajectory.validation import refusal
from cellc.mock.control.log import Log
from cellc.mock.control.manager.registry import ControllerRegistry
from cellc.mock.control.messages import CancelResponse, Goal, GoalResponse, GripperGoal, Trajectory, TrajectoryGoal

_CANNOT_ACCEPT = "Can't accept new action goals. Controller is not running."
_NO_ERROR, _UNKNOWN, _TERMINATED = 0, 2, 3


class GoalDesk:
    """Passes goals and cancel requests on to the controllers.

    Args:
        registry: the controllers.
        log: the log.
    """

    def __init__(self, registry: ControllerRegistry, log: Log) -> None:
        self._registry = registry
        self._log = log
        self._owners: dict[int, str] = {}

    def send(self, controller: str, goal: Goal, now_ns: int, listened: bool) -> GoalResponse:
        """Answer a goal request."""
        self._log.now_ns = now_ns
        loaded = self._registry.controllers.get(controller)
        found = None if loaded is None else loaded.controller
        if isinstance(found, JointTrajectoryController) and isinstance(goal, TrajectoryGoal):
            return self._send_trajectory(controller, found, goal, now_ns, listened)
        if isinstance(found, GripperController) and isinstance(goal, GripperGoal):
            return self._send_gripper(controller, found, goal, now_ns)
        return GoalResponse(False, 0, f"no action server for this goal at '{controller}'")

    def _send_trajectory(
        self, name: str, controller: JointTrajectoryController, goal: TrajectoryGoal, now_ns: int, listened: bool
    ) -> GoalResponse:
        self._log.info(name, "Received new action goal")
        state = self._registry.controllers[name].state
        reason = _CANNOT_ACCEPT if state != "active" else refusal(goal.trajectory(), controller.rules(), now_ns)
        if reason:
            self._log.error(name, reason)
            return GoalResponse(False, 0, reason)
        self._log.info(name, "Accepted new action goal")
        goal_id = self._number(name)
        controller.goals.accept(goal_id, goal, now_ns, listened)
        controller.take(goal.trajectory())
        return GoalResponse(True, goal_id)

    def _send_gripper(self, name: str, controller: GripperController, goal: GripperGoal, now_ns: int) -> GoalResponse:
        if not controller.active:
            return GoalResponse(False, 0, f"the action server of '{name}' exists only while it is active")
        reason = controller.refusal(goal)
        if reason:
            self._log.error(name, reason)
            return GoalResponse(False, 0, reason)
        self._log.info(name, "Received & accepted new action goal")
        goal_id = self._number(name)
        controller.accept(goal_id, goal, now_ns)
        return GoalResponse(True, goal_id)

    def _number(self, controller: str) -> int:
        goal_id = len(self._owners) + 1
        self._owners[goal_id] = controller
        return goal_id

    def cancel(self, goal_id: int, now_ns: int) -> CancelResponse:
        """Answer a cancel request for one goal."""
        self._log.now_ns = now_ns
        name = self._owners.get(goal_id)
        if name is None or name not in self._registry.controllers:
            return CancelResponse(_UNKNOWN)
        controller = self._registry.controllers[name].controller
        assert isinstance(controller, JointTrajectoryController | GripperController)
        goals = controller.goals if isinstance(controller, JointTrajectoryController) else controller
        if goals.running_id != goal_id:
            return CancelResponse(_NO_ERROR, (goal_id,)) if goals.is_waiting(goal_id) else CancelResponse(_TERMINATED)
        self._cancel_running(name, controller, now_ns)
        return CancelResponse(_NO_ERROR, (goal_id,))

    def _cancel_running(
        self, name: str, controller: JointTrajectoryController | GripperController, now_ns: int
    ) -> None:
        self._log.info(name, "Got request to cancel goal")
        self._log.info(name, "Canceling active action goal because cancel callback received.")
        if isinstance(controller, JointTrajectoryController):
            controller.goals.cancel(now_ns)
            controller.stop()
        else:
            controller.cancel(now_ns)

    def cancel_all(self, name: str, now_ns: int) -> CancelResponse:
        """Answer a cancel request for all goals of a controller."""
        self._log.now_ns = now_ns
        controller = self._registry.controllers[name].controller
        if isinstance(controller, JointTrajectoryController):
            running = controller.goals.running_id
        elif isinstance(controller, GripperController):
            running = controller.running_id
        else:
            running = 0
        return self.cancel(running, now_ns) if running else CancelResponse(_NO_ERROR)

    def take_trajectory(self, name: str, trajectory: Trajectory, now_ns: int) -> str:
        """Pass a message of `~/joint_trajectory` on; returns why it was ignored, empty where it was not."""
        self._log.now_ns = now_ns
        loaded = self._registry.controllers[name]
        controller = loaded.controller
        assert isinstance(controller, JointTrajectoryController), f"{name} is no trajectory controller"
        if loaded.state != "active":
            return "the controller is not active"
        reason = refusal(trajectory, controller.rules(), now_ns)
        if reason:
            self._log.error(name, reason)
        else:
            controller.take(trajectory)
        return reason
