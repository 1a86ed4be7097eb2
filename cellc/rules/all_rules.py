"""Every rule of cellc, family by family; a new rule is one line in the tuple of its family."""

from __future__ import annotations

from cellc.rule import Rule
from cellc.rules import (
    bringup,
    clocks,
    control,
    evidence,
    frames,
    interfaces,
    model,
    motion,
    network,
    ownership,
    qos,
    safety,
    versions,
)

ALL_RULES: tuple[Rule, ...] = (
    *model.RULES,
    *frames.RULES,
    *clocks.RULES,
    *interfaces.RULES,
    *qos.RULES,
    *ownership.RULES,
    *versions.RULES,
    *control.RULES,
    *motion.RULES,
    *network.RULES,
    *bringup.RULES,
    *safety.RULES,
    *evidence.RULES,
)
