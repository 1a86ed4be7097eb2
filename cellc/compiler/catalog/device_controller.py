"""Controllers that only one device has: variants of a neutral kind, and those that name what they take in full."""

from pydantic import Field

from cellc.compiler.catalog.catalog_model import BehaviorName, CatalogModel, DistroName, Text
from cellc.compiler.catalog.controller_kind import (
    ControllerAction,
    ControllerKind,
    ControllerService,
    ControllerTopic,
)
from cellc.compiler.catalog.device_interfaces import InterfaceName, PluginUse, counted
from cellc.compiler.catalog.effects import EffectFacts
from cellc.compiler.catalog.parameter_facts import ParameterFacts
from cellc.contract.vocabulary import OF_ONE_DEVICE


class DeviceController(CatalogModel):
    """A controller kind that only this device offers.

    Kinds of ``broadcaster``, ``service`` and ``own_motion`` act as no neutral kind: they say themselves what they take.

    Attributes:
        behavior: Neutral kind that the controller acts as, or ``broadcaster``, ``service`` or ``own_motion``.
        command_interfaces: Interfaces that it claims of each joint if the spec says nothing; empty for those of the
            neutral kind.
        claims: Full names of interfaces that it claims; ``name_[0..3]`` counts for four of them.
        reads: Full names of interfaces that it reads; ``name_[0..3]`` counts for four of them.
        topics: Topics of the controller.
        services: Services of the controller.
        action: Action of the controller.
        effect: What a controller of ``own_motion`` does with the device while it is active.
        parameters: Parameters that the controller declares, by name.
        plugins: Plugin of each distribution that has the controller.
        real_only: Whether only the real target runs it, since the mock lacks what it needs.
        source: Line of code or document from which this was read.
    """

    behavior: BehaviorName
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
        if self.behavior not in OF_ONE_DEVICE:
            return None
        return ControllerKind(
            format=1,
            kind=self.behavior,
            summary=f"a {self.behavior} of one device",
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
