"""A simulated network, clock, adapter or joint has figures that none can have.

A rehearsal over a network with negative latency, or with a clock that runs backwards, shows nothing about the cell.

Example that is reported:

```yaml
hosts:
  control_pc: {clock: {simulated_drift: 200000 ppm}}
```

Example that is accepted:

```yaml
hosts:
  control_pc: {clock: {simulated_drift: 20 ppm}}
```

Fix: latency and jitter from 0 s on, loss and reordering from 0 % to 100 %, drift within 10000 ppm either way; a
watchdog and a stop take longer than 0 s; a joint lags and errs by 0 or more, in the unit in which it moves.

Source: chapter 4, section 3: measure both offset and observation age; section 9: bounded commands and a watchdog.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from cellc.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule
from cellc.spec.cell_spec import CellSpec
from cellc.spec.devices import EVERY_JOINT
from cellc.spec.interfaces import TopicSpec
from cellc.spec.quantity import Quantity

DRIFT = 0.01
"""A hundred times what a quartz clock drifts."""

_LENGTHS = ("m", "c", "u")
"""How units of length begin; those of angle are deg and rad."""

Bounded = tuple[YamlPath, Quantity | None, float, float]
"""A figure at its place, with the least and the greatest value that it may have."""


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield simulated figures outside their range."""
    spec = graph.cell.spec
    for path, written, least, greatest in (*_clocks(spec), *_networks(spec), *_adapters(spec), *_joints(spec)):
        if written is not None and not least <= written.si <= greatest:
            message = f"`{path[-1]}` is `{written.text}`, which none can have"
            yield found(graph, path, message, "write a figure that a network, clock or device can have")
    yield from _other_units(graph)


def _clocks(spec: CellSpec) -> Iterator[Bounded]:
    for name, host in spec.hosts.items():
        yield ("hosts", name, "clock", "simulated_drift"), host.clock.simulated_drift, -DRIFT, DRIFT
    for name, device in spec.devices.items():
        if device.stamp is not None:
            yield ("devices", name, "stamp", "simulated_drift"), device.stamp.simulated_drift, -DRIFT, DRIFT


def _networks(spec: CellSpec) -> Iterator[Bounded]:
    for name, interface in spec.interfaces.items():
        figures = interface.simulated if isinstance(interface, TopicSpec) else None
        if figures is not None:
            at = ("interfaces", name, "simulated")
            yield (*at, "latency"), figures.latency, 0.0, inf
            yield (*at, "jitter"), figures.jitter, 0.0, inf
            yield (*at, "loss"), figures.loss, 0.0, 1.0
            yield (*at, "reordering"), figures.reordering, 0.0, 1.0


def _adapters(spec: CellSpec) -> Iterator[Bounded]:
    shortest_s = 1e-6  # a microsecond: shorter than any command period, and not zero
    for name, device in spec.devices.items():
        if device.adapter is not None:
            at = ("devices", name, "adapter")
            yield (*at, "command_timeout"), device.adapter.command_timeout, shortest_s, inf
            yield (*at, "stop_time"), device.adapter.stop_time, shortest_s, inf


def _joints(spec: CellSpec) -> Iterator[Bounded]:
    for name, device in spec.devices.items():
        for joint, figures in device.simulated_joints.items():
            at = ("devices", name, "simulated_joints", joint)
            yield (*at, "lag"), figures.lag, 0.0, inf
            yield (*at, "noise"), figures.noise, 0.0, inf
            yield (*at, "velocity"), figures.velocity, 1e-9, inf  # one that never moves is the fault `stick`


def _other_units(graph: CellGraph) -> Findings:
    """Yield lengths of joints that turn, and angles of joints that slide, once where they are said of all joints."""
    for device in graph.cell.devices:
        for key, figures in device.spec.simulated_joints.items():
            joints = [j for j in device.actuated_joints if key in (EVERY_JOINT, j.name.removeprefix(device.prefix))]
            for field, written in (("noise", figures.noise), ("velocity", figures.velocity)):
                linear = written is not None and written.unit.startswith(_LENGTHS)
                other = next((joint for joint in joints if (joint.type == "prismatic") != linear), None)
                if written is not None and other is not None:
                    message = f"`{field}` is `{written.text}`, but `{other.name}` is {other.type}"
                    path = ("devices", device.name, "simulated_joints", key, field)
                    yield found(graph, path, message, "write a length where a joint slides, else an angle")
