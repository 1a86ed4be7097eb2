"""How joints of a real device follow commands; linked from a spec, written to and read from contract.json.

A joint behind a spring is where ``stiffness * (command - position)`` is what its controller must give against gravity.
What the controller gives by a model of its own, ``unaccounted`` is left for the spring.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, ClassVar

from pydantic import ConfigDict, Field

from cellc.contract.frozen import dataclass
from cellc.contract.quantities import Coordinate, Magnitude, PositiveMagnitude
from cellc.contract.vocabulary import Gravity, Held, Loop

_READ = ConfigDict(extra="forbid", allow_inf_nan=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class JointLaw:
    """The spring of one joint; a joint that slides has N and m for Nm and rad."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    stiffness: Annotated[PositiveMagnitude, Field(description="Nm for each rad from the command.")]
    damping: Annotated[Magnitude, Field(description="Nm for each rad/s.")] = 0.0
    integral: Annotated[Magnitude, Field(description="Nm for each rad and second from the command.")] = 0.0
    integral_most: Annotated[Magnitude | None, Field(description="Largest of it, Nm; null without bound.")] = None

    @property
    def lag_s(self) -> float:
        """Time constant with which the joint gets where it stays."""
        return self.damping / self.stiffness


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkMass:
    """A mass on a link, which the description does not have; below zero where one that it has is taken away."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    link: Annotated[str, Field(description="Link that carries it.")]
    mass_kg: Annotated[Coordinate, Field(description="Mass, kg.")]
    center: Annotated[tuple[Coordinate, Coordinate, Coordinate], Field(description="Its center in the link, m.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlLaw:
    """How the joints of a real device follow, under the interface that is commanded there."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    loop: Annotated[Loop, Field(description="What holds the joints.")]
    because: Annotated[str, Field(description="Why it is not known; empty where it is.")] = ""
    held: Annotated[Held, Field(description="Set point after a goal is canceled or aborted.")] = Held.MEASURED
    gravity: Annotated[Gravity, Field(description="Who holds the arm against gravity.")] = Gravity.SPRING
    lags: Annotated[bool, Field(description="Damping brakes the motion itself, not its error.")] = False
    joints: Annotated[Mapping[str, JointLaw], Field(description="Spring of each joint, by joint.")] = field(
        default_factory=dict
    )
    unaccounted: Annotated[tuple[LinkMass, ...], Field(description="What is held beside the model.")] = ()
    part: Annotated[LinkMass | None, Field(description="What its tool carries while it is closed.")] = None
