"""How the outputs of switched devices of a first spec are wired, each to a signal of an I/O device of the cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.catalog.device_interfaces import counted
from cellc.compiler.catalog.device_model import DeviceModel

Signal = tuple[str, str, str]
"""Device, gpio and interface."""
Wires = Mapping[str, Mapping[str, Signal]]
"""Switched device → its output → what drives it."""


def wires_of(models: Mapping[str, DeviceModel]) -> Wires:
    """Return the wires of the switched devices, as far as the I/O devices of the cell have signals."""
    signals, wires = _signals(models), dict[str, dict[str, Signal]]()
    for name, model in models.items():
        for output in () if model.switched is None else model.switched.outputs:
            signal = next(signals, None)
            if signal is not None:
                wires.setdefault(name, {})[output] = signal
    return wires


def without_signal(models: Mapping[str, DeviceModel]) -> tuple[str, ...]:
    """Name the switched devices that have an output without a signal of the cell."""
    wires = wires_of(models)
    switched = {name: model.switched for name, model in models.items() if model.switched is not None}
    return tuple(
        name for name, switched_facts in switched.items() if len(switched_facts.outputs) > len(wires.get(name, ()))
    )


def switching(outputs: Mapping[str, Signal]) -> str:
    """Return what the spec has under ``switching`` of a device."""
    wired = (f"{output}: {'/'.join(signal)}" for output, signal in outputs.items())
    return f"{{outputs: {{{', '.join(wired)}}}}}"


def outputs_controller(device: str, wires: Wires) -> Iterator[str]:
    """Yield the controller of an I/O device that writes the outputs which are wired to it."""
    driven: dict[str, list[str]] = {}
    for outputs in wires.values():
        for owner, gpio, interface in outputs.values():
            if owner == device:
                driven.setdefault(gpio, []).append(interface)
    if driven:
        gpios = ", ".join(f'"{{prefix}}{gpio}"' for gpio in driven)
        interfaces = ", ".join(
            f'"command_interfaces.{{prefix}}{gpio}.interfaces": [{", ".join(names)}]' for gpio, names in driven.items()
        )
        yield f"{device}_outputs:"
        yield "  type: gpio_command"
        yield f"  device: {device}"
        yield f"  parameters: {{gpios: [{gpios}], {interfaces}}}"


def _signals(models: Mapping[str, DeviceModel]) -> Iterator[Signal]:
    """Yield the interfaces of I/O devices that are set."""
    for name, model in models.items():
        if model.kind == "io" and model.control is not None:
            for gpio, group in model.control.gpios.items():
                yield from ((name, gpio, text) for text in counted(group.command))
