"""Limits of a device in ``device.yaml``: what URDF has no place for, and what its description leaves out."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, Text
from cellc.compiler.spec.quantity import (
    FieldAngle,
    JointAcceleration,
    JointEffort,
    JointJerk,
    JointPosition,
    JointVelocity,
    Length,
    Mass,
    Quantity,
)
from cellc.contract.vocabulary import UNKNOWN
from cellc.robot.description.model import Description, Joint, JointLimit

EVERY_JOINT = "*"
"""The key for all joints without a key of their own."""


class JointLimitFact(CatalogModel):
    """A limit of one joint, or of every joint (``*``): its figures, then their source."""

    if TYPE_CHECKING:  # each kind declares it after its figures: the order of the reference and of `cellc format`
        source: Text

    @property
    def assumed(self) -> bool:
        """Whether no source gives the figure."""
        return self.source.startswith(UNKNOWN)

    def figures(self) -> Iterator[tuple[str, Quantity]]:
        """Yield each figure with its key."""
        for key in type(self).model_fields:
            value = getattr(self, key)
            if isinstance(value, Quantity):
                yield key, value


class PositionLimit(JointLimitFact):
    """The range of a joint.

    Attributes:
        lower: Smallest position.
        upper: Largest position.
        source: Document with its version; that of an assumed figure begins with ``UNKNOWN``.
    """

    lower: JointPosition
    upper: JointPosition
    source: Text


class VelocityLimit(JointLimitFact):
    """A velocity that a joint may have.

    Attributes:
        value: Largest velocity.
        source: Document with its version; that of an assumed figure begins with ``UNKNOWN``.
    """

    value: JointVelocity
    source: Text


class EffortLimit(JointLimitFact):
    """A torque or force that a joint has.

    Attributes:
        value: Largest torque or force.
        source: Document with its version; that of an assumed figure begins with ``UNKNOWN``.
    """

    value: JointEffort
    source: Text


class AccelerationLimit(JointLimitFact):
    """An acceleration that a joint may have.

    Attributes:
        value: Largest acceleration.
        source: Document with its version; that of an assumed figure begins with ``UNKNOWN``.
    """

    value: JointAcceleration
    source: Text


class JerkLimit(JointLimitFact):
    """A jerk that a joint may have.

    Attributes:
        value: Largest jerk.
        source: Document with its version; that of an assumed figure begins with ``UNKNOWN``.
    """

    value: JointJerk
    source: Text


class PayloadLimit(CatalogModel):
    """Mass that may hang on the flange, tool included.

    Attributes:
        value: Largest mass.
        source: Data sheet with its version.
    """

    value: Mass
    source: Text


class ReachFigure(CatalogModel):
    """How far the arm reaches, as its vendor gives it: from the axis of the first joint.

    Attributes:
        value: Largest distance from the axis of the first joint.
        source: Data sheet with its version.
    """

    value: Length
    source: Text


class RepeatabilityFigure(CatalogModel):
    """Pose repeatability of the tip by ISO 9283.

    Attributes:
        value: Half of what a data sheet gives as a range about zero, such as ``0.03 mm`` for ±0.03 mm.
        source: Data sheet with its version.
    """

    value: Length
    source: Text


class TiltLimit(CatalogModel):
    """How far from upright the base may be mounted: the controller of the device compensates gravity along its z axis.

    Attributes:
        value: Largest angle between the z axis of the base and the vertical.
        source: Manual, or a statement of the vendor, with its version.
    """

    value: FieldAngle
    source: Text


class LimitFacts(CatalogModel):
    """Limits beside those of the description; keys are joint names without prefix, or ``*`` for all others.

    Attributes:
        position: Ranges of joints, instead of those of the description.
        velocity: Velocities of joints, instead of those of the description.
        effort: Torques or forces of joints, instead of those of the description.
        velocity_everywhere: Velocities that hold over the whole range, if a joint may have less near its ends than its
            description says.
        acceleration: Accelerations of joints; URDF has no place for them.
        jerk: Jerks of joints; URDF has no place for them.
        payload: Mass that may hang on the flange.
        reach: Reach by the data sheet.
        repeatability: Repeatability by the data sheet.
        tilt: How far from upright it may be mounted; any way where absent.
    """

    position: dict[Text, PositionLimit] = Field(default_factory=dict)
    velocity: dict[Text, VelocityLimit] = Field(default_factory=dict)
    effort: dict[Text, EffortLimit] = Field(default_factory=dict)
    velocity_everywhere: dict[Text, VelocityLimit] = Field(default_factory=dict)
    acceleration: dict[Text, AccelerationLimit] = Field(default_factory=dict)
    jerk: dict[Text, JerkLimit] = Field(default_factory=dict)
    payload: PayloadLimit | None = None
    reach: ReachFigure | None = None
    repeatability: RepeatabilityFigure | None = None
    tilt: TiltLimit | None = None

    def of_joints(self) -> Mapping[str, Mapping[str, JointLimitFact]]:
        """Return the limits of joints: key of ``limits``, joint or ``*``, fact."""
        return {
            "position": self.position,
            "velocity": self.velocity,
            "effort": self.effort,
            "velocity_everywhere": self.velocity_everywhere,
            "acceleration": self.acceleration,
            "jerk": self.jerk,
        }

    def assumed_of(self, joint: str) -> Iterator[str]:
        """Yield the keys of the limits of a joint, named without prefix, that are assumed."""
        for key, limits in self.of_joints().items():
            fact = limits.get(joint, limits.get(EVERY_JOINT))
            if fact is not None and fact.assumed:
                yield key

    def velocity_of(self, joint: str) -> VelocityLimit | None:
        """Return the velocity that a joint, named without prefix, may have everywhere."""
        return self.velocity_everywhere.get(joint, self.velocity_everywhere.get(EVERY_JOINT))

    def acceleration_of(self, joint: str) -> AccelerationLimit | None:
        """Return the limit of a joint, named without prefix."""
        return self.acceleration.get(joint, self.acceleration.get(EVERY_JOINT))

    def jerk_of(self, joint: str) -> JerkLimit | None:
        """Return the limit of a joint, named without prefix."""
        return self.jerk.get(joint, self.jerk.get(EVERY_JOINT))

    def on(self, description: Description) -> Description:
        """Return a description whose joints have these limits instead of their own."""
        if not (self.position or self.velocity or self.effort):
            return description
        return replace(description, joints=tuple(map(self._on_joint, description.joints)))

    def _on_joint(self, joint: Joint) -> Joint:
        name, limit = joint.name, joint.limit or JointLimit(None, None, None, None)
        if not joint.movable:
            return joint
        position = self.position.get(name, self.position.get(EVERY_JOINT))
        velocity = self.velocity.get(name, self.velocity.get(EVERY_JOINT))
        effort = self.effort.get(name, self.effort.get(EVERY_JOINT))
        if position is not None:
            limit = replace(limit, lower=position.lower.si, upper=position.upper.si)
        if velocity is not None:
            limit = replace(limit, velocity=velocity.value.si)
        if effort is not None:
            limit = replace(limit, effort=effort.value.si)
        return joint if limit == joint.limit else replace(joint, limit=limit)
