"""The parts that grippers take: which is between the fingers, how wide it is, who holds it, and when it falls."""

from __future__ import annotations

import math
from collections.abc import Mapping

from cellc.contract.contract import Contract, ContractBand, ContractGrasp
from cellc.contract.devices import ContractGripper
from cellc.contract.transforms import Pose, Vector3
from cellc.mock.control import JointFault
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.physics.dynamics import Dynamics
from cellc.mock.physics.grips import Grip, grip_on
from cellc.mock.world.world import World

GRASP_TOLERANCE_M = 0.03
"""Largest distance of the tip from a part's frame at which closing fingers take it, and from a place where it lies."""


class Parts:
    """What grippers hold, and how parts differ from what is stated of them.

    Attributes:
        held: part by gripper.
        grips: how a gripper presses on a part that has mass, by gripper.
        slipped_m: how far a held part has slipped between the fingers, by part.
    """

    def __init__(
        self,
        contract: Contract,
        control: ControlStack,
        world: World,
        boxes: Mapping[str, Vector3] | None = None,
        dynamics: Dynamics | None = None,
    ) -> None:
        """Bind the parts of a cell; ``boxes`` are the edges of the boxes that parts lie on, by their frames."""
        self._dynamics = dynamics
        self._boxes = boxes or {}
        self.held: dict[str, str] = {}
        self.grips: dict[str, Grip] = {}
        self.slipped_m: dict[str, float] = {}
        self._contract = contract
        self._control = control
        self._world = world
        self._wider_m: dict[str, float] = {}
        self._missing: set[str] = set()
        self._weak: set[str] = set()
        self._taken_from: dict[str, Vector3] = {}
        self._met: dict[str, JointFault] = {}
        self._in_hand: dict[str, Vector3] = {}

    def grasp(self, name: str | None) -> ContractGrasp | None:
        """Return what is stated of a part."""
        frame = None if name is None else self._contract.frames.get(name)
        return None if frame is None else frame.grasp

    def band(self, name: str | None, device: str) -> ContractBand | None:
        """Return where the fingers of a gripper are that hold a part; None where that is not stated."""
        grasp = self.grasp(name)
        return None if grasp is None else grasp.bands.get(device)

    def between(self, device: str, tip: str | None, now_ns: int) -> str | None:
        """Return the part nearest to the tip behind a tool, if it is near and the open fingers are astride it."""
        if tip is None or device in self.held:
            return None
        position = self._world.link_pose(tip, now_ns).position
        present = [name for name in self._world.objects() if name not in self._missing]
        distances = [(math.dist(position, self._world.object_pose(name, now_ns).position), name) for name in present]
        near = min((entry for entry in distances if entry[0] <= GRASP_TOLERANCE_M), default=None)
        gripper = self._contract.devices[device].gripper
        if near is None or gripper is None or (width_m := self.width_m(near[1])) is None:
            return None if near is None else near[1]
        finger_at = self._world.joint_positions(now_ns).get(gripper.joint, gripper.open)
        blocked_by = gripper.position(width_m)
        fits = width_m < gripper.stroke_m and abs(finger_at - gripper.closed) >= abs(blocked_by - gripper.closed)
        return near[1] if fits else None

    def _has_mass(self, name: str) -> bool:
        return self._dynamics is not None and self._dynamics.moves(name)

    def width_m(self, name: str) -> float | None:
        """Return how wide a part really is; None where that is not stated."""
        grasp = self.grasp(name)
        stated = None if grasp is None else grasp.width_m
        return None if stated is None else max(0.0, stated + self._wider_m.get(name, 0.0))

    def stop_fingers(self, device: str, name: str) -> None:
        """Let closing fingers come no farther than a part lets them; its width is not stated of every part."""
        gripper, width_m = self._contract.devices[device].gripper, self.width_m(name)
        if self._has_mass(name):
            return
        if gripper is not None and width_m is not None:
            self._block(gripper, gripper.position(width_m))

    def take(self, device: str, name: str, now_ns: int, in_hand: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Let a gripper hold a part, unless its fingers have no force.

        Args:
            in_hand: where the part is in what carries the fingers, m.
        """
        self._in_hand[name] = in_hand
        if self._dynamics is not None and self._dynamics.moves(name):
            self.grips[device] = grip_on(self._dynamics, name, self._dynamics.fingers[device])
        self._taken_from[name] = self._world.object_pose(name, now_ns).position
        self.held[device] = name
        self.slipped_m.pop(name, None)
        if device in self._weak:
            self.lose(device, now_ns)

    def measure(self, device: str, link: str, now_ns: int) -> None:
        """Measure how far a part that has mass has slipped in the link that carries the fingers which hold it."""
        name = self.held.get(device)
        if name is not None and self._has_mass(name):
            here = self._world.link_pose(link, now_ns).inverse() @ self._world.object_pose(name, now_ns)
            self.slipped_m[name] = math.dist(here.position, self._in_hand[name])

    def let_go(self, device: str) -> str | None:
        """Let a gripper hold nothing; return what it held."""
        gripper = self._contract.devices[device].gripper
        if gripper is not None:
            self._block(gripper, None)
        self.grips.pop(device, None)
        return self.held.pop(device, None)

    def lies(self, name: str, tip: str | None, now_ns: int) -> bool:
        """Tell whether a part that is let go of lies on something: where it was taken, at a goal, or on a box.

        A goal in a frame that is fixed says that something is there; of a part without a grasp nothing is known.
        """
        if self.grasp(name) is None or tip is None:
            return True
        here, world = self._world.link_pose(tip, now_ns).position, self._world
        frames = self._contract.frames
        places = [
            (world.link_pose(goal.frame, now_ns) @ goal.pose.pose).position
            for goal in self._contract.goals.values()
            if frames[goal.frame].kind != "dynamic" and self._contract.groups[goal.group].tip_frame == tip
        ]
        back = math.dist(world.object_pose(name, now_ns).position, self._taken_from.get(name, here))
        near = min((back, *(math.dist(here, place) for place in places))) <= GRASP_TOLERANCE_M
        return near or any(self._is_on(box, here, now_ns) for box in self._boxes)

    def _is_on(self, box: str, here: Vector3, now_ns: int) -> bool:
        """Tell whether a place is above the top of a box, as near as a part is to the tip that holds it."""
        in_box = self._world.link_pose(box, now_ns).inverse() @ Pose(here, (0.0, 0.0, 0.0, 1.0))
        (x, y, z), (length, width, height) = in_box.position, self._boxes[box]
        above_m = z - height / 2.0
        return abs(x) <= length / 2.0 and abs(y) <= width / 2.0 and 0.0 <= above_m <= GRASP_TOLERANCE_M

    def fall(self, name: str, now_ns: int) -> None:
        """Let a part fall to the ground; how it comes to rest is not played, but of a part that has mass."""
        if self._has_mass(name):
            return
        x, y, z = self._world.object_pose(name, now_ns).position
        self._world.place(name, self._contract.root_frame, Pose((x, y, min(z, 0.0)), (0.0, 0.0, 0.0, 1.0)), now_ns)

    # -- what goes wrong ---------------------------------------------------------------------------------------------

    def miss(self, name: str, *, missing: bool) -> None:
        """Let a part be seen where none is, or be there again."""
        (self._missing.add if missing else self._missing.discard)(name)
        if self._dynamics is not None and self._dynamics.moves(name):
            self._control.interrupt()
            self._dynamics.miss(name, missing=missing)

    def widen(self, name: str, by_m: float) -> None:
        """Let a part be wider than stated, or narrower."""
        self._wider_m[name] = by_m
        if self._dynamics is not None and self._dynamics.moves(name):
            self._control.interrupt()
            self._dynamics.reshape(name, wider_m=by_m)

    def weaken(self, device: str, *, weak: bool, now_ns: int) -> None:
        """Let the fingers of a gripper have no force: what they hold, now or later, falls."""
        (self._weak.add if weak else self._weak.discard)(device)
        if weak and device in self.held:
            self.lose(device, now_ns)

    def lose(self, device: str, now_ns: int) -> None:
        """Let what a gripper holds fall out of its fingers, which go on closing."""
        name = self.let_go(device)
        if name is not None:
            self.fall(name, now_ns)
            if self._dynamics is not None and self._dynamics.moves(name):
                self._control.interrupt()
                self._dynamics.reshape(name, friction=0.0)

    def slip(self, device: str, by_m: float) -> None:
        """Let what a gripper holds slide between its fingers."""
        if device not in self.held:
            return
        name = self.held[device]
        if self._dynamics is not None and self._dynamics.moves(name):
            self._control.interrupt()
            self._dynamics.slide(name, by_m)
        else:
            self.slipped_m[name] = by_m

    def _block(self, gripper: ContractGripper, at: float | None) -> None:
        """Let fingers meet a part that they cannot pass; none at None."""
        joint = gripper.joint
        before = self._met.pop(joint, None)
        if at is not None:
            self._met[joint] = JointFault(lower=at) if gripper.open > gripper.closed else JointFault(upper=at)
        for server in self._control.servers_of_joint(joint):
            if before is not None:
                server.disturbances.restore(joint, before)
            if joint in self._met:
                server.disturbances.disturb(joint, self._met[joint])
