"""Cells beside each other: what motion rests on in each, and who has which duty by the architecture of its devices.

The questions are those of chapter 4, sections 8 and 9: two robots take the same trajectory under different contracts,
and a device that is commanded past ROS 2 takes duties back. Every answer comes from the spec and the catalog.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.deploy.labels import real_driver, watchdogs
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.graph.versions import compatibility
from cellc.contract.diagnostics.wording import count
from cellc.contract.vocabulary import PASSIVE, UNKNOWN, CommandAuthority, Motion

_NOT_STATED = "not stated"


@dataclass(frozen=True, slots=True)
class Row:
    """A question, and what each cell answers; ``common`` is what holds of every robot alike."""

    question: str
    answers: tuple[tuple[str, ...], ...]
    common: str

    @property
    def same(self) -> bool:
        """Whether all cells answer alike."""
        return len(set(self.answers)) == 1


@dataclass(frozen=True, slots=True)
class Comparison:
    """Cells by the name that each is distinguished by: the contract of motion, and the duties."""

    cells: tuple[str, ...]
    motion: tuple[Row, ...]
    duties: tuple[Row, ...]


def compare(named: Mapping[str, Cell]) -> Comparison:
    """Put cells beside each other, each under the name that it is distinguished by."""
    compared = tuple(named.values())
    return Comparison(
        tuple(named),
        tuple(_row(compared, *asked) for asked in _MOTION),
        tuple(_row(compared, *asked) for asked in _DUTIES),
    )


def _row(cells: tuple[Cell, ...], question: str, answer: Callable[[Cell], Iterator[str]], common: str) -> Row:
    return Row(question, tuple(tuple(answer(cell)) for cell in cells), common)


def _moving(cell: Cell) -> tuple[Device, ...]:
    return tuple(device for device in cell.devices if device.actuated_joints)


def _start(cell: Cell) -> Iterator[str]:
    for device in _moving(cell):
        hardware, program = device.control.hardware, device.robot.program
        is_loaded = hardware is not None and "real" in hardware.targets
        state = f", starts {device.control.startup_state}" if is_loaded else ""
        yield f"{device.name}: {real_driver(device)}{state}"
        if program is not None:
            yield f"{device.name}: its program is started by {program.played_by}, {program.mode}"
        effects = {} if hardware is None else hardware.effects
        for moment, effect in effects.items():
            if effect.motion is not Motion.NONE or effect.authority is CommandAuthority.TAKEN:
                yield f"{device.name}: {moment.value}: {_effect(effect)}"
        if device.control.unknown_effects:
            yield f"{device.name}: not stated: what {' and '.join(device.control.unknown_effects)} does"


def _effect(effect: Effect) -> str:
    moves = {Motion.NONE: "nothing moves", Motion.UNKNOWN: "UNKNOWN motion"}.get(effect.motion, effect.motion.value)
    taken = ", takes command" if effect.authority is CommandAuthority.TAKEN else ""
    return f"{moves}{taken}: {effect.does}"


def _timing(cell: Cell) -> Iterator[str]:
    for manager in cell.managers:
        host = cell.hosts.get(manager.host)
        where = "an unnamed computer" if host is None else f"{manager.host} ({host.scheduling})"
        yield f"{manager.node}: {shortest(manager.update_rate_hz)} Hz on {where}"
    for adapted in cell.adapters:
        period, timeout = shortest(adapted.command_period_s), shortest(adapted.command_timeout_s)
        yield f"{adapted.device}: its adapter sends every {period} s, and stops after {timeout} s without commands"
    for device in _moving(cell):
        if device.control.hardware is not None and device.control.hardware.command_timeout_s is not None:
            timeout = shortest(device.control.hardware.command_timeout_s)
            yield f"{device.name}: stops its motion after {timeout} s without commands"
        if device.site.network is not None:
            link = "a dedicated link" if device.site.network.dedicated_link else "any link"
            yield f"{device.name}: {link}, real-time kernel {device.site.network.realtime.replace('_', ' ')}"
        if device.kind == "arm":
            scaled = (
                f"slowed down by {device.control.speed_scaling}"
                if device.control.speed_scaling
                else "as planned or are aborted"
            )
            yield f"{device.name}: trajectories run {scaled}"


def _safety(cell: Cell) -> Iterator[str]:
    stop, recovery = cell.safety.stop, cell.safety.recovery
    independent = ", ".join(stop.independent_of) or _NOT_STATED
    yield f"stopped by {stop.authority}, {stop.path}, independent of {independent}"
    yield f"acknowledged by {recovery.acknowledge}; after a reconnect: {recovery.on_reconnect}"
    for device in _moving(cell):
        stops = ", ".join(state.name for state in device.procedures.safety.states if state.stops) or UNKNOWN
        yield f"{device.name}: stops by itself in {stops}"
        if device.procedures.safety.modes:
            yield f"{device.name}: modes {', '.join(device.procedures.safety.modes)}"


def _versions(cell: Cell) -> Iterator[str]:
    moving = {cell.name, *(device.name for device in _moving(cell))}
    for judged in compatibility(cell):
        if judged.pin.holder in moving:
            pinned = f"{judged.pin.text}: {judged.answer.value}" if judged.pin.known else "is not pinned"
            yield f"{judged.pin.holder}: {judged.pin.part} {pinned}"


def _mock_limit(cell: Cell) -> Iterator[str]:
    for device in _moving(cell):
        yield from (f"{device.name}: {text}" for text in device.mock.mock_cannot_prove)


_MOTION = (
    ("start command", _start, "an observed state diagram"),
    ("timing", _timing, "measured rate, jitter and missed cycles"),
    ("safety", _safety, "a signed procedure for enabling, stop and recovery"),
    ("versions", _versions, "the same tuple on every machine"),
    ("what the mock cannot prove", _mock_limit, "a list of untested physics and safety"),
)
"""Question, answer, and what is evidence of it on every robot."""


def _discovery(cell: Cell) -> Iterator[str]:
    network, count = cell.network, len(cell.interfaces)
    discovery = f"{network.discovery} discovery in domain {network.domain_id}"
    yield f"ROS 2: {count} interfaces with types, {discovery}, {cell.versions.rmw_name}"
    for device in _moving(cell):
        if device.architecture == "direct_sdk":
            address = None if device.site.connection is None else device.site.connection.address
            yield f"{device.name}: the application knows the address {address or _NOT_STATED}; no graph shows it"


def _frames(cell: Cell) -> Iterator[str]:
    publishers = sorted({frame.authority for frame in cell.frames})
    yield f"one TF tree of {len(cell.frames)} frames, of {', '.join(publishers)}"
    yield f"owner {cell.owners.responsibilities.frames}"


def _records(cell: Cell) -> Iterator[str]:
    clocks = sorted({host.clock.domain for host in cell.hosts.values()})
    yield f"clocks {', '.join(clocks) or _NOT_STATED}; {len(cell.recording.attempt_fields)} fields of every attempt"
    for device in _moving(cell):
        if device.architecture != "ros2":
            yield f"{device.name}: no bag has the data of its own loop; only its library can log it"
    yield f"owner {cell.owners.responsibilities.logging}"


def _ownership(cell: Cell) -> Iterator[str]:
    for controller in _commanding(cell):
        counted = count(len(controller.claims("real")), "command interface")
        yield f"{controller.label}: claims {counted}, commanded by {controller.client or 'no client'}"
    for device in _driven(cell):
        yield f"{device.name}: no controller claims it, {real_driver(device)} takes goals"
    for adapted in cell.adapters:
        yield f"{adapted.device}: {adapted.action} of its adapter, commanded by {adapted.client or 'no client'}"
    yield f"owner {cell.owners.responsibilities.command}"


def _servo(cell: Cell) -> Iterator[str]:
    driven = {device.name for device in _driven(cell)}
    for device in _moving(cell):
        loop = "its own node must meet the deadline" if device.name in driven else _LOOP[device.architecture]
        yield f"{device.name} ({device.architecture}): {loop}"
    for controller in _commanding(cell):
        yield f"{controller.label}: watchdog: {watchdogs(cell, controller)}"
    yield f"owner {cell.owners.responsibilities.watchdogs}"


_LOOP = {
    "ros2": "every command passes the controller manager; the computer meets its deadline or misses it",
    "direct_sdk": "the application's own process must provide deadline, watchdog and stop",
    "hybrid": "the vendor's loop must meet the deadline; ROS 2 sends goals and reads states",
}


def _boundary(cell: Cell) -> Iterator[str]:
    owners = cell.owners.responsibilities
    yield f"vendor's safety: {owners.vendor_safety}; physical stop: {owners.physical_stop}, {cell.safety.stop.path}"


def _commanding(cell: Cell) -> Iterator[Controller]:
    commanding = (
        controller
        for controller in cell.controllers
        if controller.behavior not in PASSIVE and "real" in controller.targets
    )
    return (controller for controller in commanding if controller.claims("real"))


def _driven(cell: Cell) -> Iterator[Device]:
    """Yield the devices that a node of their vendor moves on real hardware."""
    adapted = {adapter.device for adapter in cell.adapters}
    return (device for device in _moving(cell) if device.control.driver is not None and device.name not in adapted)


_DUTIES = (
    (
        "discovery and types",
        _discovery,
        "ROS 2 has a graph and types; a direct SDK has the configuration of the application",
    ),
    ("frames", _frames, "ROS 2 has TF and stamps; a direct SDK has its own library; both need one authority"),
    ("time and records", _records, "ROS 2 has clocks, bags and diagnostics; a direct SDK has its own logger"),
    ("command ownership", _ownership, "ROS 2 has claims and actions; a direct SDK has its own state machine"),
    (
        "servo deadline",
        _servo,
        "neither is real-time by itself; measure it, in the vendor's loop or in a qualified one",
    ),
    ("safety", _boundary, "authority of the robot and the cell, on a separate path, in every architecture"),
)
"""Duty, who has it in the cell, and what the architectures bring."""
