"""Faults of joints and hardware, asked for from outside, effective with the next update cycle."""

from __future__ import annotations

from collections.abc import Callable

from cellc.mock.control.hardware.joint_fault import JointFault, JointFaults


class Disturbances:
    """Switches faults on and off.

    Attributes:
        joints: what is wrong with each joint.
        refused: why claims were refused that somebody asked for.

    Args:
        changed: called before each change.
        skip: called with the number of update cycles that the manager misses.
        set_state: called with component and lifecycle state.
        stand: called with a component whose commands shall be where its joints are.
        place: called with a joint and the position that it is moved to from outside.
        rest: called with a component whose joints shall stand still.
    """

    def __init__(
        self,
        changed: Callable[[], None],
        skip: Callable[[int], None],
        set_state: Callable[[str, str], object],
        stand: Callable[[str], None],
        place: Callable[[str, float], None],
        rest: Callable[[str], None],
    ) -> None:
        self._changed = changed
        self._skip = skip
        self._set_state = set_state
        self._stand = stand
        self._place = place
        self._rest = rest
        self.joints = JointFaults()
        self._deaf: set[str] = set()
        self._failing_read: set[str] = set()
        self._failing_write: set[str] = set()
        self._lost: set[str] = set()
        self._refusing: dict[str, str] = {}
        self.refused: list[str] = []

    def ignores_commands(self, component: str) -> bool:
        """Whether a component ignores its commands."""
        return component in self._deaf

    def take_read_failure(self, component: str) -> bool:
        """Whether the component's read fails in this cycle; asked once."""
        failing = component in self._failing_read
        self._failing_read.discard(component)
        return failing

    def take_write_failure(self, component: str) -> bool:
        """Whether the component's write fails in this cycle; asked once."""
        failing = component in self._failing_write
        self._failing_write.discard(component)
        return failing

    def is_lost(self, component: str) -> bool:
        """Whether the driver of a component has lost its device, and has handled that error itself."""
        return component in self._lost

    def pending(self) -> bool:
        """Whether a read or write is to fail."""
        return bool(self._failing_read or self._failing_write)

    def disturb(self, joint: str, fault: JointFault) -> None:
        """Let something be wrong with a joint, beside whatever else is."""
        self._changed()
        self.joints.add(joint, fault)

    def restore(self, joint: str, fault: JointFault) -> None:
        """Let that be right again."""
        self._changed()
        self.joints.remove(joint, fault)

    def ignore_commands(self, component: str) -> None:
        """Let a component no longer follow its commands."""
        self._changed()
        self._deaf.add(component)

    def accept_commands(self, component: str) -> None:
        """Let a component follow its commands again."""
        self._changed()
        self._deaf.discard(component)

    def stand(self, component: str) -> None:
        """Let the commands of a component be where its joints stand."""
        self._changed()
        self._stand(component)

    def place(self, joint: str, position: float) -> None:
        """Let somebody move a joint of a component that ignores its commands."""
        self._changed()
        self._place(joint, position)

    def rest(self, component: str) -> None:
        """Let the joints of a component stand still."""
        self._changed()
        self._rest(component)

    def refuse_claims(self, component: str, reason: str) -> None:
        """Let a component refuse every claim of its interfaces."""
        self._refusing[component] = reason

    def accept_claims(self, component: str) -> None:
        """Let a component accept claims again."""
        self._refusing.pop(component, None)

    def take_refusal(self, component: str) -> str:
        """Why a component refuses the claim that is asked for now; empty where it does not."""
        reason = self._refusing.get(component, "")
        if reason and reason not in self.refused:
            self.refused.append(reason)
        return reason

    def fail_read(self, component: str) -> None:
        """Let the next read of a component return an error."""
        self._changed()
        self._failing_read.add(component)

    def fail_write(self, component: str) -> None:
        """Let the next write of a component return an error."""
        self._changed()
        self._failing_write.add(component)

    def skip_cycles(self, cycles: int) -> None:
        """Let the manager miss its next update cycles; the one after them sees the longer period."""
        self._changed()
        self._skip(cycles)

    def protective_stop(self, component: str) -> None:
        """Stop a component: it becomes inactive and ignores commands until it is released."""
        self._changed()
        self._deaf.add(component)
        self._set_state(component, "inactive")

    def release(self, component: str) -> None:
        """End a protective stop: the component is active again and follows commands."""
        self._changed()
        self._deaf.discard(component)
        self._set_state(component, "active")

    def lose(self, component: str) -> None:
        """Let a driver lose its device: its next read fails, its error handler leaves it unconfigured."""
        self._changed()
        self._deaf.add(component)
        self._lost.add(component)
        self._failing_read.add(component)

    def recover(self, component: str) -> None:
        """Let a stopped or lost component be active again; like any driver it begins from where its joints stand."""
        self._changed()
        self._deaf.discard(component)
        self._lost.discard(component)
        self._failing_read.discard(component)
        self._stand(component)
        self._set_state(component, "active")
