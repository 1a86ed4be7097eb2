"""A program that a device runs on the mock may reach hardware.

A node of `device.yaml` with `provides: every_target` starts on the mock too, and the mock has no gate. A
driver's own program may open the connection of its device, and the cell moves unexpectedly. Transforms
and the description of the robot reach no device; of another program somebody says so in the spec, by name and with a
date.

Example that is reported:

```yaml
mock_programs:
  bare_arm_driver/status: {touches_no_hardware: true, by: controls}
devices:
  side_arm: {model: ./own_program_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
mock_programs:
  bare_arm_driver/status: {touches_no_hardware: true, by: controls, date: 2026-07-01}
devices:
  side_arm: {model: ./own_program_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: write `provides: real` in `device.yaml`, or state under `mock_programs` who says that the program touches no
hardware, and when.

Source: docs/principles.md#mock-and-real
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices that run a program on the mock without a statement that it touches no hardware."""
    for device in graph.cell.devices:
        for program in graph.cell.programs_on_mock(device):
            if program not in graph.cell.harmless_programs:
                message = (
                    f"`{device.name}` runs `{program}` on the mock, without a statement that it touches no hardware"
                )
                yield found(graph, ("devices", device.name, "model"), message)
