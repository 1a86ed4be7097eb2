"""What a device has in the ROS graph: nodes, topics, services, actions and the streams of a camera."""

from typing import Literal, Union

from pydantic import Field

from cellc.compiler.catalog.catalog_model import (
    CatalogModel,
    DistroName,
    FileName,
    GraphName,
    NodeName,
    ParameterFact,
    Text,
    Token,
)
from cellc.compiler.catalog.effects import EffectFacts
from cellc.compiler.catalog.programs import EndpointFacts
from cellc.compiler.spec.base import MOST
from cellc.compiler.spec.quantity import Duration, FieldAngle, Frequency, Length
from cellc.contract.entities import Durability, Reliability


class QosFacts(CatalogModel):
    """A profile spelled out where none of the named ones fits.

    Attributes:
        reliability: Whether lost messages are sent again.
        durability: Whether a late subscriber gets the last messages.
        history: Whether the last ``depth`` messages are kept or all.
        depth: Number of messages that are kept.
    """

    reliability: Reliability
    durability: Durability
    history: Literal["keep_last", "keep_all"] = "keep_last"
    depth: int = Field(10, ge=1, le=MOST)


QosUse = Union[Token, QosFacts]
"""Name of a profile in ``qos_profiles.yaml``, or the settings themselves."""


class NodeFacts(CatalogModel):
    """A node of the driver for the real target.

    Attributes:
        name: Name of the node, such as ``{device}``.
        package: ROS package of the program.
        executable: Name of the program in the package.
        parameters: Parameters of the node, by name; placeholders are filled.
        remaps: Names that the program uses, and the names that they have in the cell.
        needs_controller: Kind of controller of this device without which the node would wait for ever; without it the
            node is not started.
        firmware: Oldest firmware with which the program runs, by product; with an older one the node is not started.
        endpoints: What the node has in the ROS graph besides what every node has.
        publishes_tf: Whether the node publishes frames to tf.
        provides: Targets on which the node runs: ``real``, or ``every_target``.
        effect: What the start of the process does in the world.
        source: Launch file or line of code from which this was read.
    """

    name: NodeName
    package: Token
    executable: FileName
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)
    remaps: dict[GraphName, GraphName] = Field(default_factory=dict)
    needs_controller: Token | None = None
    firmware: dict[Token, Text] = Field(default_factory=dict)
    endpoints: EndpointFacts | None = None
    publishes_tf: bool = False
    provides: Literal["real", "every_target"] = "real"
    effect: EffectFacts | None = None
    source: Text


class TopicFacts(CatalogModel):
    """A topic that the device publishes.

    Attributes:
        name: Full name of the topic; placeholders are filled.
        type: Message type, such as ``sensor_msgs/msg/Image``.
        qos: Profile of the publisher: a name such as ``system_default``, or its settings.
        publisher: Node that publishes the topic, one of ``nodes``, or ``driver`` for the controllers of the device.
        rate: How often messages are published.
        frame: Link to which the messages refer, without prefix.
    """

    name: GraphName
    type: Text
    qos: QosUse
    publisher: GraphName
    rate: Frequency | None = None
    frame: Token | None = None


class ServiceFacts(CatalogModel):
    """A service that the device answers.

    Attributes:
        name: Full name of the service; placeholders are filled.
        type: Service type, such as ``std_srvs/srv/Trigger``.
        server: Node that has the service server, one of ``nodes``.
        effect: What a call does in the world, if it does anything there.
    """

    name: GraphName
    type: Text
    server: GraphName
    effect: EffectFacts | None = None


class ActionFacts(CatalogModel):
    """An action that the device executes.

    Attributes:
        name: Full name of the action; placeholders are filled.
        type: Action type, such as ``control_msgs/action/GripperCommand``.
        server: Node that has the action server, one of ``nodes``.
        only: Distributions that have the action; empty for all.
        effect: What a goal does in the world, if it acts past every controller.
    """

    name: GraphName
    type: Text
    server: GraphName
    only: tuple[DistroName, ...] = ()
    effect: EffectFacts | None = None


class ViewFacts(CatalogModel):
    """What a stream can see.

    Attributes:
        horizontal: Whole horizontal angle of the sensor, such as ``69 deg``.
        vertical: Whole vertical angle of the sensor.
        nearest: Smallest distance at which the stream is used.
        farthest: Largest distance at which the stream is used.
        source: Data sheet with its version.
    """

    horizontal: FieldAngle
    vertical: FieldAngle
    nearest: Length
    farthest: Length
    source: Text


class ImageFacts(CatalogModel):
    """The images of a stream as the node of the device is started.

    Attributes:
        width: Width of an image in pixels.
        height: Height of an image in pixels.
        bytes_per_pixel: Size of a pixel in bytes, such as ``3`` for RGB.
        encoding: Encoding of the pixels, such as ``rgb8``, or ``16UC1`` for depth in mm.
        source: Where the resolution is set.
    """

    width: int = Field(ge=1, le=100_000)
    height: int = Field(ge=1, le=100_000)
    bytes_per_pixel: int = Field(ge=1, le=64)
    encoding: Text | None = None
    source: Text

    @property
    def bytes(self) -> int:
        """Size of an image in bytes."""
        return self.width * self.height * self.bytes_per_pixel


class StreamFacts(CatalogModel):
    """One image stream of a camera.

    Attributes:
        topic: Full name of the image topic; placeholders are filled.
        type: Message type of the images.
        info_topic: Full name of the topic with the camera's intrinsics.
        frame: Optical link of the images, without prefix.
        rate: How often images are published.
        qos: Profile of the image topic: a name such as ``sensor_data``, or its settings.
        info_qos: Profile of ``info_topic``: a name, or its settings.
        view: What the stream can see.
        image: Size of its images.
    """

    topic: GraphName
    type: Text
    info_topic: GraphName
    frame: Token
    rate: Frequency
    qos: QosUse
    info_qos: QosUse
    view: ViewFacts | None = None
    image: ImageFacts | None = None


class CameraFacts(CatalogModel):
    """A camera: its streams, and what its stamps mean.

    Attributes:
        streams: Image streams by name, such as ``color``.
        exposure: Exposure time; one in the spec counts before it.
        exposure_parameters: Parameters of the node that set the exposure, each with its unit, such as
            ``{rgb_camera.exposure: 0.1 ms}``.
        auto_exposure_parameters: Parameters of the node that are set to ``false`` if the spec states an exposure.
        serial_parameter: Parameter of the node that selects the camera by its serial number; an underscore is put
            before it.
        hardware_clock: Whether the camera stamps images by a clock of its own.
        source: Package with its version, or data sheet.
    """

    streams: dict[Token, StreamFacts] = Field(min_length=1)
    exposure: Duration | None = None
    exposure_parameters: dict[Text, Duration] = Field(default_factory=dict)
    auto_exposure_parameters: tuple[Text, ...] = ()
    serial_parameter: Text | None = None
    hardware_clock: bool
    source: Text
