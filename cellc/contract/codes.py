"""Every code that the stages around the rules report, each stage in one entry; a rule has its code in its own name."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.diagnostics import Severity

_WARNINGS = (
    *("device-against-description", "gripper-against-description", "implausible-fact", "pretended-hardware"),
    *("shape-of-another-part", "xacro-warning", "unused-ignore"),
)
_CODES = {
    "source": """
        alias-bomb command-too-long control-character duplicate-key empty-file file-not-found file-too-large
        file-unreadable include-cycle include-escape include-shape key-collision merge-key non-string-key not-a-cell
        not-a-file not-utf8 not-yaml number-out-of-range recursive-alias root-not-mapping several-documents
        substitution-in-text tab-indentation too-deep too-many-includes too-many-values unknown-alias yaml-tag
    """,
    "spec": """
        bad-name empty-value fault-kind-missing interface-kind-missing missing-key missing-unit not-a-choice
        not-a-quantity out-of-range solid-kind-missing step-kind-missing unknown-key unsupported-format wrong-count
        wrong-type wrong-unit
    """,
    "catalog": """
        catalog-entry-invalid commanded-follower device-against-description gripper-against-description implausible-fact
        pretended-hardware
        urdf-bad-geometry urdf-bad-number urdf-missing-attribute urdf-missing-element urdf-not-a-robot
        urdf-not-expanded urdf-unknown-joint-type xacro-bad-yaml xacro-failed xacro-file-not-found
        xacro-missing-argument xacro-not-text xacro-outside-root xacro-package-not-found xacro-refused-expression
        xacro-refused-substitution xacro-too-large xacro-unknown-argument xml-entities xml-not-well-formed
        xml-too-deep xml-too-large xacro-warning
    """,
    "link": """
        ambiguous-node confidence-of-nothing controller-not-in-distro controller-without-device event-never-comes
        hand-eye-differs hand-eye-of-other-frames invalid-hand-eye invalid-kinematics not-a-chain not-an-executable
        planner-not-in-distro rehearsal-cycle repeatability-of-nothing touched-points-apart unknown-calibration
        unknown-clock unknown-controller unknown-controller-kind unknown-device unknown-distro unknown-frame
        unknown-goal unknown-group unknown-host unknown-interface unknown-joint unknown-model unknown-nic
        unknown-node unknown-planner unknown-rehearsal unknown-signal unknown-state
    """,
    "ignores": "ignore-refused ignore-without-reason unknown-ignored-code unused-ignore",
    "fleet": "shared-domain-id",
    "plant": """
        crossing-differs crossing-frame-apart crossing-not-declared mixed-distributions parts-may-meet
        shape-of-another-part unknown-part unsupported-in-plant
    """,
    "verify": "verify-frames verify-joints verify-json verify-scene verify-text verify-urdf",
    "output": """
        bad-artifact-path edited-by-hand output-blocked output-busy output-shared output-symlink output-unwritable
    """,
}

STAGES: Mapping[str, Mapping[str, Severity]] = {
    stage: {code: Severity.WARNING if code in _WARNINGS else Severity.ERROR for code in codes.split()}
    for stage, codes in _CODES.items()
}
"""Stage → its codes with their severities, in the order in which a cell passes the stages."""
