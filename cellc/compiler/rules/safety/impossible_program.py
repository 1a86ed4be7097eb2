"""A robot's program is to be started in a way that its controller does not have.

A driver that sends and starts the program by itself needs remote control on most robots; in local mode it is refused
without a word, and a person who must press start in remote mode finds a button that does nothing. A device
without a program of its own has no program to start.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             program: {played_by: driver, mode: local}}  # expect at mode
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             program: {played_by: driver, mode: remote}}
```

Fix: choose a mode in which the robot lets its program be started that way.

Source: https://github.com/UniversalRobots/Universal_Robots_ROS2_Driver/releases/tag/6.0.0 (6.0.0): modes
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices whose controller has no such mode of starting a program."""
    for device in graph.cell.devices:
        program, modes = device.program, device.robot.ways
        if program is None:
            continue
        path = (*device.path, "program")
        starter = "driver" if program.played_by == "driver" else "person"
        if not modes:
            advice = "delete `program:`, or say under `robot.program` of its `device.yaml` who can start it"
            yield found(
                graph,
                path,
                f"`program` has no effect on `{device.name}`: its set points pass through no program",
                advice,
            )
        elif (starter, program.mode) not in modes:
            allowed = " or ".join(f"`{mode}`" for by, mode in modes if by == starter) or "no mode"
            message = f"a {starter} starts the program of `{device.name}` in {allowed}, got `{program.mode}`"
            yield found(graph, (*path, "mode"), message)
