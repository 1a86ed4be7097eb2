"""The robot is to hear of its payload by a service that it refuses until its program runs.

People release the brakes before they start the program. A robot in local mode takes a payload by service only while
the program runs, and answers before that without an error: the brakes open under a load that it does not know, and the
arm sags.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm, told_by: service}}  # expect at told_by
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm, told_by: installation}}
```

Fix: save the payload in the installation of the robot, or let its program be started in remote mode.

Source: https://github.com/UniversalRobots/Universal_Robots_Client_Library/blob/2.14.0/src/ur/ur_driver.cpp (2.14.0)
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield payloads set by a service that is missing, or is refused until after the brakes open."""
    for device in graph.cell.devices:
        if device.payload is None or device.payload.told_by != "service":
            continue
        path = (*device.path, "payload", "told_by")
        if not device.robot.payload_service:
            yield found(graph, path, f"no service tells `{device.name}` its payload")
        elif device.robot.ways and (device.program is None or device.program.mode == "local"):
            message = f"`{device.name}` is in local mode, and refuses a payload by service before its program runs"
            yield found(graph, path, message)
