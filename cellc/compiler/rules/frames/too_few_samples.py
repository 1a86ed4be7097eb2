"""A calibration rests on too few samples.

A transform has six unknowns. Three hand-eye samples leave nothing over to tell a good result from a bad one, and the
residual of a fit without redundancy is small by construction.

Example that is reported:

```yaml
calibrations:
  hand_eye: {samples: 3}  # expect at samples
```

Example that is accepted:

```yaml
calibrations:
  hand_eye: {samples: 40}
```

Fix: measure again: at least 10 poses for a camera, and 3 points for anything else.

Source: https://www.mvtec.com/doc/halcon/2111/en/calibrate_hand_eye.html
(21.11): three poses are the least, at least ten are recommended
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_CAMERA = 10
_OTHER = 3


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations below the number of samples that what rests on them needs."""
    cameras = {device.name for device in graph.cell.devices if device.kind == "camera"}
    for calibration in graph.cell.calibrations.values():
        users = [frame for frame in graph.cell.frames if frame.calibration == calibration.name]
        least = _CAMERA if any(user.device in cameras for user in users) else _OTHER
        if users and calibration.samples is not None and calibration.samples < least:
            what = "that of a camera" if least == _CAMERA else "any"
            message = f"calibration `{calibration.name}` must rest on at least {least} samples as {what},"
            yield found(graph, (*calibration.path, "samples"), f"{message} got {calibration.samples}")
