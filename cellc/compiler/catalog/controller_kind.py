"""A neutral controller kind: its plugin in each distribution, what it claims and serves, and its parameters."""

from collections.abc import Iterator, Mapping
from typing import Literal

from pydantic import Field

from cellc.compiler.catalog.catalog_model import (
    BehaviorName,
    CatalogModel,
    Date,
    DistroName,
    GraphName,
    ParameterFact,
    Text,
    Token,
)
from cellc.compiler.catalog.device_graph import QosUse
from cellc.compiler.catalog.device_interfaces import InterfaceName, PluginUse
from cellc.compiler.catalog.effects import EffectFacts
from cellc.compiler.catalog.parameter_facts import ParameterFacts, is_named
from cellc.contract.vocabulary import Distro


class ControllerAction(CatalogModel):
    """The action that a controller serves below its own name.

    Attributes:
        suffix: Last part of its name, such as ``follow_joint_trajectory``.
        types: Action type in each distribution.
    """

    suffix: Token
    types: dict[DistroName, Text]


class ControllerTopic(CatalogModel):
    """A topic of a controller.

    Attributes:
        name: Name of the topic; one below the controller's name begins with ``~/``.
        type: Message type, such as ``std_msgs/msg/Bool``.
        direction: Whether the controller publishes the topic or subscribes to it.
        qos: Profile of the endpoint: a name such as ``system_default``, or its settings.
        only: Distributions that have the topic; empty for all.
        given: Parameters of the controller with the values for which it has the topic; empty for any.
        rate: Parameter with the rate of the messages in Hz; that of the controller if absent.
    """

    name: GraphName
    type: Text
    direction: Literal["publish", "subscribe"]
    qos: QosUse
    only: tuple[DistroName, ...] = ()
    given: dict[Text, ParameterFact] = Field(default_factory=dict)
    rate: Text | None = None


class ControllerService(CatalogModel):
    """A service of a controller.

    Attributes:
        name: Name of the service; one below the controller's name begins with ``~/``.
        type: Service type, such as ``std_srvs/srv/Trigger``.
        effect: What a call does in the world, if it does anything there.
    """

    name: GraphName
    type: Text
    effect: EffectFacts | None = None


class ControllerKind(CatalogModel):
    """One ``catalog/controllers/<kind>.yaml``.

    ``scope``: ``device`` drives the joints of one device, ``manager`` reads what all devices of a manager offer.
    ``joints_parameter`` is the parameter that names its joints, a list unless ``single_joint``. Of the groups of
    parameters in ``either`` exactly one is given.
    """

    format: Literal[1]
    kind: BehaviorName
    summary: Text
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    scope: Literal["device", "manager", "sensor"]
    plugins: dict[DistroName, PluginUse]
    joints_parameter: Token | None = None
    single_joint: bool = False
    interfaces_parameter: Token | None = None
    command_interfaces: tuple[InterfaceName, ...] = ()
    command_combinations: tuple[tuple[InterfaceName, ...], ...] = ()
    state_interfaces: tuple[InterfaceName, ...] = ()
    action: ControllerAction | None = None
    topics: tuple[ControllerTopic, ...] = ()
    services: tuple[ControllerService, ...] = ()
    parameters: dict[Text, ParameterFacts]
    either: tuple[tuple[Text, ...], ...] = ()

    def parameters_in(self, distro: Distro) -> dict[str, ParameterFacts]:
        """Return the parameters that the distribution declares, as it declares them."""
        return {name: facts.as_in(distro) for name, facts in self.parameters.items() if facts.declared_in(distro)}

    def topics_with(self, parameters: Mapping[str, object], distro: Distro) -> Iterator[ControllerTopic]:
        """Yield the topics that a controller has in a distribution with the parameters that it gets."""
        here = self.parameters_in(distro)

        def value(name: str) -> object:
            return parameters.get(name, here[name].default if name in here else None)

        for topic in self.topics:
            if (not topic.only or distro in topic.only) and all(
                name not in here or value(name) == wanted for name, wanted in topic.given.items()
            ):
                yield topic

    def parameter(self, name: str, distro: Distro) -> ParameterFacts | None:
        """Return the declaration of a parameter by the name that a user writes, or None."""
        declared = self.parameters_in(distro)
        return declared.get(name) or next((facts for key, facts in declared.items() if is_named(key, name)), None)
