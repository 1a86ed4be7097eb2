"""Devices that start as those of the real target do: brakes closed, no program running, and activations that move."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from functools import partial

from cellc.contract.bring_up import BringUpStep, TopicProof
from cellc.contract.vocabulary import BringUpPhase, ManagerLock, Moment, Motion, Need
from cellc.mock.device_view import DeviceView
from cellc.mock.effects import JOGGED, Effects, UncommandedMotion
from cellc.mock.engine.process import Action
from cellc.mock.engine.simulation import Simulation

STARTED_AFTER_NS = 300_000_000
LOCKED_NS = 3_000_000_000
"""Seconds, says the source of a gripper that is asked every second whether it has come to an end of its stroke."""
_BY_PEOPLE = (Need.BRAKES_OPEN, Need.INTERFACE_ENABLED, Need.PROGRAM_RUNNING)
"""What people bring about at the robot, after its driver has started and before a claim."""
_MOVING = (Motion.MOVES, Motion.JUMPS, Motion.FALLS, Motion.UNKNOWN)


class RealStart:
    """Which phase a bring-up is in, and what devices and people do in it."""

    def __init__(self, devices: DeviceView, effects: Effects, simulation: Simulation) -> None:
        """Bind the devices of a plant, whose mock needs no start."""
        self._devices = devices
        self._effects = effects
        self._simulation = simulation
        self._phase = BringUpPhase.START
        self._coming_up = False
        self._waiting: defaultdict[BringUpPhase, list[Action]] = defaultdict(list)

    def expect(self, phase: BringUpPhase, action: Action) -> None:
        """Call ``action`` once when the bring-up comes to a phase."""
        self._waiting[phase].append(action)

    def enter(self, phase: BringUpPhase) -> None:
        """Let the bring-up come to a phase, before anything of it is asked for."""
        self._phase = phase
        for action in self._waiting.pop(phase, []):
            action()

    def bring_up(self, steps: Sequence[BringUpStep]) -> None:
        """Let devices be as they are before anybody brings the real target up.

        Args:
            steps: of the real target; a claim that they do not prove a running program for comes before its start.
        """
        self._coming_up = True
        proven = {
            proof.topic for step in steps for proof in step.proof if isinstance(proof, TopicProof) and proof.field
        }
        for device in sorted(self._devices.contract.devices):
            facts = self._devices.facts(device)
            if facts.hardware_component is None or not self._devices.is_there(device):
                continue
            late = [need for need in _BY_PEOPLE if self._devices.unmet(device, need) is not None]
            for need in late:
                self._effects.unmet(device, need)
            heard = any(device in self._publishers(topic) for topic in proven)
            ready = [need for need in late if need is not Need.PROGRAM_RUNNING or heard]
            self.expect(BringUpPhase.CLAIM, partial(self._prepare, device, ready))
            listed = self._devices.manager(device).list_hardware_components()
            state = {component.name: component.state for component in listed}[facts.hardware_component]
            if state == "active":
                self.activate(facts.hardware_component)
            elif state == "inactive" and facts.nan_after_inactive:
                why = f"commands of {facts.hardware_component} are NaN after a stay in inactive"
                self._effects.ignored[device] = why

    def _prepare(self, device: str, needs: Sequence[Need]) -> None:
        """Let people do what the gates ask of them before they release a claim."""
        for need in needs:
            self._effects.met(device, need)

    def _publishers(self, topic: str) -> set[str | None]:
        """Return the devices whose own controller publishes a topic."""
        return {
            facts.device
            for manager in self._devices.contract.managers.values()
            for facts in manager.controllers.values()
            if topic.startswith(f"{facts.full_name}/")
        }

    def activate(self, component: str) -> int:
        """Let a component do what the activation of the real one does; return for how long, in nanoseconds."""
        everything = self._devices.contract.devices
        device = next((name for name, one in everything.items() if one.hardware_component == component), None)
        effect = None if device is None else everything[device].effects.get(Moment.ACTIVATE)
        if not self._coming_up or device is None or effect is None:
            return 0
        gripper, manager, now_ns = everything[device].gripper, self._devices.manager(device), self._simulation.now_ns
        if effect.motion in _MOVING and self._phase is not BringUpPhase.ACTIVATE:
            joint = component if gripper is None else gripper.joint
            stroke = 0.0 if gripper is None else abs(gripper.closed - gripper.open)
            why = f"activation of {device} moves it, in phase {self._phase.value}, in which nothing may move"
            cycle = now_ns // manager.period_ns
            self._effects.motions.append(UncommandedMotion(device, joint, stroke, stroke, cycle, now_ns, why))
        if effect.lock is ManagerLock.NONE:
            return 0
        manager.disturbances.skip_cycles(LOCKED_NS // manager.period_ns)
        for other, facts in sorted(everything.items()):
            shared = facts.hardware_component is not None and self._devices.manager(other) is manager
            impatient = facts.command_timeout_s is not None and facts.command_timeout_s * 1e9 < LOCKED_NS
            if shared and impatient and self._devices.has_program(other):
                self._effects.unmet(other, Need.PROGRAM_RUNNING)
        return LOCKED_NS

    def operator_takes_over(self) -> None:
        """Let people do what they do once the cell is up: jog a robot whose program does not run yet, and start it."""
        self._coming_up = False
        for history in self._devices.control.histories.values():
            history.count_again()
        for device in self._effects.silenced:
            joints = sorted(self._devices.claims(device))
            if joints:
                self._effects.jog(device, joints[0], JOGGED)
            at_ns = self._simulation.now_ns + STARTED_AFTER_NS
            for need in self._effects.lacking(device):
                self._simulation.at(at_ns, partial(self._effects.met, device, need))
