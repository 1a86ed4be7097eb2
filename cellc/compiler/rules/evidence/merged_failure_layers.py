"""A rehearsal expects the failure of another layer than it provokes.

A lost transform that ends as stale state, or one that ends in a mere timeout, does not show which layer failed. The
outcomes are kept apart so that each names its cause; a timeout is the outcome of what answers or moves no more.

Example that is reported:

```yaml
rehearsals:
  lost_frame: {use: pick_and_place, inject: {drop_frame: object, at: 0 s}, expect: timeout}  # expect at expect
```

Example that is accepted:

```yaml
rehearsals:
  lost_frame: {use: pick_and_place, inject: {drop_frame: object, at: 0 s}, expect: tf_failure}
```

Fix: expect the outcome of the layer that the injected fault hits, or `succeeded` where the cell should tolerate it.

Source: docs/principles.md#layers-of-failure
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LAYERS = {
    "freeze": ("stale_state",),
    "delay": ("stale_state",),
    "drop_frame": ("tf_failure",),
    "double_frame": ("tf_failure",),
    "jump_clock": ("stale_state", "tf_failure"),
    "mismatch_qos": ("stale_state", "tf_failure", "timeout"),
    "unresponsive": ("timeout",),
    "unreachable": ("planning_failure",),
    "reject": ("goal_rejection", "stale_state"),  # the latter of a broadcaster
    "cancel": ("cancelled",),
    "second_commander": ("wrong_owner",),
    "switch": ("wrong_owner", "goal_rejection"),
    "stick": ("tolerance_violation",),
    "slow": ("tolerance_violation", "timeout"),
    "displace": ("tolerance_violation",),
    "scale_speed": ("timeout",),
    "skip_cycles": ("missed_cycle",),
    "wrong_payload": ("protective_stop",),
    "protective_stop": ("protective_stop",),
    "emergency_stop": ("emergency_stop",),
    "restart_driver": ("hardware_fault",),
    "cut_network": ("hardware_fault", "stale_state"),
    "program_stop": ("claim_failure", "timeout"),  # the latter where nothing watches the program
    "program_start": ("claim_failure", "uncommanded_motion"),
    "jog": ("claim_failure", "uncommanded_motion"),
    "stale_set_points": ("claim_failure", "uncommanded_motion"),
    "brakes_closed": ("claim_failure", "protective_stop"),
    "silent_sensor": ("timeout",),
}


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield rehearsals that expect a failure which belongs to none of their faults."""
    for rehearsal in graph.cell.rehearsals:
        layers = [layer for fault in rehearsal.faults for layer in _LAYERS[fault.kind]]
        if layers and rehearsal.expect != "succeeded" and rehearsal.expect not in layers:
            faults = " and ".join(f"`{fault.kind}`" for fault in rehearsal.faults)
            message = f"`{rehearsal.name}` injects {faults} but expects `{rehearsal.expect}`"
            fitting = " or ".join(f"`{layer}`" for layer in dict.fromkeys(layers))
            yield found(graph, (*rehearsal.path, "expect"), message, f"expect {fitting}, or `succeeded`")
