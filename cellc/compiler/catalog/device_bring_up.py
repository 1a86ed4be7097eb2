"""What bring-up needs of a device: its network, its safety states, and what people do and read at it."""

from typing import Literal, Union

from pydantic import Field, model_validator

from cellc.compiler.catalog.catalog_model import (
    CatalogModel,
    DistroName,
    GateName,
    LeftByName,
    MomentName,
    NeedName,
    Text,
    Token,
)
from cellc.compiler.catalog.robot_facts import DrivenBy, HumanStep, StepCondition
from cellc.compiler.spec.quantity import Share
from cellc.contract.vocabulary import GateCode, LeftBy, Moment, RobotSetting


class PortFacts(CatalogModel):
    """One port of the network link between host and device.

    Attributes:
        port: Number of the port, such as ``30004``; the spec may move a port that the driver lets it move.
        protocol: Transport of the port.
        direction: Who opens the connection; on a port of ``device_to_host``, the host listens.
        service: What the port is for, such as ``RTDE``.
    """

    port: int = Field(ge=1, le=65535)
    protocol: Literal["tcp", "udp"]
    direction: Literal["host_to_device", "device_to_host"]
    service: Text


class NetworkFacts(CatalogModel):
    """What the device asks of its network.

    Attributes:
        ports: Ports that host and device use between them.
        default_subnet: Subnet in which the vendor ships the device, such as ``172.16.0.0/24``.
        dedicated_link: Whether the device needs a network card of the host for itself.
        by_carrier: Whether the device has no address of its own: it is reached at that of the device on which it is
            mounted.
        usual_port: Serial or CAN port at which the vendor's own launch files expect this model, such as ``can1``.
        powered: Whether the device answers, and shows its firmware, only while its drives have power.
        realtime: Whether the host needs a real-time kernel; ``required`` and ``recommended`` are checked against the
            kernel of the host.
        source: Document with its version from which these facts were read.
    """

    ports: tuple[PortFacts, ...] = ()
    default_subnet: Text | None = None
    dedicated_link: bool
    by_carrier: bool = False
    usual_port: Text | None = None
    powered: bool = False
    realtime: Literal["required", "recommended", "not_needed"]
    source: Text


class SafetyStateFacts(CatalogModel):
    """A state of the device's own safety controller and how its driver reports it.

    Attributes:
        name: Name of the state, such as ``protective_stop``.
        stops: Whether the device stops in this state.
        moment: Moment of ``effects`` that says what the stop does.
        ends: What a claim needs and no longer has in this state, besides what the moment ends.
        left_by: What ends the stop once its cause is gone.
        reported: How the driver reports the state, such as a value of a topic or an action that ends.
        seen: What people see at the device in a state that its driver does not report.
        trip: How people trip the state while the device moves, from out of its reach; absent where no source says.
        gate: Gate of bring-up in which people look for the state; one that only an activation or an action shows cannot
            be seen earlier.
    """

    name: Token
    stops: bool
    moment: MomentName = Moment.STOP
    ends: tuple[NeedName, ...] = ()
    left_by: LeftByName = LeftBy.ACTIVATION
    reported: Text | None = None
    seen: Text | None = None
    trip: Text | None = None
    gate: GateName = GateCode.G4

    @model_validator(mode="after")
    def _only_a_stop_ends(self) -> "SafetyStateFacts":
        if not self.stops and (self.ends or self.left_by is not LeftBy.ACTIVATION or self.moment is not Moment.STOP):
            raise ValueError("must not have `moment`, `ends` or `left_by` where `stops` is false")
        if self.reported is not None and self.seen is not None:
            raise ValueError("must have `reported` or, where its driver does not report it, `seen`")
        return self


class StateTopicFacts(CatalogModel):
    """A topic, below the node of a controller of this kind, that says in which state the device is.

    Attributes:
        controller: Kind of controller of this device that publishes the topic.
        topic: Name of the topic below the node of the controller, such as ``safety_mode``.
        field: Field of the message that says it; absent for the whole message.
        source: Document or line of code from which this was read.
    """

    controller: Token
    topic: Token
    field: Token | None = None
    source: Text


class RecoveryFacts(CatalogModel):
    """The way out of one state.

    Attributes:
        state: Name of the state, one of ``states``.
        by: Only what reaches the device in this way: ``driver`` for the ROS driver, ``adapter`` for an adapter on the
            library of the vendor. Both if absent.
        steps: Steps in order, those of people first.
    """

    state: Token
    by: DrivenBy | None = None
    steps: tuple[HumanStep, ...] = Field(min_length=1)


class StoppingFacts(CatalogModel):
    """Where the vendor publishes how long the device takes to stop, and how far it goes.

    Attributes:
        figures: What is published, such as ``curves for joints 1 to 3 at three payloads``.
        source: Document with its version, and the page.
    """

    figures: Text
    source: Text


class SafetyFacts(CatalogModel):
    """The vendor's safety boundary; no software of the cell is part of it.

    Attributes:
        stop_authority: What has the authority to stop the device, such as its safety controller.
        states: States of the device's own safety controller.
        reported_by: Topics that say in which state the device is.
        modes: Operating modes of the device, by the vendor's names.
        recovery: Recovery from the states that stop the device.
        ending: What people do at the device when nothing is claimed any more, before its driver ends.
        ended: What people do at the device after its driver has ended.
        power_off: What people do after a loss that leaves the drives powered, before they repeat gates without power.
        watchdog: What the device does when commands stop, and after how long, such as ``20 lost packets in a row stop
            the motion``.
        stopping: Published times and distances of a stop; absent where no public source has them.
        source: Documents with their versions from which these facts were read.
    """

    stop_authority: Text
    states: tuple[SafetyStateFacts, ...] = ()
    reported_by: tuple[StateTopicFacts, ...] = ()
    modes: tuple[Text, ...] = ()
    recovery: tuple[RecoveryFacts, ...] = ()
    ending: tuple[HumanStep, ...] = ()
    ended: tuple[HumanStep, ...] = ()
    power_off: tuple[HumanStep, ...] = ()
    watchdog: Text | None = None
    stopping: StoppingFacts | None = None
    source: Text


class CommissioningStep(CatalogModel):
    """What a person does at the real device in a gate, by its vendor's procedure.

    Attributes:
        gate: Gate of bring-up in which the step is done, such as ``G4``.
        does: What the person does, in full sentences; placeholders such as ``{address}`` are filled.
        log: Texts to look for in the log of the driver. Of the lines that hold one of them, the newest counts, and it
            must hold the first.
        run: Commands that only read; ``{address}`` in them becomes a word of the shell.
        after_release: Whether the step comes after the release of the gate: what must be seen then, or what is first
            done with it.
        powers: Whether the drives have power after the step, so that the stop can be tried.
        moves: Whether a program of the vendor moves the device in the step. It is run after the first goals of G7.
        sets: What the step sets in the robot; `cellc diff` compares it.
        only: Distributions on which the step is done; empty for all.
        when: The step is done only if one of these holds for the device in the spec; empty for always.
        by: Only if the device is reached in this way: ``driver`` for the ROS driver, ``adapter`` for an adapter. Both
            if absent.
        source: Document with its version from which the step was taken.
    """

    gate: GateName
    does: Text
    log: tuple[Text, ...] = ()
    run: tuple[Text, ...] = ()
    after_release: bool = False
    powers: bool = False
    moves: bool = False
    sets: RobotSetting | None = None
    only: tuple[DistroName, ...] = ()
    when: tuple[StepCondition, ...] = ()
    by: DrivenBy | None = None
    source: Text


class RecordFacts(CatalogModel):
    """Where the record of an attempt with the real device has a field from.

    Attributes:
        controller: Kind of controller of this device that publishes the value.
        topic: Name of the topic below the node of the controller.
        field: Field of the message that holds the value, such as ``data``.
        read: Where a person reads the value if no topic has it; it excludes the other three keys.
        source: Document or line of code from which this was read.
    """

    controller: Token | None = None
    topic: Token | None = None
    field: Token | None = None
    read: Text | None = None
    source: Text

    @model_validator(mode="after")
    def _by_a_topic_or_a_person(self) -> "RecordFacts":
        keys = (self.controller, self.topic, self.field)
        if any(part is None for part in keys) == (self.read is None) or (self.read and any(keys)):
            raise ValueError("must have `controller`, `topic` and `field`, or `read` alone")
        return self


class ReadingFacts(CatalogModel):
    """What the running device says of itself, by a topic or a service that changes nothing; ``observe`` shows it.

    Attributes:
        name: What it is, such as ``safety state``.
        controller: Kind of controller of this device below whose node the topic or service is.
        topic: Name of the topic below that node.
        service: Name of the service below that node, which takes no argument; it excludes ``topic``.
        fields: Fields of message or answer, joined by dots where there are several.
        values: Value of the field by its name, such as ``{RUNNING: 7}``; absent for a figure.
        expected: Names of ``values`` of which one must show, by the gate from which on it must; absent where any may.
        version: Part of the version tuple that must be the value, such as ``firmware``.
        source: Document or line of code from which this was read.
    """

    name: Text
    controller: Token
    topic: Token | None = None
    service: Token | None = None
    fields: tuple[Token, ...] = Field(min_length=1)
    values: dict[Text, Union[bool, int]] = Field(default_factory=dict)
    expected: dict[GateName, tuple[Text, ...]] = Field(default_factory=dict)
    version: Literal["firmware"] | None = None
    source: Text

    @model_validator(mode="after")
    def _says_one_thing_in_one_way(self) -> "ReadingFacts":
        if (self.topic is None) == (self.service is None):
            raise ValueError("must have `topic` or `service`, and not both")
        unknown = sorted({name for names in self.expected.values() for name in names} - self.values.keys())
        if unknown:
            raise ValueError(f"`expected` must name keys of `values`, got {', '.join(unknown)}")
        if self.version is not None and self.expected:
            raise ValueError("must have `version` or `expected`, and not both")
        return self


class JogFacts(CatalogModel):
    """How people move one joint of the real device by hand, by its vendor's procedure.

    Attributes:
        driver_runs: Whether the driver reads positions meanwhile; without it people read them at the device.
        before: What people do first, where the driver does not run meanwhile. A device that falls is supported by then.
        does: How people move the joint, and where they read the position if the driver does not run.
        then: What people do before they start the driver again, where it does not run meanwhile.
        source: Document with its version from which this was read.
    """

    driver_runs: bool = False
    before: Text | None = None
    does: Text
    then: Text | None = None
    source: Text


class SpeedControlFacts(CatalogModel):
    """What of the real device slows every motion down.

    Attributes:
        name: Name of it, such as ``speed slider``; absent where the device has none.
        does: How people set it, where the device has one.
        low: What the first motions are made with, where the device has one; goals take longer by it.
        because: Why nothing slows motions down, where the device has none.
        source: Document with its version from which this was read.
    """

    name: Text | None = None
    does: Text | None = None
    low: Share | None = None
    because: Text | None = None
    source: Text

    @model_validator(mode="after")
    def _one_or_none(self) -> "SpeedControlFacts":
        parts = (self.name, self.does, self.low)
        if any(part is None for part in parts) == (self.because is None) or (self.because and any(parts)):
            raise ValueError("must have `name`, `does` and `low`, or `because` alone")
        return self
