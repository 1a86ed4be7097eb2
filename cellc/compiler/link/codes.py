"""What linking reports: references that nothing has, and choices that the catalog does not offer."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.diagnostics import Severity

CODES: Mapping[str, Severity] = dict.fromkeys(
    (
        "ambiguous-node",
        "confidence-of-nothing",
        "controller-not-in-distro",
        "controller-without-device",
        "event-never-comes",
        "hand-eye-differs",
        "hand-eye-of-other-frames",
        "invalid-hand-eye",
        "invalid-kinematics",
        "not-a-chain",
        "not-an-executable",
        "planner-not-in-distro",
        "rehearsal-cycle",
        "repeatability-of-nothing",
        "unknown-calibration",
        "unknown-clock",
        "unknown-controller",
        "unknown-controller-kind",
        "unknown-device",
        "unknown-distro",
        "unknown-frame",
        "unknown-goal",
        "unknown-group",
        "unknown-host",
        "unknown-interface",
        "unknown-joint",
        "unknown-model",
        "unknown-nic",
        "unknown-node",
        "unknown-planner",
        "unknown-rehearsal",
        "unknown-signal",
        "unknown-state",
    ),
    Severity.ERROR,
)
