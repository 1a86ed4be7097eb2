"""What devices do in the world beside following their commands: programs, brakes and claims, as their vendors have it.

A robot whose set points pass through a program of its own follows none while the program is stopped: its state goes on,
people may jog it, and a controller that keeps its claim keeps its set points. They are sent as the program starts, and
the arm jumps. The facts are those of the catalog, ``effects`` of a device in the contract.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from cellc.contract.bring_up import BringUpStep, TopicProof, Watch
from cellc.contract.contract import Contract, ContractDevice
from cellc.contract.vocabulary import BringUpPhase, ManagerLock, Moment, Motion, Need, Unmet
from cellc.mock.control import ControlEvent, ControllerChanged, ControllerManager
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.process import Action
from cellc.mock.engine.simulation import Simulation

STALE = 0.01
"""rad or m between a set point and a joint that make a jump; a joint that follows its trajectory is closer."""
REACTION_NS = 20_000_000
"""A message of the robot, and a request to its controller manager: so much later a watch lets go of its claims."""
JOGGED = 0.03
"""rad or m: small enough for the robot not to ignore it, large enough to be seen."""
STARTED_AFTER_NS = 300_000_000
LOCKED_NS = 3_000_000_000
"""Seconds, says the source of a gripper that is asked every second whether it has come to an end of its stroke."""
_BY_PEOPLE = (Need.BRAKES_OPEN, Need.INTERFACE_ENABLED, Need.PROGRAM_RUNNING)
"""What people bring about at the robot, after its driver has started and before a claim."""
_MOVING = (Motion.MOVES, Motion.JUMPS, Motion.FALLS, Motion.UNKNOWN)
JOG_NS = 10_000_000
JOG_SPEED = 0.25
"""rad/s or m/s of a joint that is jogged."""


@dataclass(frozen=True, slots=True)
class UncommandedMotion:
    """A joint that moved without a command.

    Attributes:
        step: rad or m that it moved in the cycle.
        distance: rad or m from where it was to the set point that it goes to.
    """

    device: str
    joint: str
    step: float
    distance: float
    cycle: int
    stamp_ns: int
    why: str

    def __str__(self) -> str:
        return (
            f"{self.joint} moved {self.step:.4f} of {self.distance:.4f} rad in cycle {self.cycle} "
            f"({self.stamp_ns / 1e9:.3f} s): {self.why}"
        )


class Effects:
    """Which needs of each device hold now, and the consequences.

    Attributes:
        motions: motions without a command.
        given_up: controllers that gave up their claim because of a watch, with the reason, until they are active again.
        ignored: devices that ignore the set points which they are sent, with the reason.
    """

    def __init__(
        self, contract: Contract, watches: Sequence[Watch], control: ControlStack, simulation: Simulation
    ) -> None:
        """Bind the devices of a contract; whatever any of them needs holds."""
        self.motions: list[UncommandedMotion] = []
        self.given_up: dict[str, str] = {}
        self.ignored: dict[str, str] = {}
        self._contract = contract
        self._watches = watches
        self._control = control
        self._simulation = simulation
        self._unmet: dict[str, set[Need]] = {}
        self._phase = BringUpPhase.START
        self._bringing_up = False
        self._waiting: defaultdict[BringUpPhase, list[Action]] = defaultdict(list)

    @property
    def refused(self) -> tuple[str, ...]:
        """Claims that devices have refused, with the reason."""
        return tuple(text for manager in self._control.managers.values() for text in manager.disturbances.refused)

    @property
    def silenced(self) -> tuple[str, ...]:
        """Devices that follow no set points now."""
        return tuple(device for device in self._unmet if not self._follows(device))

    def expect(self, phase: BringUpPhase, action: Action) -> None:
        """Call ``action`` once when the bring-up comes to a phase."""
        self._waiting[phase].append(action)

    def enter(self, phase: BringUpPhase) -> None:
        """Let the bring-up come to a phase, before anything of it is asked for."""
        self._phase = phase
        for action in self._waiting.pop(phase, []):
            action()

    # -- bring-up as on the real target --------------------------------------------------------------------------------

    def bring_up(self, steps: Sequence[BringUpStep]) -> None:
        """Put devices in their state before the bring-up of the real target: brakes closed, no program running.

        Args:
            steps: of the real target; a claim without proof of a running program is made before the program starts.
        """
        self._bringing_up = True
        proven = {
            proof.topic for step in steps for proof in step.proof if isinstance(proof, TopicProof) and proof.field
        }
        for device in sorted(self._contract.devices):
            claim = self._facts(device).effects.get(Moment.CLAIM)
            late = [need for need in _BY_PEOPLE if claim is not None and need in claim.needs]
            if self._facts(device).hardware_component is None:
                continue
            for need in late:
                self.unmet(device, need)
            is_published = any(device in self._publishers(topic) for topic in proven)
            ready = [need for need in late if need is not Need.PROGRAM_RUNNING or is_published]
            self.expect(BringUpPhase.CLAIM, partial(self._prepare, device, ready))
            states = {component.name: component.state for component in self._manager(device).list_hardware_components()}
            state = states[self._component(device)]
            if state == "active":
                self.activate(self._component(device))
            elif state == "inactive" and self._facts(device).nan_after_inactive:
                self.ignored[device] = f"commands of {self._component(device)} are NaN after a stay in inactive"

    def _prepare(self, device: str, needs: Sequence[Need]) -> None:
        """Let people do what the gates ask of them before they release a claim."""
        for need in needs:
            self.met(device, need)

    def activate(self, component: str) -> int:
        """Let a component do what the activation of the real one does; return for how long, in nanoseconds."""
        device = next(
            (name for name, device in self._contract.devices.items() if device.hardware_component == component), None
        )
        effect = None if device is None else self._facts(device).effects.get(Moment.ACTIVATE)
        if not self._bringing_up or device is None or effect is None:
            return 0
        gripper, manager, now_ns = self._facts(device).gripper, self._manager(device), self._simulation.now_ns
        if effect.motion in _MOVING and self._phase is not BringUpPhase.ACTIVATE:
            joint = component if gripper is None else gripper.joint
            stroke = 0.0 if gripper is None else abs(gripper.closed - gripper.open)
            why = f"activation of {device} moves it, in phase {self._phase.value}, in which nothing may move"
            cycle = now_ns // manager.period_ns
            self.motions.append(UncommandedMotion(device, joint, stroke, stroke, cycle, now_ns, why))
        if effect.lock is ManagerLock.NONE:
            return 0
        manager.disturbances.skip_cycles(LOCKED_NS // manager.period_ns)
        for other in sorted(self._contract.devices):
            timeout_s = self._facts(other).command_timeout_s
            shared = self._facts(other).hardware_component is not None and self._manager(other) is manager
            if shared and timeout_s is not None and timeout_s * 1e9 < LOCKED_NS and self._keeps(other):
                self.unmet(other, Need.PROGRAM_RUNNING)
        return LOCKED_NS

    def _keeps(self, device: str) -> bool:
        claim = self._facts(device).effects.get(Moment.CLAIM)
        return claim is not None and claim.needs.get(Need.PROGRAM_RUNNING) is Unmet.KEEPS_SET_POINTS

    def operator_takes_over(self) -> None:
        """Act as the operator once the cell is up: jog a robot whose program does not run yet, then start it."""
        self._bringing_up = False
        for history in self._control.histories.values():
            history.count_again()
        for device in self.silenced:
            joints = sorted(self._claims(device))
            if joints:
                self.jog(device, joints[0], JOGGED)
            for need in tuple(self._unmet[device]):
                at_ns = self._simulation.now_ns + STARTED_AFTER_NS
                self._simulation.at(at_ns, partial(self.met, device, need))

    # -- needs -------------------------------------------------------------------------------------------------------

    def unmet(self, device: str, need: Need) -> None:
        """Let something not hold any more that a claim of a device needs."""
        before = self._follows(device)
        self._unmet.setdefault(device, set()).add(need)
        self._refuse(device)
        if before and not self._follows(device):
            self._fall_silent(device)

    def met(self, device: str, need: Need) -> None:
        """Let it hold again."""
        before = self._follows(device)
        self._unmet.setdefault(device, set()).discard(need)
        self._refuse(device)
        if not before and self._follows(device):
            self._listen_again(device)

    def jog(self, device: str, joint: str, distance: float) -> None:
        """Let somebody move a joint of a silenced device by the pendant, rad or m, at the speed of a careful person."""
        start, start_ns = self._manager(device).joint_positions()[joint], self._simulation.now_ns
        steps = max(1, round(abs(distance) / (JOG_SPEED * JOG_NS / 1e9)))
        for number in range(1, steps + 1):
            place = partial(self._place, device, joint, start + distance * number / steps)
            self._simulation.at(start_ns + number * JOG_NS, place)

    def _place(self, device: str, joint: str, position: float) -> None:
        if not self._follows(device):
            self._manager(device).disturbances.place(joint, position)

    def is_claimed(self, device: str) -> bool:
        """Tell whether a controller commands joints of a device."""
        return bool(self._claims(device))

    # -- claims ------------------------------------------------------------------------------------------------------

    def _facts(self, device: str) -> ContractDevice:
        return self._contract.devices[device]

    def _needs(self, device: str, *otherwise: Unmet) -> set[Need]:
        """Return what a claim of a device needs and does not have, of which one of these comes."""
        claim = self._facts(device).effects.get(Moment.CLAIM)
        needs = {} if claim is None else claim.needs
        return {need for need in self._unmet.get(device, ()) if needs.get(need) in otherwise}

    def _follows(self, device: str) -> bool:
        return not self._needs(device, Unmet.KEEPS_SET_POINTS)

    def _refuse(self, device: str) -> None:
        """Let claims of a device fail for as long as they would on the robot."""
        component = self._component(device)
        ends = self._needs(device, Unmet.ENDS_MANAGER)
        lacking = ends or self._needs(device, Unmet.REFUSED, Unmet.UNKNOWN)
        manager = self._manager(device)
        if not lacking:
            manager.disturbances.accept_claims(component)
            return
        needed = " and ".join(sorted(need.replace("_", " ") for need in lacking))
        then = "the process of the controller manager ends" if ends else "the claim is refused"
        manager.disturbances.refuse_claims(component, f"a claim of {device} needs {needed}: {then}")

    def _component(self, device: str) -> str:
        return self._facts(device).hardware_component or ""

    def _manager(self, device: str) -> ControllerManager:
        return next(self._control.managers_of_component(self._component(device)))

    def _claims(self, device: str) -> dict[str, str]:
        """Return the joints of a device whose position a controller commands, with the controller."""
        joints = {
            joint
            for manager in self._contract.managers.values()
            for facts in manager.controllers.values()
            if facts.device == device
            for joint in facts.joints
        }
        return {
            interface.removesuffix("/position"): entry.name
            for entry in self._manager(device).list_controllers()
            for interface in entry.claimed_interfaces
            if interface.endswith("/position") and interface.removesuffix("/position") in joints
        }

    # -- set points --------------------------------------------------------------------------------------------------

    def _fall_silent(self, device: str) -> None:
        """Stop set points from reaching a device: it stops, and its watches report it."""
        manager = self._manager(device)
        manager.disturbances.ignore_commands(self._component(device))
        manager.disturbances.rest(self._component(device))
        self._scale(device, 0.0)
        for watch in self._watches:
            if device in self._publishers(watch.while_holds.topic):
                at_ns = self._simulation.now_ns + REACTION_NS
                self._simulation.at(at_ns, partial(self._let_go, watch, self._silence(device)))

    def _silence(self, device: str) -> str:
        return f"the program of {device} does not run" if self._keeps(device) else f"{device} follows no set points"

    def _scale(self, device: str, factor: float) -> None:
        interface = self._facts(device).speed_scaling_interface
        if interface is not None:
            self._manager(device).write_state(interface, factor)

    def _publishers(self, topic: str) -> set[str | None]:
        """Return the devices whose own controller publishes a topic."""
        return {
            facts.device
            for manager in self._contract.managers.values()
            for facts in manager.controllers.values()
            if topic.startswith(f"{facts.full_name}/")
        }

    def _let_go(self, watch: Watch, why: str) -> None:
        name, manager = self._watched(watch)
        keys = {
            controller.full_name.rpartition("/")[2]: key
            for key, controller in self._contract.managers[name].controllers.items()
        }
        active = {entry.name for entry in manager.list_controllers() if entry.state == "active"}
        claims = [key for key in (keys.get(each, each) for each in watch.controllers) if key in active]
        if claims:
            manager.switch_controllers([], claims)
            self.given_up |= dict.fromkeys(claims, why)
            self._control.changed.fire(self._simulation.now_ns)

    def _watched(self, watch: Watch) -> tuple[str, ControllerManager]:
        return next(
            (name, self._control.managers[name])
            for name, entry in self._contract.managers.items()
            if f"{entry.namespace}/controller_manager" == watch.manager
        )

    def hear(self, event: ControlEvent) -> None:
        """Note that a controller has its claim again."""
        if isinstance(event, ControllerChanged) and event.state == "active":
            self.given_up.pop(event.controller, None)

    def _listen_again(self, device: str) -> None:
        """Let set points reach a device again: those of its claims, however old."""
        manager, component = self._manager(device), self._component(device)
        claims, positions = self._claims(device), manager.joint_positions()
        self._scale(device, 1.0)
        apart = {joint: manager.command(f"{joint}/position") - positions[joint] for joint in claims}
        worst = max(apart, key=lambda joint: abs(apart[joint]), default=None)
        if worst is None:
            manager.disturbances.stand(component)
        elif abs(apart[worst]) > STALE:
            silence = f"the program of {device} was stopped" if self._keeps(device) else f"{device} followed none"
            why = f"{claims[worst]} kept its set point while {silence}"
            if self._is_ignored(device, worst, abs(apart[worst]), why):
                return
            measure = partial(self._note_jump, device, worst, positions[worst], apart[worst], why)
            self._simulation.at(self._simulation.now_ns + manager.period_ns, measure)
        manager.disturbances.accept_commands(component)

    def _is_ignored(self, device: str, joint: str, distance: float, why: str) -> bool:
        """Tell whether a device ignores a set point so far from where it is, and keep that in mind."""
        start = self._facts(device).effects.get(Moment.PROGRAM_START)
        followed = None if start is None else start.largest_step
        if followed is None or distance <= followed:
            return False
        self.ignored[device] = (
            f"{device} ignores a set point {distance:.4f} rad beside {joint}, it follows {followed:g} rad: {why}"
        )
        return True

    def _note_jump(self, device: str, joint: str, before: float, distance: float, why: str) -> None:
        manager, now_ns = self._manager(device), self._simulation.now_ns
        step = abs(manager.joint_positions()[joint] - before)
        cycle = now_ns // manager.period_ns
        self.motions.append(UncommandedMotion(device, joint, step, abs(distance), cycle, now_ns, why))
        self._control.changed.fire(now_ns)

    def recover(self) -> None:
        """Let devices that ignore set points start again from where their joints stand."""
        for device in tuple(self.ignored):
            del self.ignored[device]
            manager = self._manager(device)
            manager.disturbances.stand(self._component(device))
            manager.disturbances.accept_commands(self._component(device))
