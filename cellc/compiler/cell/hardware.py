"""What commands a device: its hardware component, driver or adapter, and what these do in the world."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import field
from typing import Annotated

from cellc.compiler.cell.entity import ELSEWHERE, STATED, Part
from cellc.compiler.cell.interface import InnerNode
from cellc.compiler.cell.site import JointFigure
from cellc.contract.entities import HardwareState, Target
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import (
    CommandAuthority,
    Distro,
    Gravity,
    Held,
    InterfaceKind,
    Loop,
    ManagerLock,
    Moment,
    Motion,
    Need,
    Unmet,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class InterfaceGroup:
    """A ros2_control ``<sensor>`` or ``<gpio>``: prefixed name, interfaces, and values that a mock starts from.

    One that is not ``declared`` is exported by the real hardware without a tag in the description.
    """

    name: str
    command_interfaces: tuple[str, ...]
    state_interfaces: tuple[str, ...]
    initial: Mapping[str, float]
    real_only: bool
    declared: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Effect:
    """What one moment in the life of a real device does in the world.

    Args:
        needs: what must hold before it → what happens otherwise, in the distribution of the cell.
        drops_part: what a gripper holds falls.
        leaves: the state of the component afterwards where it is not the one that was asked for.
        ends: what a claim needs and no longer has afterwards.
        does: the same as a sentence.
        largest_step: distance, rad or m, of a set point from the device that it still follows; None without bound.
    """

    motion: Motion
    authority: CommandAuthority
    lock: ManagerLock
    needs: Mapping[Need, Unmet]
    drops_part: bool
    leaves: HardwareState | None
    does: str
    largest_step: float | None = None
    ends: tuple[Need, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedReport:
    """Where a cell hears whether a need holds: by ``field`` of the newest message of a controller's topic.

    Args:
        controller_kind: kind of the controller that publishes it.
        topic: name of the topic below the controller's node.
        values: those of which the field has one while the need holds; none where it must be ``above`` a value.
    """

    controller_kind: str
    topic: str
    type: str
    field: str
    values: tuple[bool | int, ...]
    above: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandLaw:
    """How joints of a real device follow commands of some interfaces; without ``commands`` those of all others.

    Args:
        gains: where the figures of a spring are: controller, plugin or impedance; None of what is no spring.
        stiffness, damping: parameters of the real plugin that have them, joint by joint.
        lags: damping brakes the motion, not its error.
        because: why the loop is not known.
    """

    commands: tuple[str, ...]
    loop: Loop
    gains: str | None
    stiffness: tuple[str, ...]
    damping: tuple[str, ...]
    lags: bool
    gravity: Gravity
    held: Held
    because: str


@dataclass(frozen=True, slots=True)
class Drives:
    """What drives add to the joints that they turn, in the order of the description: kg m^2, N m s/rad and N m."""

    armature: tuple[float, ...] = ()
    damping: tuple[float, ...] = ()
    friction: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandModes:
    """Command modes of the real device: interfaces of its joints, and full names of gpios.

    Args:
        together: pairs that may be commanded together; every other switch to two is refused.
    """

    names: frozenset[str]
    together: frozenset[frozenset[str]]

    def of(self, claims: Iterable[str], joints: Container[str]) -> frozenset[str]:
        """Return the modes that full names of claimed interfaces stand for; ``joints`` are those of the device."""
        ends = (claim.rpartition("/") for claim in claims)
        return self.names & {last if owner in joints else owner for owner, _, last in ends}

    def allow(self, one: str, other: str) -> bool:
        """Tell whether the plugin commands both together."""
        return one == other or frozenset((one, other)) in self.together


@dataclass(frozen=True, slots=True, kw_only=True)
class HardwareComponent:
    """A component of ros2_control; plugins and parameters by target (``mock``, ``real``).

    Args:
        kinds: system, sensor or actuator of ros2_control, by target.
        targets: those on which it becomes a ``<ros2_control>`` tag; on any other the device's driver moves it.
        effects: what the real component does at each moment that the catalog tells of.
        initial_state: the state in which the real one must start.
        direct_activation: from there it must become active in one call, without a stay in between.
        enforce_command_limits: what the vendor tells the controller manager of this; None where it says nothing.
        reported_by: where the cell hears whether a need holds.
        nodes: those that the real plugin makes in the process of the controller manager.
        command_timeout_s: the longest silence before the device ends what it does; None where it is not stated.
        modes: command modes of the real one that exclude each other; None where it is not stated.
        fixed_joint_names: the real plugin makes the names of its joints in its code.
    """

    name: str
    targets: tuple[Target, ...]
    plugins: Mapping[str, str]
    parameters: Mapping[str, Mapping[str, str]]
    sensors: tuple[InterfaceGroup, ...]
    gpios: tuple[InterfaceGroup, ...]
    kinds: Mapping[str, str]
    effects: Mapping[Moment, Effect] = field(default_factory=dict)
    initial_state: HardwareState = "active"
    direct_activation: bool = False
    enforce_command_limits: bool | None
    command_timeout_s: float | None = None
    reported_by: Mapping[Need, NeedReport] = field(default_factory=dict)
    nodes: tuple[InnerNode, ...] = ()
    modes: CommandModes | None = None
    fixed_joint_names: bool = False

    @property
    def kept_by_a_claim(self) -> tuple[Need, ...]:
        """Needs without which a claim keeps set points that are old, and are sent, once the need is met."""
        claim = self.effects.get(Moment.CLAIM)
        unmet = {} if claim is None else claim.needs
        return tuple(need for need, otherwise in unmet.items() if otherwise is Unmet.KEEPS_SET_POINTS)

    @property
    def heard_before_a_claim(self) -> Mapping[Need, NeedReport]:
        """Where the cell hears whether these needs hold, as far as the catalog tells."""
        return {need: self.reported_by[need] for need in self.kept_by_a_claim if need in self.reported_by}

    @property
    def is_activation_known(self) -> bool:
        """Whether somebody says what the activation of the real one does."""
        return "real" not in self.plugins or Moment.ACTIVATE in self.effects

    @property
    def moves_as_it_is_activated(self) -> bool:
        """Whether its activation may move something or let a part fall, so that it is a release of its own."""
        effect = self.effects.get(Moment.ACTIVATE)
        if effect is None:
            return not self.is_activation_known
        return effect.drops_part or effect.motion not in (Motion.NONE, Motion.HOLDS)


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceDriver:
    """The node that moves a device on the real target past ros2_control.

    Args:
        node: its fully qualified name.
        program: ``package/executable``.
        joint_states: the topic on which the program publishes the joints of the device, or None.
        actions: kind of controller → the action, and its type, that takes such a controller's goals.
        goal_unit: what the figures of these goals are; None where they are those of the joints.
    """

    node: str
    program: str
    joint_states: str | None
    actions: Mapping[str, tuple[str, str]]
    goal_unit: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Adapter:
    """Watchdog, bounds and springs of a direct SDK; None where the spec leaves them to the default.

    ``stiffness`` is in N m/rad and ``damping`` in N m s/rad, joint by joint.
    """

    command_timeout_s: float | None = None
    stop_time_s: float | None = None
    goal_time_s: float | None = None
    path_tolerance: JointFigure | None = None
    stiffness: tuple[float, ...] | None = None
    damping: tuple[float, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class OfferedInterface:
    """What a driver offers whether the spec names it or not; ``node`` is the full name of the node behind it.

    ``effect`` is what a call does where it acts past every controller.
    """

    kind: InterfaceKind
    name: str
    type: str
    node: str
    effect: Effect | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceControl(Part):
    """What commands a device, and what that offers.

    Args:
        driver: what moves it on the real target where no component of ros2_control does.
        adapter: figures of the spec for an adapter on the vendor's library.
        initial_state: the state that the spec states for the component.
        offers: what the driver offers whether the spec names it or not.
        starts: full name of a node of the driver → what the start of its process does.
        speed_scaling: full name of the state interface that reports how far trajectories are slowed down.
        laws: how the joints of the real one follow commands, by the command interface.
        drives: what its drives add to its joints; None where no source says.
        update_rates_hz: those that the device accepts; any where empty.
        controller_kinds: kinds of controllers that only this device has → the distributions that have them.
    """

    hardware: HardwareComponent | None = None
    driver: DeviceDriver | None = None
    adapter: Annotated[Adapter | None, STATED] = None
    initial_state: Annotated[HardwareState | None, STATED] = None
    offers: Annotated[tuple[OfferedInterface, ...], ELSEWHERE] = ()
    starts: Annotated[Mapping[str, Effect], ELSEWHERE] = field(default_factory=dict)
    speed_scaling: Annotated[str | None, ELSEWHERE] = None
    laws: tuple[CommandLaw, ...] = ()
    drives: Drives | None = None
    update_rates_hz: Annotated[tuple[float, ...], ELSEWHERE] = ()
    controller_kinds: Annotated[Mapping[str, tuple[Distro, ...]], ELSEWHERE] = field(default_factory=dict)

    @property
    def startup_state(self) -> HardwareState:
        """Lifecycle state in which the controller manager starts its component, on every target."""
        if self.initial_state is not None or self.hardware is None:
            return self.initial_state or "active"
        return "unconfigured" if self.hardware.moves_as_it_is_activated else self.hardware.initial_state

    @property
    def unknown_effects(self) -> tuple[str, ...]:
        """The moments at which the real device starts, and with no statement of what they do in the world."""
        activation = self.hardware is not None and not self.hardware.is_activation_known
        start = self.driver is not None and self.driver.node not in self.starts
        return (*(("the activation",) if activation else ()), *(("the start of the driver",) if start else ()))

    @property
    def is_driven(self) -> bool:
        """Whether hardware of ros2_control or a node of its own reaches its drives, which the stop cuts off."""
        return self.hardware is not None or self.driver is not None
