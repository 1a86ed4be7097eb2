"""What a device does in the world at a moment of its life: the facts that start order, gates and the mock follow.

A component that starts may move fingers, take control of an arm, or keep the controller manager from its cycle. None
of this is in a ROS interface, so that each fact is read from the source of one release, which it names.
"""

from typing import Annotated, Union

from pydantic import Field, model_validator

from cellc.compiler.catalog.catalog_model import (
    AuthorityName,
    CatalogModel,
    DistroName,
    LockName,
    MotionName,
    NeedName,
    Text,
    UnmetName,
)
from cellc.compiler.spec.quantity import JointWay
from cellc.contract.entities import HardwareState
from cellc.contract.vocabulary import CommandAuthority, Distro, ManagerLock, Need, Unmet


class EffectFacts(CatalogModel):
    """What one moment does.

    Attributes:
        motion: What moves at the moment.
        authority: Whether the moment takes or returns the authority to command the device.
        lock: For how long the moment keeps the controller manager from reading and writing its hardware.
        drops_part: Whether what a gripper holds falls.
        needs: What must hold before the moment, and what happens otherwise, for all distributions or for each.
        leaves: State of the component afterwards, if that is not the one asked for; unless active, its controllers are
            deactivated.
        ends: What a claim needs and no longer has after the moment.
        largest_step: How far a set point may be from the position of the device; the device ignores one that is
            farther.
        does: What happens, in one sentence.
        source: Line of code with its release from which this was read.
    """

    motion: MotionName
    authority: AuthorityName = CommandAuthority.UNCHANGED
    lock: LockName = ManagerLock.NONE
    drops_part: bool = False
    needs: dict[NeedName, Union[UnmetName, dict[DistroName, UnmetName]]] = Field(default_factory=dict)
    leaves: HardwareState | None = None
    ends: tuple[NeedName, ...] = ()
    largest_step: JointWay | None = None
    does: Text
    source: Text

    def unmet(self, need: Need, distro: Distro) -> Unmet:
        """Return what happens where a need does not hold; UNKNOWN where that release has not been read."""
        consequence = self.needs[need]
        return consequence.get(distro, Unmet.UNKNOWN) if isinstance(consequence, dict) else consequence


class NeedStatusFacts(CatalogModel):
    """Where the cell hears whether a need holds: a topic that a controller of this device publishes.

    Attributes:
        controller: Kind of the controller.
        topic: Name of the topic below the node of the controller.
        type: Message type of the topic.
        field: Field of the newest message that is compared.
        values: Values of which the field has one while the need holds.
        above: Value that the field exceeds while the need holds; it excludes ``values``.
        source: Line of code from which this was read.
    """

    controller: Text
    topic: Text
    type: Text
    field: Text
    values: tuple[Union[bool, int], ...] = ()
    above: Annotated[float, Field(allow_inf_nan=False)] | None = None
    source: Text

    @model_validator(mode="after")
    def _compares_in_one_way(self) -> "NeedStatusFacts":
        if bool(self.values) == (self.above is not None):
            raise ValueError("must have `values` or `above`, and not both")
        return self


class StartFacts(CatalogModel):
    """How a hardware component must be brought up where the usual path, straight to active, is wrong.

    Attributes:
        initial_state: State in which the component is left at the start.
        direct_activation: Whether it must go from ``initial_state`` to active in one call of
            ``set_hardware_component_state``, because a stay in between leaves it with wrong commands.
        why: Why the usual path is wrong.
        source: Line of code from which this was read.
    """

    initial_state: HardwareState
    direct_activation: bool = False
    why: Text
    source: Text
