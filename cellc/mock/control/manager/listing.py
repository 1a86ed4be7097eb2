"""Answers of the list services, with the fields of controller_manager_msgs."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.manager.hardware_set import HardwareSet
from cellc.mock.control.manager.registry import ControllerRegistry


@dataclass(frozen=True, slots=True)
class ChainConnection:
    """controller_manager_msgs/ChainConnection."""

    name: str
    reference_interfaces: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ControllerState:
    """controller_manager_msgs/ControllerState."""

    name: str
    state: str
    type: str
    is_async: bool
    update_rate: int
    claimed_interfaces: tuple[str, ...]
    required_command_interfaces: tuple[str, ...]
    required_state_interfaces: tuple[str, ...]
    is_chainable: bool
    is_chained: bool
    exported_state_interfaces: tuple[str, ...]
    reference_interfaces: tuple[str, ...]
    chain_connections: tuple[ChainConnection, ...]


@dataclass(frozen=True, slots=True)
class HardwareInterface:
    """controller_manager_msgs/HardwareInterface."""

    name: str
    data_type: str
    is_available: bool
    is_claimed: bool


@dataclass(frozen=True, slots=True)
class HardwareComponentState:
    """controller_manager_msgs/HardwareComponentState."""

    name: str
    type: str
    is_async: bool
    rw_rate: int
    plugin_name: str
    state: str
    command_interfaces: tuple[HardwareInterface, ...]
    state_interfaces: tuple[HardwareInterface, ...]


@dataclass(frozen=True, slots=True)
class HardwareInterfaces:
    """The answer of list_hardware_interfaces."""

    command_interfaces: tuple[HardwareInterface, ...]
    state_interfaces: tuple[HardwareInterface, ...]


class Listing:
    """Lists controllers, components and interfaces.

    Args:
        registry: the controllers.
        hardware: the components, None where the description was refused.
        table: the interfaces.
        rate: rate of the manager (Hz).
    """

    def __init__(
        self, registry: ControllerRegistry, hardware: HardwareSet | None, table: InterfaceTable, rate: int
    ) -> None:
        self._registry = registry
        self._hardware = hardware
        self._table = table
        self._rate = rate

    def controllers(self) -> tuple[ControllerState, ...]:
        """All loaded controllers, in the order of their loading."""
        return tuple(self._controller(name) for name in self._registry.controllers)

    def _controller(self, name: str) -> ControllerState:
        loaded = self._registry.controllers[name]
        configured = loaded.state in ("inactive", "active")
        controller = loaded.controller
        references = controller.reference_interfaces() if configured else ()
        commands = controller.command_interfaces() if configured else ()
        claimed = tuple(claim for claim in loaded.claims if self._is_available(claim))
        return ControllerState(
            name,
            loaded.state,
            loaded.type,
            False,
            loaded.rate,
            claimed,
            commands,
            controller.state_interfaces() if configured else (),
            bool(references),
            loaded.chained,
            references,
            tuple(reference.split("/", 1)[1] for reference in references),
            self._connections(commands),
        )

    def _connections(self, commands: tuple[str, ...]) -> tuple[ChainConnection, ...]:
        found: dict[str, list[str]] = {}
        for command in commands:
            exporter = self._registry.exporter(command)
            if exporter is not None:
                found.setdefault(exporter.name, []).append(command)
        return tuple(ChainConnection(name, tuple(references)) for name, references in found.items())

    def _is_available(self, interface: str) -> bool:
        exporter = self._registry.exporter(interface)
        if exporter is not None:
            return exporter.state == "active"
        return self._hardware is not None and self._hardware.is_available(interface)

    def _exists(self, interface: str) -> bool:
        if self._registry.exporter(interface) is not None:
            return True
        return self._hardware is not None and self._hardware.owner(interface) is not None

    def _interface(self, name: str, command: bool) -> HardwareInterface:
        available = self._is_available(name)
        claimed = command and available and name in self._table.claims
        return HardwareInterface(name, self._table.data_type(name), available, claimed)

    def interfaces(self) -> HardwareInterfaces:
        """All interfaces, by name."""
        commands = [name for name in sorted(self._table.command_names()) if self._exists(name)]
        states = [name for name in sorted(self._table.state_names()) if self._exists(name)]
        return HardwareInterfaces(
            tuple(self._interface(name, True) for name in commands),
            tuple(self._interface(name, False) for name in states),
        )

    def components(self) -> tuple[HardwareComponentState, ...]:
        """All components, in the order of the description."""
        found = [] if self._hardware is None else list(self._hardware.components.values())
        return tuple(
            HardwareComponentState(
                component.name,
                component.system.info.type,
                component.system.info.is_async,
                component.system.info.rw_rate or self._rate,
                component.system.info.plugin,
                component.state,
                tuple(self._interface(name, True) for name in component.system.command_names),
                tuple(self._interface(name, False) for name in component.system.state_names),
            )
            for component in found
        )
