"""A neutral controller kind: its plugin in each distribution, what it claims and serves, and its parameters."""

import re
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
from cellc.compiler.catalog.programs import DiscouragedValue
from cellc.contract.vocabulary import Distro

ParameterType = Literal[
    "bool", "int", "double", "string", "bool_array", "int_array", "double_array", "string_array", "none"
]


class ParameterVariant(CatalogModel):
    """What one distribution declares otherwise.

    Attributes:
        default: Default in this distribution.
        required: Whether this distribution requires a value.
        read_only: Whether this distribution refuses a change at run time.
        one_of: Values that this distribution takes.
        not_empty: Whether this distribution refuses an empty value.
    """

    default: ParameterFact | None = None
    required: bool | None = None
    read_only: bool | None = None
    one_of: tuple[Text, ...] | None = None
    not_empty: bool | None = None


class ParameterFacts(CatalogModel):
    """One declared parameter; dots nest, ``<joint>`` is any joint name.

    Attributes:
        type: Type of the value.
        default: Value if the parameter is not given.
        required: Whether it must be given if it has no default.
        read_only: Whether it cannot be changed at run time.
        minimum: Smallest value that is accepted.
        exclusive_minimum: Value that must be exceeded.
        maximum: Largest value that is accepted.
        one_of: Values that are accepted; empty for any.
        subset_of: Elements that a list may have; empty for any.
        not_empty: Whether an empty text or list is refused.
        unique: Whether the elements of a list must differ.
        only: Distributions that declare the parameter; empty for all.
        differs: What one distribution declares otherwise.
        not_played: What the mock does whatever the value is; absent where it plays the value.
        discouraged: Accepted values that make motion worse, or unsafe.
    """

    type: ParameterType
    default: ParameterFact | None = None
    required: bool = False
    read_only: bool = False
    minimum: float | None = None
    exclusive_minimum: float | None = None
    maximum: float | None = None
    one_of: tuple[Text, ...] = ()
    subset_of: tuple[Text, ...] = ()
    not_empty: bool = False
    unique: bool = False
    only: tuple[DistroName, ...] = ()
    differs: dict[DistroName, ParameterVariant] = Field(default_factory=dict)
    not_played: Text | None = None
    discouraged: tuple[DiscouragedValue, ...] = ()

    def declared_in(self, distro: Distro) -> bool:
        """Tell whether the distribution knows the parameter; an unknown one is ignored silently."""
        return not self.only or distro in self.only

    def as_in(self, distro: Distro) -> "ParameterFacts":
        """Return what a distribution declares."""
        variant = self.differs.get(distro)
        return self if variant is None else self.model_copy(update=variant.model_dump(exclude_unset=True))


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
    ``joints_parameter`` is the parameter that names its joints, a list unless ``single_joint``.
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


def is_named(declared: str, name: str) -> bool:
    """Whether a written name is that of a declared parameter; ``<joint>`` is any name, which may itself hold dots."""
    first, *others = re.split(r"<[a-z_]+>", declared)
    if not others:
        return name == first
    *inner, last = others
    at = len(first)
    # Each part at its first place: of a search that tries them all, the time grows with the power of their number.
    for part in inner:
        start = name.find(part, at + 1)
        if start < 0:
            return False
        at = start + len(part)
    return name.startswith(first) and name.endswith(last) and len(name) - len(last) > at
