"""A combination is in no version matrix.

No source says that it works, and none that it does not. It stays UNKNOWN until a test of this tuple says so.

What was released together is a combination that somebody tested, the newest or not: the versions of one sync of the
distribution, or those with which a vendor's own release is built. A device is one finding, which names the nearest.

Example that is reported:

```yaml
devices: {arm: {driver: demo_arm_driver 3.1.0}}  # expect at driver
```

Example that is accepted:

```yaml
devices: {arm: {driver: demo_arm_driver 3.8.0}}
```

Fix: pin a version of the matrix, or test the tuple on the mock and with drives disabled, and keep the evidence.

Source:

- docs/principles.md#pinned-versions
- https://github.com/ros/rosdistro (as of 2026-08-22): a tag of each sync, such as jazzy/2025-09-19
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.releases import differing, foreign_lines, nearest_release, own_release, shared_parts, unlisted
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices with packages that no row has and no release has together; those of another line are an error."""
    distro = graph.cell.distro
    for device in graph.cell.devices:
        odd = [part for part in unlisted(device, distro) if not foreign_lines(device, part, distro)]
        if not odd or own_release(device, distro) is not None:
            continue
        near = nearest_release(device, distro)
        parts = odd if near is None else [*differing(device, near)] or odd
        known = _known(device, odd[0], distro)
        if near is not None:
            *first, last = [f"{part} {version}" for part, version in shared_parts(device, near).items()]
            known = f"{' and '.join((', '.join(first), last)) if first else last} in {near.name}, the nearest"
        texts = " and ".join(f"`{device.versions.part(part)}`" for part in parts)
        message = f"{texts} of `{device.name}` must be in the matrix of {distro}, which knows {known}"
        places = [(*device.path, part) for part in parts]
        related = tuple(Related("this version differs too", graph.cell.locate(*place)) for place in places[1:])
        yield found(graph, places[0], message, related=related)


def _known(device: Device, part: str, distro: str) -> str:
    rows = [row for row in device.version_rows if row.part == part and row.distro in (None, distro)]
    return ", ".join(sorted({name for row in rows for name in row.known})) or "none"
