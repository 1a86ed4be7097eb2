"""A simulated network, clock, adapter or joint has impossible figures.

A rehearsal over a network with negative latency, or with a clock that runs backwards, shows nothing about the cell.

Example that is reported:

```yaml
hosts:
  control_pc: {clock: {simulated_drift: 200000 ppm}}  # expect at simulated_drift
```

Example that is accepted:

```yaml
hosts:
  control_pc: {clock: {simulated_drift: 20 ppm}}
```

Fix: write figures that a real network, clock, adapter or joint can have.

Source:

- docs/principles.md#clocks-and-age
- docs/principles.md#direct-sdk
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from cellc.compiler.cell.cell import Cell
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule

DRIFT = 0.01
"""A hundred times what a quartz clock drifts."""

Bounded = tuple[YamlPath, float | None, float, float]
"""A figure at its place, with the least and the greatest value that it may have."""


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield simulated figures outside their range."""
    cell = graph.cell
    for path, written, least, greatest in (*_clocks(cell), *_networks(cell), *_adapters(cell), *_joints(cell)):
        if written is not None and not least <= written <= greatest:
            message = f"`{path[-1]}` must be {_range(least, greatest)}, got `{cell.text(*path)}`"
            yield found(graph, path, message)
    yield from _other_units(graph)


def _range(least: float, greatest: float) -> str:
    if greatest == inf:
        return "above 0" if least > 0.0 else "at least 0"
    return "between 0 % and 100 %" if least == 0.0 else "between -10000 ppm and 10000 ppm"


def _clocks(cell: Cell) -> Iterator[Bounded]:
    for host in cell.hosts.values():
        yield (*host.path, "clock", "simulated_drift"), host.clock.simulated_drift, -DRIFT, DRIFT
    for device in cell.devices:
        if device.stamp is not None:
            yield (*device.path, "stamp", "simulated_drift"), device.stamp.clock.simulated_drift, -DRIFT, DRIFT


def _networks(cell: Cell) -> Iterator[Bounded]:
    for interface in cell.interfaces:
        if interface.simulated is not None:
            figures, at = interface.simulated, (*interface.path, "simulated")
            yield (*at, "latency"), figures.latency_s, 0.0, inf
            yield (*at, "jitter"), figures.jitter_s, 0.0, inf
            yield (*at, "loss"), figures.loss, 0.0, 1.0
            yield (*at, "reordering"), figures.reordering, 0.0, 1.0


def _adapters(cell: Cell) -> Iterator[Bounded]:
    shortest_s = 1e-6  # a microsecond: shorter than any command period, and not zero
    for device in cell.devices:
        if device.adapter is not None:
            at = (*device.path, "adapter")
            yield (*at, "command_timeout"), device.adapter.command_timeout_s, shortest_s, inf
            yield (*at, "stop_time"), device.adapter.stop_time_s, shortest_s, inf
            yield (*at, "goal_time"), device.adapter.goal_time_s, shortest_s, inf
            allowed = device.adapter.path_tolerance
            yield (*at, "path_tolerance"), None if allowed is None else allowed.value, 1e-9, inf


def _joints(cell: Cell) -> Iterator[Bounded]:
    for device in cell.devices:
        for figures in device.simulated_joints:
            noise, velocity = figures.noise, figures.velocity
            yield (*figures.path, "lag"), figures.lag_s, 0.0, inf
            yield (*figures.path, "noise"), None if noise is None else noise.value, 0.0, inf
            # One that never moves is the fault `stick`.
            yield (*figures.path, "velocity"), None if velocity is None else velocity.value, 1e-9, inf


def _other_units(graph: CellGraph) -> Findings:
    """Yield lengths of joints that turn, and angles of joints that slide, once where they are said of all joints."""
    for device in graph.cell.devices:
        for figures in device.simulated_joints:
            joints = [device.joint(name) for name in figures.joints]
            for field, written in (("noise", figures.noise), ("velocity", figures.velocity)):
                linear = written is not None and written.linear
                other = next((joint for joint in joints if (joint.type == "prismatic") != linear), None)
                if written is not None and other is not None:
                    path = (*figures.path, field)
                    message = f"`{field}` is `{graph.cell.text(*path)}`, but `{other.name}` is {other.type}"
                    yield found(graph, path, message, "write a length where a joint slides, else an angle")
