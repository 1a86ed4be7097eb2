"""Controllers that only one device has: variants of a neutral kind, and those that name what they take in full."""

from pydantic import Field

from cellc.catalog.catalog_model import BehaviourName, CatalogModel, DistroName, Text
from cellc.catalog.controller_kind import (
    ControllerAction,
    ControllerKind,
    ControllerService,
    ControllerTopic,
    ParameterFacts,
)
from cellc.catalog.device_interfaces import InterfaceName, PluginUse, counted
from cellc.catalog.effects import EffectFacts
from cellc.vocabulary import OF_ONE_DEVICE


class DeviceController(CatalogModel):
    """A controller kind that only this device offers.

    ``behaviour`` is the neutral kind that it acts as; then ``command_interfaces`` are what it claims of each joint
    where the spec says nothing, empty for those of the neutral kind. ``broadcaster``, ``service`` and ``own_motion``
    act as no other: such a kind tells itself what it ``claims`` and ``reads``, by full interface names, and what it
    declares, publishes and serves; ``name_[0..3]`` stands for four of them. ``effect`` is what one of ``own_motion``
    does with the device while it is active. ``real_only`` where the mock lacks what it needs.
    """

    behaviour: BehaviourName
    command_interfaces: tuple[InterfaceName, ...] = ()
    claims: tuple[Text, ...] = ()
    reads: tuple[Text, ...] = ()
    topics: tuple[ControllerTopic, ...] = ()
    services: tuple[ControllerService, ...] = ()
    action: ControllerAction | None = None
    effect: EffectFacts | None = None
    parameters: dict[Text, ParameterFacts] = Field(default_factory=dict)
    plugins: dict[DistroName, PluginUse]
    real_only: bool = False
    source: Text

    def own_kind(self, as_of: str) -> ControllerKind | None:
        """Return what the entry says of a controller that acts as no neutral kind; None for a variant of one.

        Args:
            as_of: date of the device's entry.
        """
        if self.behaviour not in OF_ONE_DEVICE:
            return None
        return ControllerKind(
            format=1,
            kind=self.behaviour,
            summary=f"a {self.behaviour} of one device",
            as_of=as_of,
            sources=(self.source,),
            scope="sensor",
            plugins=self.plugins,
            topics=self.topics,
            services=self.services,
            action=self.action,
            parameters=self.parameters,
        )

    def taken(self, plugin: PluginUse) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the interfaces that such a controller claims and reads, those of one distribution last."""
        return tuple(counted((*self.claims, *plugin.claims))), tuple(counted((*self.reads, *plugin.reads)))
