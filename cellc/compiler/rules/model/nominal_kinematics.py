"""A robot has nominal kinematics, or no owner confirms its calibration.

No two robots of a type are alike: with nominal kinematics the tool is off by up to centimeters, and a camera or fixture
that was measured with it as well. The vendor's driver compares one number, says so in one line of its log, and runs.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./measured_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             calibration: {file: measured_arm/side_arm.yaml, measured: 2026-07-01, owner: UNKNOWN}}  # expect at owner
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./measured_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             calibration: {file: measured_arm/side_arm.yaml, measured: 2026-07-01, owner: robot}}
```

Fix: read the kinematics of this robot with the vendor's tool, and record its file, date and owner.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.kinematics import KinematicCalibration, Kinematics
from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.pins import day_of


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices whose kinematics are nominal, or those of a file without a day or an owner."""
    for device in graph.cell.devices:
        kinematics = device.kinematics
        if kinematics is not None:
            one = kinematics.calibration
            problems = _nominal(device, kinematics) if one is None else _unvouched(one, kinematics)
            for field, message in problems:
                yield found(graph, (*device.path, "calibration", *field), message)


def _nominal(device: Device, kinematics: Kinematics) -> Iterator[tuple[tuple[str, ...], str]]:
    yield (), f"`{device.name}` has the kinematics of its type; `{kinematics.tool}` reads its own"


def _unvouched(one: KinematicCalibration, kinematics: Kinematics) -> Iterator[tuple[tuple[str, ...], str]]:
    if one.hash == kinematics.nominal_hash:
        yield ("file",), f"`{one.name}` holds the kinematics of the type, by its hash `{one.hash}`"
    if one.owner == UNKNOWN:
        yield ("owner",), f"`{one.name}` has no owner"
    if day_of(one.measured) is None:
        yield ("measured",), f"`measured` of `{one.name}` must be a date, got `{one.measured}`"
