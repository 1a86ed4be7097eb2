"""Binds devices that digital outputs switch: their outputs and sensors to gpios of the cell, and the state at power-up.

An output or sensor that is wired to nothing is left to a rule, and so is what becomes of a part without power.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from cellc.compiler.catalog.device_model import SwitchedFacts
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.switched import Switched, SwitchedState
from cellc.compiler.link.devices import BoundDevice
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.devices import DeviceSpec, SwitchingSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, YamlPath
from cellc.contract.frozen import dataclass

_SENSED_WITHIN_S = 1.0


@dataclass(frozen=True, slots=True)
class _Gpios:
    """What outputs and sensors may be wired to: names as the spec writes them → full names of interfaces."""

    command: Mapping[str, str]
    state: Mapping[str, str]
    document: SourceDocument


def link_switched(
    spec: CellSpec, document: SourceDocument, bound: tuple[BoundDevice, ...]
) -> Outcome[tuple[BoundDevice, ...]]:
    """Return the devices with how each is switched."""
    devices = [device.device for device in bound]
    gpios = _Gpios(dict(_interfaces(devices, "command")), dict(_interfaces(devices, "state")), document)
    linked: list[BoundDevice] = []
    problems: list[Diagnostic] = []
    for device in bound:
        outcome = _switched(device, spec.devices[device.device.name], gpios)
        problems += outcome.diagnostics
        linked.append(replace(device, device=replace(device.device, switched=outcome.value)))
    return Outcome(tuple(linked), tuple(problems))


def _interfaces(devices: Iterable[Device], which: str) -> Iterator[tuple[str, str]]:
    """Yield what the gpios of all devices offer; ``which`` is command or state."""
    for device in devices:
        for group in () if device.control.hardware is None else device.control.hardware.gpios:
            names = group.command_interfaces if which == "command" else group.state_interfaces
            for name in names:
                yield f"{device.name}/{group.name.removeprefix(device.body.prefix)}/{name}", f"{group.name}/{name}"


def _switched(one: BoundDevice, written: DeviceSpec, gpios: _Gpios) -> Outcome[Switched]:
    facts, wiring = one.facts.switched, written.switching or SwitchingSpec()
    path = (*one.device.path, "switching")
    named = (("outputs", wiring.outputs, gpios.command), ("inputs", wiring.inputs, gpios.state))
    problems = [
        problem
        for key, wires, known in named
        for problem in _unknown(wires, () if facts is None else _signals(facts, key), known, gpios, (*path, key))
    ]
    if facts is None:
        if written.switching is not None and not problems:
            problems.append(unknown_name("unknown-signal", "switching", "output or sensor", (), gpios.document, path))
        return Outcome(None, tuple(problems))
    if wiring.starts is not None and wiring.starts not in facts.states:
        at = (*path, "starts")
        problems.append(unknown_name("unknown-state", wiring.starts, "state", facts.states, gpios.document, at))
    inputs = {name: gpios.state[wire] for name, wire in wiring.inputs.items() if wire in gpios.state}
    switched = Switched(
        states={
            name: SwitchedState(
                outputs=dict(state.outputs),
                sensors={sensor: value for sensor, value in state.sensors.items() if sensor in inputs},
            )
            for name, state in facts.states.items()
        },
        signals=facts.outputs,
        starts=wiring.starts or _at_rest(facts),
        outputs={name: gpios.command[wire] for name, wire in wiring.outputs.items() if wire in gpios.command},
        inputs=inputs,
        time_s=si(wiring.time) or 0.0,
        within_s=_SENSED_WITHIN_S if wiring.within is None else wiring.within.si,
        holds=facts.holds,
        power_lost=wiring.power_lost,
        accepted_by=wiring.accepted_by,
    )
    return Outcome(switched, tuple(problems))


def _signals(facts: SwitchedFacts, key: str) -> tuple[str, ...]:
    return facts.outputs if key == "outputs" else facts.sensors


def _at_rest(facts: SwitchedFacts) -> str:
    """Return the first state with every output off, else the first."""
    off = (name for name, state in facts.states.items() if not any(state.outputs.values()))
    return next(off, next(iter(facts.states)))


def _unknown(
    wires: Mapping[str, str], signals: tuple[str, ...], known: Mapping[str, str], gpios: _Gpios, path: YamlPath
) -> Iterator[Diagnostic]:
    kind = "output" if path[-1] == "outputs" else "sensor"
    offered = "command" if path[-1] == "outputs" else "state"
    for name, wire in wires.items():
        if name not in signals:
            yield unknown_name("unknown-signal", name, kind, signals, gpios.document, (*path, name))
        if wire not in known:
            interface = f"{offered} interface"
            yield unknown_name("unknown-signal", wire, interface, known, gpios.document, (*path, name))
