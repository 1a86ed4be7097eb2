"""What a diagnosis says: hypotheses with the observations that can rule them out, nothing that acts."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Step:
    """One observation: a command that only reads, or something to look at; and what would rule the cause out."""

    action: str
    is_command: bool
    refuted: str


@dataclass(frozen=True, slots=True)
class Cause:
    """A hypothesis; ``omitted`` counts further subjects of the cell to which the same steps apply."""

    text: str
    steps: tuple[Step, ...]
    omitted: int


@dataclass(frozen=True, slots=True)
class Suspicion:
    """One symptom that fits.

    Args:
        layer: title of the layer.
        evidence: what the line itself names, such as ``controller arm_trajectory``.
        unknown: those of the named things that the cell does not have.
        owner: the person or team who decides, or the approval area where no cell was given.
    """

    layer: str
    symptom: str
    evidence: tuple[str, ...]
    unknown: tuple[str, ...]
    causes: tuple[Cause, ...]
    never: str
    owner: str
    source: str
