"""What devices do in the world beside following their commands: programs, brakes, stops and links, as their vendors do.

A robot whose set points pass through a program of its own follows none while the program is stopped or pauses: its
state goes on, people may jog it, and a controller that keeps its claim keeps its set points. They are sent as the
program goes on, and the arm jumps, or continues the goal that was stopped. The facts are those of the catalog,
``effects`` and ``stops`` of a device in the contract.
"""

from __future__ import annotations

from functools import partial

from cellc.contract.devices import ContractEffect, ContractStop
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import LeftBy, Moment, Motion, Need, Unmet
from cellc.mock.device_view import DeviceView
from cellc.mock.engine.simulation import Simulation
from cellc.mock.stops import FAULT, Stops, recovery_state
from cellc.mock.watching import ClaimWatches

STALE = 0.01
"""rad or m between a set point and a joint that make a jump; a joint that follows its trajectory is closer."""
MOVED = 1e-3
"""rad or m by which a joint without an acknowledgment may stir: below what is visible, above noise of a state."""
LOOK_NS = 10_000_000
JOGGED = 0.03
"""rad or m: below what a robot ignores as too far, above what is visible."""
JOG_NS = 10_000_000
JOG_SPEED = 0.25
"""rad/s or m/s of a joint that is jogged."""
_SILENCE = {
    Need.PROGRAM_RUNNING: "the program of {device} is not running",
    Need.NO_STOP: "{device} is stopped",
    Need.NOT_PAUSED: "the program of {device} is paused",
}
_WAS_SILENT = {
    Need.PROGRAM_RUNNING: "the program of {device} was stopped",
    Need.NO_STOP: "{device} was stopped",
    Need.NOT_PAUSED: "the program of {device} was paused",
}


@dataclass(frozen=True, slots=True)
class UncommandedMotion:
    """A joint that moved without a command.

    Attributes:
        step: rad or m that it moved in the cycle, or since it was to stand.
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
    """What holds of each device now, and what follows.

    Attributes:
        motions: motions without a command.
        ignored: devices that ignore the set points which they are sent, with the reason.
        dangers: what a device did that nothing in the cell shows.
    """

    def __init__(self, devices: DeviceView, stops: Stops, watches: ClaimWatches, simulation: Simulation) -> None:
        """Bind the devices of a plant; whatever any of them needs holds."""
        self.motions: list[UncommandedMotion] = []
        self.ignored: dict[str, str] = {}
        self.dangers: list[str] = []
        self._devices = devices
        self._stops = stops
        self._watches = watches
        self._simulation = simulation
        self._unmet: dict[str, set[Need]] = {}
        self._paused_at: dict[str, dict[str, float]] = {}
        self._left_to_people: dict[str, tuple[Need, ...]] = {}
        self._guarded: set[str] = set()
        self._cut: set[str] = set()

    @property
    def refused(self) -> tuple[str, ...]:
        """Claims that devices have refused, with the reason."""
        managers = self._devices.control.managers.values()
        return tuple(text for manager in managers for text in manager.disturbances.refused)

    @property
    def silenced(self) -> tuple[str, ...]:
        """Devices that follow no set points now."""
        return tuple(device for device in self._unmet if not self._follows(device))

    @property
    def unrecoverable(self) -> tuple[str, ...]:
        """Those of them that the person who acknowledges does not bring back."""
        return tuple(device for device in self.silenced if device not in self._left_to_people)

    def lacking(self, device: str) -> tuple[Need, ...]:
        """Return what a device lacks of what a claim needs."""
        return tuple(sorted(self._unmet.get(device, ())))

    # -- needs -------------------------------------------------------------------------------------------------------

    def unmet(self, device: str, need: Need) -> None:
        """Let something not hold any more that a claim of a device needs."""
        before = self._follows(device)
        self._unmet.setdefault(device, set()).add(need)
        if need is Need.PROGRAM_RUNNING:  # what ended does not pause
            self._unmet[device].discard(Need.NOT_PAUSED)
            self._paused_at.pop(device, None)
        elif need is Need.NOT_PAUSED and self._devices.claims(device):
            self._paused_at[device] = self._positions(device)
        self._refuse(device)
        if before and not self._follows(device):
            self._fall_silent(device)
        if device not in self._cut:
            self._tell(device, need)

    def met(self, device: str, need: Need) -> None:
        """Let it hold again."""
        before, lost = self._follows(device), self._first_lost(device)
        self._unmet.setdefault(device, set()).discard(need)
        self._refuse(device)
        if not before and self._follows(device):
            self._listen_again(device, lost)

    def jog(self, device: str, joint: str, distance: float) -> None:
        """Let somebody move a joint of a silenced device by the pendant, rad or m, at the speed of a careful person."""
        start, start_ns = self._devices.manager(device).joint_positions()[joint], self._simulation.now_ns
        steps = max(1, round(abs(distance) / (JOG_SPEED * JOG_NS / 1e9)))
        for number in range(1, steps + 1):
            place = partial(self._place, device, joint, start + distance * number / steps)
            self._simulation.at(start_ns + number * JOG_NS, place)

    def _place(self, device: str, joint: str, position: float) -> None:
        if not self._follows(device):
            self._devices.manager(device).disturbances.place(joint, position)

    def is_claimed(self, device: str) -> bool:
        """Tell whether a controller commands joints of a device."""
        return bool(self._devices.claims(device))

    def _needs(self, device: str, *otherwise: Unmet) -> set[Need]:
        """Return what a claim of a device needs and does not have, of which one of these comes."""
        return {need for need in self._unmet.get(device, ()) if self._devices.unmet(device, need) in otherwise}

    def _first_lost(self, device: str) -> Need | None:
        lost = self._needs(device, Unmet.KEEPS_SET_POINTS)
        return next((need for need in _SILENCE if need in lost), next(iter(sorted(lost)), None))

    def _follows(self, device: str) -> bool:
        return not self._needs(device, Unmet.KEEPS_SET_POINTS)

    def _refuse(self, device: str) -> None:
        """Let claims of a device fail for as long as they would on the robot."""
        component = self._devices.component(device)
        ends = self._needs(device, Unmet.ENDS_MANAGER)
        lacking = ends or self._needs(device, Unmet.REFUSED, Unmet.UNKNOWN)
        manager = self._devices.manager(device)
        if not lacking:
            manager.disturbances.accept_claims(component)
            return
        needed = " and ".join(sorted(need.replace("_", " ") for need in lacking))
        then = "the process of the controller manager ends" if ends else "the claim is refused"
        manager.disturbances.refuse_claims(component, f"a claim of {device} needs {needed}: {then}")

    # -- stops and links ---------------------------------------------------------------------------------------------

    def stop(self, device: str, name: str) -> None:
        """Let a device stop by itself, in a state of its own, as its driver shows it."""
        stop, component = self._devices.facts(device).stops[name], self._devices.component(device)
        self._stops.enter(component, recovery_state(name))
        leaves = self._leaves(device, stop)
        if leaves == "active":
            self._stop_unseen(device, stop)
        elif leaves == "unconfigured":
            self._devices.manager(device).disturbances.lose(component)
        else:
            for server in self._devices.control.servers_of_component(component):
                server.disturbances.protective_stop(component)

    def _leaves(self, device: str, stop: ContractStop) -> str:
        return "inactive" if device in self._devices.contract.adapters else stop.leaves

    def _stop_unseen(self, device: str, stop: ContractStop) -> None:
        """Stop a device whose component stays active: by what its claim lacks then, or by nothing at all."""
        for need in stop.ends:
            self.unmet(device, need)
        if not stop.ends:
            self._deafen(device)
        if stop.motion is Motion.FALLS:
            self.dangers.append(
                f"dangerous: `{device}` fell when it stopped; old joint states continue and do not show it"
            )

    def end_stop(self, device: str, name: str, *, resumed: bool = True) -> None:
        """Let what stopped a device be over; unless a person has to act first, it goes on.

        Args:
            resumed: the person at the device has acknowledged there, too.
        """
        stop = self._devices.facts(device).stops[name]
        self._stops.end_cause(self._devices.component(device))
        if self._leaves(device, stop) != "active":
            return
        if resumed and stop.left_by is not LeftBy.ACTIVATION:
            for need in reversed(stop.ends):
                self.met(device, need)
        elif stop.ends:
            self._left_to_people[device] = stop.ends

    def lose_driver(self, device: str) -> None:
        """End the driver of a device: its read fails, and its component is unconfigured."""
        component = self._devices.component(device)
        self._stops.enter(component, FAULT)
        self._devices.manager(device).disturbances.lose(component)

    def end_cause(self, device: str) -> None:
        """Let the driver of a device be there again; its component stays as it is until a person acknowledges."""
        self._stops.end_cause(self._devices.component(device))

    def cut(self, device: str) -> None:
        """Let the link of a device carry nothing: it stops, and old states continue."""
        self._cut.add(device)
        self._deafen(device)

    def lose_link(self, device: str) -> bool:
        """Let a device act on a link that stays cut; tell whether its driver gives up."""
        effect = self._link(device)
        if effect is None or effect.leaves != "active":
            self.lose_driver(device)
            return True
        for need in effect.ends:
            self.unmet(device, need)
        return False

    def reconnect(self, device: str) -> None:
        """Let the link carry again: what the device says is heard, and what it is sent is followed."""
        self._cut.discard(device)
        for need in self.lacking(device):
            self._tell(device, need)
        if self._follows(device):
            self._listen_again(device, None)

    def _link(self, device: str) -> ContractEffect | None:
        return self._devices.facts(device).effects.get(Moment.LINK_LOST)

    # -- set points --------------------------------------------------------------------------------------------------

    def _deafen(self, device: str) -> None:
        component = self._devices.component(device)
        for manager in self._devices.control.managers_of_component(component):
            manager.disturbances.ignore_commands(component)
            manager.disturbances.rest(component)

    def _fall_silent(self, device: str) -> None:
        """Let set points no longer reach a device: it stops, and slows its trajectories down to nothing."""
        self._deafen(device)
        if device not in self._cut:
            self._scale(device, 0.0)

    def _tell(self, device: str, need: Need) -> None:
        """Let the watch of a device hear that a need does not hold."""
        lost = self._first_lost(device)
        silence = _SILENCE.get(lost or need, "") if self._devices.has_program(device) else ""
        why = silence.format(device=device) or f"{device} follows no set points"
        noted = partial(self._note_report, device)
        self._watches.hear(device, need, why, noted)

    def _note_report(self, device: str) -> None:
        self._stops.report(self._devices.component(device), self._simulation.now_ns)

    def _scale(self, device: str, factor: float) -> None:
        interface = self._devices.facts(device).speed_scaling_interface
        if interface is not None:
            self._devices.manager(device).write_state(interface, factor)

    def _positions(self, device: str) -> dict[str, float]:
        positions = self._devices.manager(device).joint_positions()
        return {joint: positions[joint] for joint in self._devices.claims(device)}

    def _listen_again(self, device: str, lost: Need | None) -> None:
        """Let set points reach a device again: those of its claims, however old, and the last one of its own program.

        Args:
            lost: what it lacked before.
        """
        manager, component = self._devices.manager(device), self._devices.component(device)
        claims, positions = self._devices.claims(device), manager.joint_positions()
        kept = self._kept(device)
        self._scale(device, 1.0)
        targets = kept | {joint: manager.command(f"{joint}/position") for joint in claims}
        apart = {joint: target - positions[joint] for joint, target in targets.items()}
        worst = max(apart, key=lambda joint: abs(apart[joint]), default=None)
        silent = "" if lost is None or not self._devices.has_program(device) else _WAS_SILENT.get(lost, "")
        silence = silent.format(device=device) or f"{device} followed none"
        if worst is not None and abs(apart[worst]) > STALE:
            holder = claims.get(worst) or f"the program of {device}"
            why = f"{holder} kept its set point while {silence}"
            if not kept and self._is_ignored(device, worst, abs(apart[worst]), why):
                return
            measure = partial(self._note_jump, device, worst, positions[worst], apart[worst], why)
            self._simulation.at(self._simulation.now_ns + manager.period_ns, measure)
            if not claims:
                manager.disturbances.place(worst, kept[worst])
        elif claims:
            holders = " and ".join(sorted(set(claims.values())))
            self._guard(device, self._positions(device), f"{holders} continued after {silence}")
        if not claims:
            manager.disturbances.stand(component)
        manager.disturbances.accept_commands(component)

    def _kept(self, device: str) -> dict[str, float]:
        """Return the set points that a program has from before its pause, and follows as it resumes."""
        resume = self._devices.facts(device).effects.get(Moment.PROGRAM_RESUME)
        paused = self._paused_at.pop(device, {})
        return paused if resume is not None and resume.motion is Motion.JUMPS else {}

    def _is_ignored(self, device: str, joint: str, distance: float, why: str) -> bool:
        """Tell whether a device ignores a set point so far from where it is, and keep that in mind."""
        start = self._devices.facts(device).effects.get(Moment.PROGRAM_START)
        followed = None if start is None else start.largest_step
        if followed is None or distance <= followed:
            return False
        self.ignored[device] = (
            f"{device} ignores a set point {distance:.4f} rad away from {joint}, "
            f"it follows at most {followed:g} rad: {why}"
        )
        return True

    def _note_jump(self, device: str, joint: str, before: float, distance: float, why: str) -> None:
        manager = self._devices.manager(device)
        self._note(device, joint, abs(manager.joint_positions()[joint] - before), abs(distance), why)

    def _note(self, device: str, joint: str, step: float, distance: float, why: str) -> None:
        now_ns = self._simulation.now_ns
        cycle = now_ns // self._devices.manager(device).period_ns
        self.motions.append(UncommandedMotion(device, joint, step, distance, cycle, now_ns, why))
        self._devices.control.changed.fire(now_ns)

    def _guard(self, device: str, start: dict[str, float], why: str) -> None:
        """Check whether a device moves before a person acknowledged, until one does or its claims are gone."""
        self._guarded.add(device)
        self._simulation.at(self._simulation.now_ns + LOOK_NS, partial(self._look, device, start, why))

    def _look(self, device: str, start: dict[str, float], why: str) -> None:
        if device not in self._guarded:
            return
        positions = self._devices.manager(device).joint_positions()
        moved = {joint: abs(positions[joint] - start[joint]) for joint in start}
        worst = max(moved, key=lambda joint: moved[joint])
        if moved[worst] > MOVED:
            self._guarded.discard(device)
            self._note(device, worst, moved[worst], moved[worst], f"{why}, and no person had acknowledged")
        elif self._devices.claims(device):
            self._guard(device, start, why)

    def recover(self) -> None:
        """Let the person who acknowledges bring devices back: each follows from where its joints stand."""
        self._guarded.clear()
        for device, needs in tuple(self._left_to_people.items()):
            self._paused_at.pop(device, None)  # a program that is started from its beginning has no set point
            for need in needs:
                self.met(device, need)
        self._left_to_people.clear()
        for device in tuple(self.ignored):
            del self.ignored[device]
            manager = self._devices.manager(device)
            manager.disturbances.stand(self._devices.component(device))
            manager.disturbances.accept_commands(self._devices.component(device))
        self._watches.acknowledge()
