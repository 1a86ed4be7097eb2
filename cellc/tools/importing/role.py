"""What a robot is to its cell: its kind, the chain that moves in a first motion, and where its tool is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.robot.description.model import Description
from cellc.tools.importing.chain import Chain, Tip, chain_of, tip_at
from cellc.tools.importing.kinds import Kind, kind_of, shape_of

_CARRYING = ("arm", "axis")
"""Kinds whose main chain ends where something is mounted."""
_CLOSING = ("gripper", "hand")
"""Kinds that close about a point of their palm."""


@dataclass(frozen=True, slots=True)
class Role:
    """The part that a robot has in its cell.

    Attributes:
        tip: where tools are mounted, or where fingers close; None where there is no such link.
    """

    kind: Kind
    chain: Chain
    tip: Tip | None

    @property
    def device(self) -> str:
        """Its name in a first cell."""
        return self.kind.kind

    @property
    def group(self) -> str:
        """The planning group of its chain in a first cell."""
        return f"{self.device}_group"

    @property
    def tool_frame(self) -> str | None:
        """The link that carries tools; None where it is no carrier of any."""
        return self.tip.link if self.tip is not None and self.kind.kind in _CARRYING else None

    @property
    def frames(self) -> dict[str, str]:
        """What a spec calls the point that fingers close about."""
        return {"tcp": self.tip.link} if self.tip is not None and self.kind.kind in _CLOSING else {}

    def lines(self) -> Iterator[str]:
        """Yield the kind and the tip as they are printed, with the evidence."""
        doubt = "; not certain, `--kind` decides"
        yield f"kind: {self.kind.kind} ({self.kind.because}{'' if self.kind.certain else doubt})"
        if self.tip is not None:
            yield f"tip: {self.tip.link} ({self.tip.because})"

    def questions(self) -> Iterator[str]:
        """Yield what the evidence leaves open."""
        if not self.kind.certain:
            yield f"`kind` may be wrong, the evidence is {self.kind.because}: is it of kind {self.kind.kind}?"
        if self.tip is None and self.kind.kind in _CLOSING:
            yield "no link is named as the point that the fingers close about: which is it? Add it to `frames` as `tcp`"
        if self.tip is not None and not self.tip.certain:
            yield f"no link is named as a tool frame: is `{self.tip.link}` where tools are mounted?"


def role_of(description: Description, given: str | None = None) -> Role:
    """Return the part of a robot by its evidence.

    Args:
        given: the kind that a person states.

    Raises:
        ImportRefusedError: no joint moves.
    """
    chain = chain_of(description)
    kind = kind_of(description) if given is None else Kind(given, "as it was stated")
    if kind.kind in _CARRYING:
        return Role(kind, chain, tip_at(chain.tip, description))
    tip = tip_at(_palm(description, chain), description) if kind.kind in _CLOSING else None
    return Role(kind, chain, tip if tip is not None and tip.certain else None)


def _palm(description: Description, chain: Chain) -> str:
    """Return the first link of the body that the fingers hang on."""
    fingers, above = shape_of(description).fingers, {joint.child: joint for joint in description.joints}
    link = fingers[0].parent if fingers else chain.base
    while link in above and above[link].type == "fixed":
        link = above[link].parent
    return link
