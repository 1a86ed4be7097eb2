"""Two controllers are active together, but the driver of their device runs only one of their modes at a time.

No claim collides: one holds joints, the other a gpio of the same driver. The driver looks at both as the switch is
prepared and refuses it, or takes one of them without a word. It shows the first time that the switch is needed.

Example that is reported:

```yaml
control:
  controllers:
    arm_guiding: {type: hand_guiding, device: arm, client: task, active: false}
  switches:
    to_guiding: {activate: [arm_guiding]}  # expect at to_guiding
    back: {deactivate: [arm_guiding]}
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_guiding: {type: hand_guiding, device: arm, client: task, active: false}
  switches:
    to_guiding: {activate: [arm_guiding], deactivate: [arm_trajectory]}
    back: {activate: [arm_trajectory], deactivate: [arm_guiding]}
```

Fix: deactivate one in the switch that activates the other.

Source: https://github.com/UniversalRobots/Universal_Robots_ROS2_Driver/releases/tag/3.8.0 (3.8.0)
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.graph.claims import ControlState
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("own-motion-at-start", "double-claim-after-switch", "two-interfaces-of-one-joint"))
def check(graph: CellGraph) -> Findings:
    """Yield the switch that leads to two controllers whose command modes exclude each other, once for a pair."""
    seen: set[tuple[str, str, str]] = set()
    for state in graph.claims.states:
        for first, second, device, modes in _refused(graph.cell, state):
            pair = (state.manager, first.name, second.name)
            if pair in seen:
                continue
            seen.add(pair)
            manager = next(manager for manager in graph.cell.managers if manager.name == state.manager)
            path = (*manager.path, "switches", state.switches[-1]) if state.switches else second.path
            way = " → ".join(f"`{name}`" for name in ("start", *state.switches))
            message = f"after {way} both `{first.name}` and `{second.name}` are active, but `{device}` takes {modes}"
            related = (Related("one is here", first.span), Related("the other is here", second.span))
            yield found(graph, path, message, f"deactivate `{first.name}` in the same switch", related)


def _refused(cell: Cell, state: ControlState) -> Iterator[tuple[Controller, Controller, str, str]]:
    """Yield pairs of active controllers that no driver runs together, with the device and its two modes."""
    claiming: dict[str, dict[str, Controller]] = {}
    for controller in state.active:
        for claim in controller.claims("real") if "real" in controller.targets else ():
            claiming.setdefault(claim.rpartition("/")[0], {})[controller.label] = controller
    order = {controller.label: number for number, controller in enumerate(state.active)}
    for device in cell.devices:
        modes = None if device.hardware is None else device.hardware.modes
        if modes is None:
            continue
        joints = {joint.name for joint in device.joints}
        ours = {label for owner in (*joints, *modes.names) for label in claiming.get(owner, ())}
        active = [state.active[number] for number in sorted(order[label] for label in ours)]
        taken = [(controller, modes.of(controller.claims("real"), joints)) for controller in active]
        for (first, own), (second, others) in combinations(taken, 2):
            refused = ((a, b) for a in sorted(own) for b in sorted(others) if not modes.allow(a, b))
            if (pair := next(refused, None)) is not None:
                yield first, second, device.name, f"`{pair[0]}` or `{pair[1]}`"
