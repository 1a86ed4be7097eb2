"""What happens between the fingers of a gripper, or the jaws of a switched device, when they close and open."""

from __future__ import annotations

from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.plant import Plant
from cellc.mock.task.context import AttemptError


def tip_link(plant: Plant, device: str) -> str | None:
    """Return the tip frame of the group whose chain goes through the gripper."""
    contract = plant.contract
    root = body_of(plant, device)
    for group in contract.groups.values():
        frame = group.tip_frame
        for _ in range(len(contract.frames) + 1):
            if frame == root:
                return group.tip_frame
            if frame not in contract.frames:
                break
            frame = contract.frames[frame].parent
    return None


def body_of(plant: Plant, device: str) -> str:
    """Return the link that carries what is held: the one in which fingers move, which in an arm is not its base."""
    facts = plant.contract.devices[device]
    fingers = None if facts.gripper is None else plant.world.carrier_of(facts.gripper.joint)
    return fingers or facts.root_link


def take(plant: Plant, device: str, name: str) -> None:
    """Let a device hold an object from now on."""
    link = body_of(plant, device)
    pose_in_link = plant.world.move(name, link, plant.now_ns)
    plant.planner.attach(_shape(plant, name), link, pose_in_link, plant.world.joint_positions(plant.now_ns))
    plant.parts.take(device, name, plant.now_ns, pose_in_link.position)


def _shape(plant: Plant, name: str) -> str:
    """Return what planning calls a part: one that lies at a fixed frame is not the link that the frame is."""
    frame = plant.contract.frames.get(name)
    return name if frame is None or frame.kind == "dynamic" else f"part at {name}"


def release(plant: Plant, device: str) -> None:
    """Let go of what a device holds: it stays where it is, if something is below it.

    Raises:
        AttemptError: grip_failure, where it falls, or has slipped and is not where it should be.
    """
    name = plant.parts.let_go(device)
    if name is None:
        return
    plant.world.move(name, plant.contract.root_frame, plant.now_ns)
    plant.planner.detach(_shape(plant, name))
    grasp, slipped_m = plant.parts.grasp(name), plant.parts.slipped_m.get(name, 0.0)
    if not plant.parts.lies(name, tip_link(plant, device), plant.now_ns):
        plant.parts.fall(name, plant.now_ns)
        raise AttemptError(AttemptOutcome.GRIP_FAILURE, f"dropped: {name} was released where no goal puts it")
    if grasp is not None and abs(slipped_m) > (grasp.tolerance_m or 0.0):
        text = f"slipped: {name} lies {abs(slipped_m) * 1e3:.3g} mm from where {device} gripped it"
        raise AttemptError(AttemptOutcome.GRIP_FAILURE, text)
