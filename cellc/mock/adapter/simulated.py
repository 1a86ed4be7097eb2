"""A simulated device behind an adapter, and its faults, asked for as those of ros2_control's hardware are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cellc.contract.adapter import AdapterModel, DeviceState, JointCommand, Phase, Refusal, check_command
from cellc.contract.control_law import ControlLaw
from cellc.mock.adapter.measured import MeasuredMotion
from cellc.mock.control.hardware import JointFault, JointFaults
from cellc.mock.control.hardware.forces import Forces
from cellc.robot.planning import Springs

WATCHDOG_FAULT = "no command within the watchdog's time"


class SimulatedAdapter:
    """A device in simulated time; it leads its joints to a command in one period, and they follow by its law.

    Attributes:
        joints: what is wrong with each joint.
    """

    def __init__(
        self,
        model: AdapterModel,
        positions: tuple[float, ...],
        now_ns: Callable[[], int],
        forces: Forces | None = None,
    ) -> None:
        """Bind the device at its initial positions; ``now_ns`` is its clock, and ``forces`` moves its joints."""
        self._forces = forces
        if forces is not None:
            forces.begin(dict(zip(model.joint_names, positions, strict=True)))
        self.joints = JointFaults()
        self._model = model
        self._clock = now_ns
        self._phase = Phase.UNCONFIGURED
        self._fault = ""
        self._safety_stop = ""
        self._from = positions
        self._to = positions
        self._commanded = positions
        self._taken_ns = now_ns()
        self._streaming = False
        self._stop_velocity: tuple[float, ...] | None = None
        self._measured: MeasuredMotion | None = None

    @property
    def model(self) -> AdapterModel:
        """Joints, units, bounds, rates and watchdog."""
        return self._model

    @property
    def phase(self) -> Phase:
        """Where the device is; readable without a connection."""
        return self._phase

    @property
    def fresh_command(self) -> tuple[float, ...] | None:
        """Positions of the command that was taken at this instant; None where none was."""
        return self._commanded if self._streaming and self._taken_ns == self.now_ns() else None

    @property
    def settled(self) -> bool:
        """Whether the joints come to rest where they are, without a command."""
        springs = self._springs
        if self._forces is not None:
            return False
        return springs is None or (springs.settled and not self._leads())

    def bind(self, law: ControlLaw, springs: Springs) -> None:
        """Let the joints follow by a law from where they are; a law that binds them already gets another load.

        Drives of joints that have mass know their law.
        """
        if self._forces is not None:
            return
        if self._measured is not None:
            self._measured.load(springs)
            return
        names, now_ns = self._model.joint_names, self.now_ns()
        period_ns = round(self._model.command_period_s * 1e9)
        self._measured = MeasuredMotion(law, springs, names, self._motion(now_ns)[0], period_ns, now_ns)

    def aim(self, forces: Forces) -> None:
        """Lead the drives of the joints to where the device leads them now."""
        forces.aim(self._model.joint_names, np.array([self._motion(self.now_ns())[0]]))

    def now_ns(self) -> int:
        """Return the device's time."""
        return self._clock()

    def connect(self) -> None:
        """Connect: unconfigured to inactive."""
        if self._phase is Phase.FINALIZED:
            raise ConnectionError(f"`{self._model.device}` was disconnected for good")
        if self._phase is Phase.UNCONFIGURED:
            self._phase = Phase.INACTIVE

    def activate(self) -> None:
        """Take commands: inactive to active."""
        if self._phase is not Phase.INACTIVE:
            raise RuntimeError(f"`{self._model.device}` is {self._phase.value}, not inactive")
        self._phase = Phase.ACTIVE
        if self._measured is not None:
            self._measured.rest(self._motion(self.now_ns())[0], self.now_ns())

    def deactivate(self) -> None:
        """Hold and refuse commands: active to inactive."""
        self.hold()
        if self._phase is Phase.ACTIVE:
            self._leave_springs(self.now_ns())
            self._phase = Phase.INACTIVE

    def acknowledge(self) -> None:
        """Leave a stop: stopped to inactive."""
        self._watch()
        if self._phase is not Phase.STOPPED:
            raise RuntimeError(f"`{self._model.device}` is {self._phase.value}, not stopped")
        if self._safety_stop:
            raise RuntimeError(f"`{self._model.device}` still has reason to stop: {self._safety_stop}")
        self._phase, self._fault = Phase.INACTIVE, ""

    def disconnect(self) -> None:
        """Hold and disconnect: finalized."""
        self.hold()
        self._phase = Phase.FINALIZED

    def read(self) -> DeviceState:
        """Return the state now."""
        if self._phase in (Phase.UNCONFIGURED, Phase.FINALIZED):
            raise ConnectionError(f"`{self._model.device}` is {self._phase.value}")
        self._watch()
        now_ns = self.now_ns()
        positions, velocities = self._state(now_ns)
        return DeviceState(now_ns, self._measured_at(positions, now_ns), velocities, (), self._phase, self._fault)

    def command(self, command: JointCommand) -> Refusal | None:
        """Go towards a command, or refuse it."""
        self._watch()
        now_ns = self.now_ns()
        at = self._motion(now_ns)[0]
        last = self._commanded if self._streaming else self._state(now_ns)[0]
        refusal = check_command(self._model, command, phase=self._phase, last=last, now_ns=now_ns)
        if refusal is None:
            self._from, self._to, self._taken_ns = at, self._reachable(command.positions, at), now_ns
            self._commanded, self._streaming, self._stop_velocity = command.positions, True, None
        return refusal

    def hold(self) -> None:
        """End the stream and come to a standstill."""
        self._watch()
        if self._streaming:
            self._brake(self.now_ns())

    def disturb(self, joint: str, fault: JointFault) -> None:
        """Let something be wrong with a joint, beside whatever else is; an offset moves it immediately."""
        self.joints.add(joint, fault)
        self._shift(joint, fault.offset)

    def restore(self, joint: str, fault: JointFault) -> None:
        """Let that be right again."""
        before = self.joints.of(joint) or JointFault()
        self.joints.remove(joint, fault)
        self._shift(joint, (self.joints.of(joint) or JointFault()).offset - before.offset)

    def _shift(self, joint: str, by: float) -> None:
        column = self._model.joint_names.index(joint)
        self._from, self._to = (
            (*ends[:column], ends[column] + by, *ends[column + 1 :]) for ends in (self._from, self._to)
        )

    def trip(self, reason: str) -> None:
        """Let the vendor's safety stop the device until ``release``."""
        self._safety_stop = reason
        self._stop(self.now_ns(), reason)

    def release(self) -> None:
        """Take the reason for a safety stop away; the device stays stopped until it is acknowledged."""
        self._safety_stop = ""

    def _watch(self) -> None:
        """Stop where the stream was silent for too long; the stop began when its time was over."""
        limit_ns = self._taken_ns + round(self._model.command_timeout_s * 1e9)
        if self._streaming and self.now_ns() > limit_ns:
            self._stop(limit_ns, WATCHDOG_FAULT)

    def _stop(self, at_ns: int, fault: str) -> None:
        if self._streaming:
            self._brake(at_ns)
        self._leave_springs(at_ns)
        if self._phase in (Phase.ACTIVE, Phase.INACTIVE):
            self._phase, self._fault = Phase.STOPPED, fault

    def _brake(self, at_ns: int) -> None:
        """Slow down evenly to standstill within the stop time, from the motion at an instant."""
        springs = self._springs
        measured = springs is not None and springs.holds_measured
        positions, velocities = self._state(at_ns) if measured else self._motion(at_ns)
        self._streaming = False
        self._from, self._taken_ns, self._stop_velocity = positions, at_ns, velocities

    def _reachable(self, wanted: tuple[float, ...], at: tuple[float, ...]) -> tuple[float, ...]:
        """Return where the joints are one period after a command."""
        if not self.joints:
            return wanted
        return tuple(
            self._followed(name, here, there)
            for name, here, there in zip(self._model.joint_names, at, wanted, strict=True)
        )

    def _measured_at(self, positions: tuple[float, ...], now_ns: int) -> tuple[float, ...]:
        """Return what is measured of positions, rad or m."""
        if not self.joints:
            return positions
        cycle = now_ns // round(self._model.command_period_s * 1e9)
        faults = map(self.joints.of, self._model.joint_names)
        return tuple(
            at if fault is None else float(fault.measured(np.array([at]), cycle)[0])
            for at, fault in zip(positions, faults, strict=True)
        )

    def _followed(self, joint: str, at: float, wanted: float) -> float:
        fault = self.joints.of(joint)
        if fault is None:
            return wanted
        return float(fault.follow(np.array([wanted]), at, self._model.command_period_s)[0])

    @property
    def _springs(self) -> MeasuredMotion | None:
        """What holds the joints while the device takes commands; else its vendor's own brakes and loops hold them."""
        return self._measured if self._phase is Phase.ACTIVE else None

    def _leave_springs(self, at_ns: int) -> None:
        """Let the vendor hold the joints where the springs have let them go."""
        if self._springs is not None:
            positions, velocities = self._state(at_ns)
            self._from, self._taken_ns, self._stop_velocity = positions, at_ns, velocities

    def _state(self, at_ns: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return measured positions and velocities at an instant that is not before the last one asked about."""
        if self._forces is not None:
            standing, moving = (
                self._forces.standing(self._model.joint_names),
                self._forces.moving(self._model.joint_names),
            )
            return tuple(standing.tolist()), tuple(moving.tolist())
        springs = self._springs
        if springs is None:
            return self._motion(at_ns)
        springs.advance(at_ns, lambda time_ns: self._motion(time_ns)[0], leads=self._leads())
        return springs.positions, springs.velocities

    def _leads(self) -> bool:
        """Return whether the device moves its joints since the last period."""
        over_s = self._model.stop_time_s if self._stop_velocity is not None else 0.0
        return self._streaming or self.now_ns() <= self._taken_ns + round((over_s + self._model.command_period_s) * 1e9)

    def _motion(self, at_ns: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return where joints are led at an instant since the last command or brake, and their velocities."""
        elapsed_s = max(0, at_ns - self._taken_ns) / 1e9
        zero = (0.0,) * len(self._from)
        if self._stop_velocity is not None:
            stop_s = self._model.stop_time_s
            spent_s = min(elapsed_s, stop_s)
            path_s = spent_s - spent_s * spent_s / (2.0 * stop_s)
            positions = tuple(a + v * path_s for a, v in zip(self._from, self._stop_velocity, strict=True))
            return positions, tuple(v * (1.0 - spent_s / stop_s) for v in self._stop_velocity)
        period_s = self._model.command_period_s
        if not self._streaming:
            return self._from, zero
        if elapsed_s > period_s:
            return self._to, zero
        share = elapsed_s / period_s
        positions = tuple(a + (b - a) * share for a, b in zip(self._from, self._to, strict=True))
        return positions, tuple((b - a) / period_s for a, b in zip(self._from, self._to, strict=True))


class AdapterDisturbances:
    """Switches faults of one device on and off; its component is the device itself."""

    def __init__(self, adapter: SimulatedAdapter) -> None:
        """Bind the healthy device."""
        self._adapter = adapter

    def disturb(self, joint: str, fault: JointFault) -> None:
        """Let something be wrong with a joint, beside whatever else is."""
        self._adapter.disturb(joint, fault)

    def restore(self, joint: str, fault: JointFault) -> None:
        """Let that be right again."""
        self._adapter.restore(joint, fault)

    def protective_stop(self, component: str) -> None:
        """Let the safety of the device stop it."""
        self._adapter.trip(f"safety stop of {component}")

    def recover(self, component: str) -> None:
        """Leave a stop whose reason is over, and take commands again; the joints stay where they stand."""
        self._adapter.release()
        self._adapter.acknowledge()
        self._adapter.activate()
