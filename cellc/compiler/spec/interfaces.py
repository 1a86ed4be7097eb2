"""Nodes, and the topics, services and actions between them."""

from typing import Annotated, ClassVar, Literal, Union

from pydantic import Discriminator, Field, Tag

from cellc.compiler.spec.base import (
    MOST,
    FrameReference,
    InterfaceType,
    Namespace,
    NodeReference,
    ParameterValue,
    shape_of,
)
from cellc.compiler.spec.quantity import Duration, Frequency, PositiveDuration, Ratio, TimeShift
from cellc.contract.entities import Durability, Reliability
from cellc.contract.stated import Name, StatedModel, Text
from cellc.contract.vocabulary import UNKNOWN

OnStale = Literal["reject_goal", "stop_and_hold", "ignore_sample", "continue"]
OnTimeout = Literal["cancel_and_hold", "error", "continue"]


class CallbackSpec(StatedModel):
    """What a node executes for an interface, or for a timer of its own."""

    takes: Duration | None = Field(None, description="Longest time that it executes.", examples=["30 ms"])
    group: Name | None = Field(
        None, description="Callback group; the default one of the node if absent.", examples=["images"]
    )
    reentrant: bool = Field(False, description="Its group is reentrant, not mutually exclusive.", examples=[True])
    waits_for: tuple[Text, ...] = Field(
        (), description="Services and actions that it calls, and waits for inside.", examples=[["/locate"]]
    )
    period: PositiveDuration | None = Field(None, description="Period of a timer.", examples=["100 ms"])


class NodeSpec(StatedModel):
    """A node of the cell that is not a driver or controller of the catalog."""

    run: Text = Field(..., description="Package and executable.", examples=["cell_perception/detector"])
    namespace: Namespace = Field("", description="Namespace of the node.", examples=["/left"])
    lifecycle: bool = Field(False, description="Is a managed node.", examples=[True])
    host: Name | None = Field(None, description="Host that runs it.", examples=["control_pc"])
    owner: Text = Field(UNKNOWN, description="Person or role responsible for it.", examples=["perception"])
    language: Literal["cpp", "python", "UNKNOWN"] = Field(
        UNKNOWN, description="What it is written in.", examples=["cpp"]
    )
    clock: Literal["wall", "sim"] | None = Field(
        None, description="Time it runs on; that of the target if absent.", examples=["wall"]
    )
    respawn: bool = Field(False, description="Start it again when it ends; never for a driver.", examples=[False])
    executor: Literal["single_threaded", "multi_threaded", "events"] | None = Field(
        None, description="Executor that spins it.", examples=["single_threaded"]
    )
    threads: int | None = Field(None, description="Threads of a multi-threaded executor.", examples=[4], ge=1, le=MOST)
    callbacks: dict[Text, CallbackSpec] = Field(
        default_factory=dict,
        description="What it executes, by the interface that it serves or hears, or by the name of a timer.",
        examples=[{"/camera/color/image_raw": {"takes": "30 ms"}}],
    )
    parameters: dict[str, ParameterValue] = Field(
        default_factory=dict, description="Parameters of the node.", examples=[{"min_score": 0.8}]
    )


class QosSpec(StatedModel):
    """Quality of service of one endpoint; what is absent is the default of its kind."""

    reliability: Reliability | None = Field(
        None, description="Delivery of every sample, or of what arrives.", examples=["reliable"]
    )
    durability: Durability | None = Field(
        None, description="Whether a late joiner gets history.", examples=["volatile"]
    )
    history: Literal["keep_last", "keep_all"] | None = Field(
        None, description="What is queued.", examples=["keep_last"]
    )
    depth: int | None = Field(None, description="Queue length of keep_last.", examples=[1], ge=1, le=MOST)
    deadline: Duration | None = Field(None, description="Longest time between samples.", examples=["200 ms"])
    lifespan: Duration | None = Field(None, description="Age at which a sample is dropped.", examples=["500 ms"])
    liveliness: Literal["automatic", "manual_by_topic"] | None = Field(
        None, description="Who asserts that the publisher lives.", examples=["automatic"]
    )
    lease_duration: Duration | None = Field(None, description="Bound of the assertion.", examples=["1 s"])


Endpoints = Annotated[
    Union[
        Annotated[NodeReference, Tag("text")],
        Annotated[tuple[NodeReference, ...], Tag("list")],
        Annotated[dict[NodeReference, QosSpec], Tag("mapping")],
    ],
    Discriminator(
        shape_of,
        custom_error_type="wrong-type",
        custom_error_message="a name, a list of names, or a mapping from names to their QoS",
    ),
]


class InterfaceFields(StatedModel):
    """What every interface may state."""

    frame: FrameReference | None = Field(None, description="Frame of the payload.", examples=["camera/color_optical"])
    unit: Text | None = Field(None, description="Unit of the payload where the type does not fix it.", examples=["m"])
    time_source: Literal["ros", "hardware", "wall", "sim"] | None = Field(
        None, description="Clock of the stamps.", examples=["ros"]
    )
    owner: Text | None = Field(
        None,
        description="Person or role responsible for it; the owner of its source if absent.",
        examples=["perception"],
    )


class SimulatedNetworkSpec(StatedModel):
    """What the mock's network does to each sample of a topic, drawn from the seed of the run."""

    latency: TimeShift | None = Field(None, description="Shortest time from publishing to arrival.", examples=["2 ms"])
    jitter: TimeShift | None = Field(None, description="Up to so much more, evenly spread.", examples=["1 ms"])
    loss: Ratio | None = Field(None, description="Share of samples lost on their way.", examples=["0.5 %"])
    reordering: Ratio | None = Field(
        None, description="Share of samples that the next one overtakes.", examples=["0.1 %"]
    )


class TopicSpec(InterfaceFields):
    """A stream."""

    SHARED_AFTER: ClassVar[str] = "wants"

    topic: InterfaceType = Field(..., description="Message type.", examples=["sensor_msgs/msg/Image"])
    from_: Endpoints = Field(
        ..., alias="from", description="Publisher, or publishers with their QoS.", examples=["camera"]
    )
    to: Endpoints = Field((), description="Subscribers, or subscribers with their QoS.", examples=[["perception"]])
    wants: Literal["newest", "every_sample"] | None = Field(
        None, description="What the consumer needs.", examples=["newest"]
    )
    rate: Frequency | None = Field(None, description="Publishing rate.", examples=["30 Hz"])
    max_age: Duration | None = Field(None, description="Oldest sample that may be used.", examples=["100 ms"])
    transport: Duration | None = Field(None, description="Budget from publishing to use.", examples=["10 ms"])
    on_stale: OnStale | None = Field(
        None,
        description="What the consumer does with an older sample. The mock's task stops a motion that rests on the "
        "topic in all cases but `continue`.",
        examples=["reject_goal"],
    )
    simulated: SimulatedNetworkSpec | None = Field(
        None, description="How the mock carries it; without delay and loss if absent.", examples=[{"latency": "2 ms"}]
    )


class ServiceSpec(InterfaceFields):
    """A bounded request and its response."""

    SHARED_AFTER: ClassVar[str] = "client"

    service: InterfaceType = Field(..., description="Service type.", examples=["std_srvs/srv/Trigger"])
    server: NodeReference = Field(..., description="Node that answers.", examples=["perception"])
    client: Endpoints = Field(..., description="Nodes that ask.", examples=["task"])
    timeout: Duration | None = Field(None, description="Bound of the response time.", examples=["1 s"])
    on_timeout: OnTimeout | None = Field(None, description="What the client does then.", examples=["error"])
    on_error: Text | None = Field(None, description="How an error is reported.", examples=["response.success false"])


class ActionSpec(InterfaceFields):
    """A long-running goal with feedback and cancellation."""

    SHARED_AFTER: ClassVar[str] = "client"

    action: InterfaceType = Field(..., description="Action type.", examples=["moveit_msgs/action/MoveGroup"])
    server: NodeReference = Field(..., description="Node or controller that executes.", examples=["move_group"])
    client: Endpoints = Field(..., description="Nodes that send goals.", examples=["task"])
    timeout: Duration | None = Field(None, description="Bound of a whole goal.", examples=["20 s"])
    on_timeout: OnTimeout | None = Field(None, description="What the client does then.", examples=["cancel_and_hold"])
    cancel_within: Duration | None = Field(None, description="Bound from cancel to hold.", examples=["200 ms"])


def _interface_kind(value: object) -> str | None:
    if isinstance(value, dict):
        return next((kind for kind in ("topic", "service", "action") if kind in value), None)
    kinds: tuple[tuple[type[InterfaceFields], str], ...] = (
        (TopicSpec, "topic"),
        (ServiceSpec, "service"),
        (ActionSpec, "action"),
    )
    return next((kind for model, kind in kinds if isinstance(value, model)), None)


InterfaceSpec = Annotated[
    Union[
        Annotated[TopicSpec, Tag("topic")], Annotated[ServiceSpec, Tag("service")], Annotated[ActionSpec, Tag("action")]
    ],
    Discriminator(
        _interface_kind,
        custom_error_type="interface-kind-missing",
        custom_error_message="an interface needs one of the keys `topic`, `service` or `action` with its type",
    ),
]
