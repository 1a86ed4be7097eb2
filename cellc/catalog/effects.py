"""What a device does in the world at a moment of its life: the facts that start order, gates and the mock follow.

A component that comes up may move fingers, take control of an arm, or keep the controller manager from its cycle. None
of this stands in a ROS interface, so that each fact is read from the source of one release, which it names.
"""

from typing import Literal, Union

from pydantic import Field

from cellc.catalog.catalog_model import (
    AuthorityName,
    CatalogModel,
    DistroName,
    LockName,
    MotionName,
    NeedName,
    Text,
    UnmetName,
)
from cellc.spec.quantity import JointWay
from cellc.vocabulary import CommandAuthority, Distro, ManagerLock, Need, Unmet

ComponentState = Literal["unconfigured", "inactive", "active"]
"""A state of a hardware component of ros2_control."""


class EffectFacts(CatalogModel):
    """What one moment does.

    ``needs`` are what must hold before it, each with what happens otherwise, for one distribution or for all.
    ``drops_part`` tells whether what a gripper holds falls. ``leaves`` is the state in which the component is
    afterwards, where that is not what was asked for; controllers of a component that is not active are deactivated.
    ``largest_step`` is how far a set point may be from where the device stands; it ignores one that is farther.
    """

    motion: MotionName
    authority: AuthorityName = CommandAuthority.UNCHANGED
    lock: LockName = ManagerLock.NONE
    drops_part: bool = False
    needs: dict[NeedName, Union[UnmetName, dict[DistroName, UnmetName]]] = Field(default_factory=dict)
    leaves: ComponentState | None = None
    largest_step: JointWay | None = None
    does: Text
    source: Text

    def unmet(self, need: Need, distro: Distro) -> Unmet:
        """Return what happens where a need does not hold; UNKNOWN where nobody read the release of the distribution."""
        told = self.needs[need]
        return told.get(distro, Unmet.UNKNOWN) if isinstance(told, dict) else told


class ToldFacts(CatalogModel):
    """Where the cell hears whether a need holds: a topic that a controller of this device publishes.

    ``controller`` is its kind, ``topic`` the name below its node, and ``field`` of the newest message holds ``value``
    as long as the need holds.
    """

    controller: Text
    topic: Text
    type: Text
    field: Text
    value: Union[bool, int]
    source: Text


class StartFacts(CatalogModel):
    """How a hardware component is to be brought up where the usual way, active at once, is wrong.

    ``at_once`` where it must go from the initial state to active in one call of set_hardware_component_state: a stay
    in between leaves it with wrong commands.
    """

    initial_state: ComponentState
    at_once: bool = False
    why: Text
    source: Text
