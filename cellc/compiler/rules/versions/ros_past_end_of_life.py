"""The ROS distribution had reached its end of life when the cell was measured.

No security fixes and no driver releases come any more. The cell's date is that of its latest calibration: a check
must not change its answer with the clock of the machine that runs it. A date that does not belong to the others is a
finding of its own, and says nothing of the distribution.

Example that is reported:

```yaml
versions: {os: ubuntu 22.04, ros: humble, rmw: rmw_fastrtps_cpp 6.2.10, ros2_control: 2.54.0,  # expect at ros
           moveit: 2.5.9}
calibrations:
  hand_eye: {measured: 2027-09-01}
  tcp: {measured: 2027-09-01}
  fixture_a: {measured: 2027-09-01}
devices: {arm: {driver: demo_arm_driver 2.14.0, sdk: null, description: null}}  # expect: unknown-version at arm
```

Example that is accepted:

```yaml
calibrations:
  fixture_a: {measured: 2026-09-01}
```

Fix: plan the move to a supported distribution, away from the operating cell.

Source:

- https://www.ros.org/reps/rep-2000.html (as of 2025-10-24)
- https://endoflife.date/ros-2 (as of 2026-08-22)
- docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.graph.versions import distribution
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=("calibration-of-another-time",))
def check(graph: CellGraph) -> Findings:
    """Yield a distribution whose end of life lies before the latest calibration."""
    facts = distribution(graph.cell)
    measured = [c.measured_on for c in graph.cell.calibrations.values() if c.measured_on is not None]
    if facts is None or not measured:
        return
    date, end = max(measured).isoformat(), str(facts.end_of_life)
    if date > end:
        message = f"`{graph.cell.distro}` reached its end of life on {end}, before the calibration of {date}"
        yield found(graph, ("versions", "ros"), message)
