"""Controller managers, controllers and what they claim; and devices that an adapter drives in their place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated

from cellc.compiler.catalog import controller_kind
from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.cell.entity import ELSEWHERE, Entity
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.cell.site import JointFigure
from cellc.contract.entities import TARGETS, Target
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Behavior


@dataclass(frozen=True, slots=True, kw_only=True)
class StandIn:
    """What takes the goals of a controller on real hardware: an action of the device's own node."""

    node: str
    action: str
    action_type: str
    unit: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class VendorCommand:
    """What the vendor commands on real hardware with a kind of controller, and what happens with anything else.

    Args:
        interfaces: command interfaces of each joint.
        because: what the hardware does with commands of another interface.
    """

    interfaces: tuple[str, ...]
    because: str


@dataclass(frozen=True, slots=True, kw_only=True)
class OnReal:
    """What a controller claims and gets on the real target where that differs from what it does on the mock."""

    command_interfaces: tuple[str, ...]
    parameters: Mapping[str, ParameterValue]


@dataclass(frozen=True, slots=True, kw_only=True)
class ControllerTopic:
    """A topic that a controller has with its parameters: its full name in the cell, and which end it is.

    Args:
        declared: its entry in the catalog, such as the profile of its end.
        rate_hz: rate that a parameter sets; None where it publishes in each of its cycles, or on change.
    """

    name: str
    type: str
    publishes: bool
    declared: controller_kind.ControllerTopic
    rate_hz: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Controller(Entity):
    """A controller with its plugin for the cell's distribution.

    Args:
        namespace: that of its manager, empty or with a leading slash.
        label: name that no other controller of the cell has: the bare one, or the full one where managers share it.
        targets: targets on which it is spawned; the others lack its hardware, or parts of it.
        stand_in: what takes its goals on the real target where it is not spawned there.
        kind: kind in the catalog, such as ``joint_trajectory``.
        behavior: what it does; a vendor's scaled variant is ``scaled_joint_trajectory``.
        plugin: type string for the controller manager.
        command_interfaces: full names that it claims on the mock, such as ``arm_elbow_joint/position``.
        on_real: what it claims and gets on the real target; None where that is the same.
        vendor: what the vendor of its device commands on real hardware; None where the catalog does not say.
        state_interfaces: full names that it reads.
        package: the ROS package of its plugin.
        declared: what the catalog says of its kind: parameters, topics, services.
        own_topics: those of the kind that it has with its parameters.
        calls: full name of a service that it answers → what a call does in the world.
        vendor_parameters: what the vendor tells it on real hardware, whatever the spec states.
        plugin_parameters: names of parameters that the plugin of a device's own controller has besides.
        parameters: everything that goes to its node, dots for nesting, in the types that it declares.
        written_parameters: those of them that stand under ``parameters:`` in the spec.
        action: fully qualified action name and its type, or None.
        path_tolerance, goal_tolerance: by joint, those without one left out; None where not stated.
    """

    manager: str
    label: str
    kind: str
    behavior: Behavior
    plugin: str
    namespace: str = ""
    targets: tuple[Target, ...] = TARGETS
    stand_in: StandIn | None = None
    package: Annotated[str, ELSEWHERE] = ""
    declared: Annotated[ControllerKind | None, ELSEWHERE] = None
    own_topics: Annotated[tuple[ControllerTopic, ...], ELSEWHERE] = ()
    calls: Annotated[Mapping[str, Effect], ELSEWHERE] = field(default_factory=dict)
    vendor_parameters: Annotated[Mapping[str, ParameterValue], ELSEWHERE] = field(default_factory=dict)
    plugin_parameters: Annotated[frozenset[str], ELSEWHERE] = frozenset()
    device: str | None = None
    joints: tuple[str, ...] = ()
    command_interfaces: tuple[str, ...]
    on_real: OnReal | None = None
    vendor: VendorCommand | None = None
    state_interfaces: tuple[str, ...] = ()
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)
    written_parameters: Annotated[Mapping[str, ParameterValue], ELSEWHERE] = field(default_factory=dict)
    active: bool
    client: str | None = None
    action: str | None = None
    action_type: str | None = None
    goal_time_s: float | None = None
    path_tolerance: Mapping[str, JointFigure] | None = None
    goal_tolerance: Mapping[str, JointFigure] | None = None
    on_violation: str = "abort_and_hold"
    update_rate_hz: float | None = None

    @property
    def full_name(self) -> str:
        """Fully qualified name of its node, with a leading slash."""
        return f"{self.namespace}/{self.name}"

    def claims(self, target: Target) -> tuple[str, ...]:
        """Return the full names of the command interfaces that it claims on ``mock`` or ``real``."""
        return self.command_interfaces if self.on_real is None or target != "real" else self.on_real.command_interfaces

    def parameters_on(self, target: Target) -> Mapping[str, ParameterValue]:
        """Return everything that goes to its node on ``mock`` or ``real``."""
        return self.parameters if self.on_real is None or target != "real" else self.on_real.parameters

    @property
    def all_claims(self) -> tuple[str, ...]:
        """What it claims on any target, each interface once."""
        return tuple(dict.fromkeys(name for target in self.targets for name in self.claims(target)))


@dataclass(frozen=True, slots=True, kw_only=True)
class ControllerSwitch(Entity):
    """A switch that the cell may make: deactivate, then activate."""

    activate: tuple[str, ...]
    deactivate: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ControllerManager(Entity):
    """One update loop; ``name`` is the key in the spec, its node is ``<namespace>/controller_manager``.

    ``host`` is the computer that runs it, empty where the cell names none.
    """

    update_rate_hz: float
    namespace: str = ""
    host: str = ""
    devices: tuple[str, ...] = ()
    controllers: tuple[Controller, ...]
    switches: tuple[ControllerSwitch, ...]

    @property
    def node(self) -> str:
        """Fully qualified name of its node, with a leading slash."""
        return f"{self.namespace}/controller_manager"

    def by_kind(self) -> Mapping[tuple[str, str | None], list[Controller]]:
        """Return the controllers of each kind and device."""
        controllers: dict[tuple[str, str | None], list[Controller]] = {}
        for controller in self.controllers:
            controllers.setdefault((controller.kind, controller.device), []).append(controller)
        return controllers


@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptedDevice:
    """A direct-SDK device that no controller drives and whose adapter takes trajectories.

    Args:
        action: full name of the action that takes them.
        state_topic: full name of the topic of its stamped state.
        node: full name of its own node.
        client: the one node that may command it.
        path_tolerance: distance of a joint from its command that ends a goal, rad or m.
    """

    device: str
    node: str
    joints: tuple[str, ...]
    action: str
    state_topic: str
    client: str | None
    command_period_s: float
    command_timeout_s: float
    stop_time_s: float
    goal_time_s: float
    path_tolerance: float
