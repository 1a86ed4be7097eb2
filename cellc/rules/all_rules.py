"""Every rule of cellc, family by family; a new rule is one line in the tuple of its family."""

from __future__ import annotations

from cellc.rule import Rule
from cellc.rules import clocks, frames, interfaces, model, ownership, qos, versions

ALL_RULES: tuple[Rule, ...] = (
    *model.RULES,
    *frames.RULES,
    *clocks.RULES,
    *interfaces.RULES,
    *qos.RULES,
    *ownership.RULES,
    *versions.RULES,
)
