"""How joints of a real device follow what they are commanded: the facts that droop, lag and holds are computed from."""

from typing import Annotated, Literal

from pydantic import Strict, model_validator

from cellc.compiler.catalog.catalog_model import CatalogModel, Text, Token
from cellc.compiler.catalog.device_interfaces import InterfaceName
from cellc.compiler.spec.quantity import JointDampings, JointInertias, JointTorques
from cellc.contract.vocabulary import Gravity, Held, Loop

LoopName = Annotated[Loop, Strict(False)]
GravityName = Annotated[Gravity, Strict(False)]
HeldName = Annotated[Held, Strict(False)]


class LawFacts(CatalogModel):
    """How joints of the real device follow commands of one kind.

    Attributes:
        commands: Command interfaces for which this law holds, such as ``[position]``; empty for all others.
        loop: What holds the joints: ``position`` if they are where they are commanded whatever they carry, ``spring``
            if a load moves them, ``unknown`` if no public source says.
        gains: Where the figures of a spring are: ``controller`` for the gains of the controller that commands the
            joints, ``plugin`` for ``stiffness`` and ``damping``, ``impedance`` for those of the spec.
        stiffness: Parameters of the real plugin that have the stiffness of each joint, in N m/rad, in the order of the
            description. `impedance` of the spec sets them.
        damping: Parameters of the real plugin that have the damping of each joint, in N m s/rad.
        damps: Whether damping brakes the ``motion``, so that joints lag, or its ``error`` alone.
        gravity: What holds the joints against gravity: the ``spring``, or the device, ``compensated`` for its own links
            and the payload that it is set to.
        held: What stays in force when a goal is canceled or aborted.
        because: Why the law is not known, or what it rests on.
        source: Line of code or document with its version from which this was read.
    """

    commands: tuple[InterfaceName, ...] = ()
    loop: LoopName
    gains: Literal["controller", "plugin", "impedance"] | None = None
    stiffness: tuple[Token, ...] = ()
    damping: tuple[Token, ...] = ()
    damps: Literal["motion", "error"] = "error"
    gravity: GravityName = Gravity.SPRING
    held: HeldName = Held.MEASURED
    because: Text | None = None
    source: Text

    @model_validator(mode="after")
    def _fits(self) -> "LawFacts":
        if (self.loop is Loop.SPRING) != (self.gains is not None):
            raise ValueError("`gains` must be stated for a `spring`, and for no other loop")
        if (self.gains == "plugin") != bool(self.stiffness) or len(self.damping) not in (0, len(self.stiffness)):
            raise ValueError("`gains: plugin` must name `stiffness`, and as many of `damping` or none")
        if self.loop is Loop.UNKNOWN and self.because is None:
            raise ValueError("`because` must say why the loop is unknown")
        return self


class DriveFacts(CatalogModel):
    """What motors and gears add to the joints that they turn, a figure for each joint in the order of the description.

    Fingers and joints that follow others are left out. It counts in runs with masses alone, and a figure of the
    description counts first.

    Attributes:
        armature: Inertia of rotor and gear about the joint.
        damping: Viscous friction.
        friction: Dry friction, against which a joint begins to turn.
        source: Document, model or identification with its version.
    """

    armature: JointInertias | None = None
    damping: JointDampings | None = None
    friction: JointTorques | None = None
    source: Text

    @model_validator(mode="after")
    def _fits(self) -> "DriveFacts":
        sizes = {len(figures.si) for figures in (self.armature, self.damping, self.friction) if figures is not None}
        if len(sizes) != 1:
            raise ValueError("`drives` must state a figure, and as many of each kind as of the others")
        return self
