"""Devices of ``contract.json``: what the mock needs of each, adapters with bounds, joints that lag or have noise."""

import math
from typing import Annotated, Literal

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.control_law import ControlLaw
from cellc.contract.entities import HardwareState
from cellc.contract.grading import DEVIATES, FASTER, HARDER, LONGER, SECOND_CLIENT, UNSEEN, Graded, Rule
from cellc.contract.quantities import (
    Coordinate,
    Magnitude,
    Period,
    Pixels,
    PositiveMagnitude,
    PositiveSeconds,
    Rate,
    Seconds,
)
from cellc.contract.vocabulary import LeftBy, ManagerLock, Moment, Motion, Need, ReviewArea, Unmet


class ContractGripper(ContractModel):
    """A gripper in its joint's units: rad or m."""

    joint: str = Field(description="Joint that is commanded.")
    controller: str | None = Field(
        None, description="Controller that moves it; by full name where managers share names."
    )
    open: Coordinate = Field(description="Position when open.")
    closed: Coordinate = Field(description="Position when closed on nothing.")
    max_effort: Annotated[Magnitude, Graded(ReviewArea.LIMITS, "grip force", Rule.FIGURE, "N", why=HARDER)] = Field(
        description="Largest effort, N or Nm."
    )
    max_velocity: Annotated[
        PositiveMagnitude | None,
        Graded(ReviewArea.LIMITS, "speed of the jaws' joint", Rule.MORE, "joint/s", why=FASTER),
    ] = Field(None, description="Speed of the joint as the jaws move, rad/s or m/s; null where it is not stated.")
    goal_tolerance: Magnitude = Field(0.0, description="How far the joint may end from its goal, rad or m.")
    stroke_m: Annotated[Magnitude, Graded(ReviewArea.DEVICES, "stroke")] = Field(
        0.0, description="How far its jaws are apart when open."
    )
    swing: Coordinate | None = Field(
        None, description="Angle between the cranks of its jaws and its fingers when closed; null where jaws slide."
    )

    @property
    def unit(self) -> str:
        """Unit of the positions of its joint: jaws that slide have lengths."""
        return "m" if self.swing is None else "rad"

    def position(self, width_m: float) -> float:
        """Return the position of its joint with the jaws so far apart, rad or m.

        Jaws that slide go in proportion to the joint. Those on cranks, an angle u from closed, are apart in proportion
        to sin(u + swing) - sin(swing).
        """
        way = self.open - self.closed
        share = min(1.0, max(0.0, width_m / self.stroke_m)) if self.stroke_m > 0.0 else 0.0
        if self.swing is None:
            return self.closed + way * share
        least, most = math.sin(self.swing), math.sin(self.swing + abs(way))
        return self.closed + math.copysign(math.asin(least + (most - least) * share) - self.swing, way)


class ContractImages(ContractModel):
    """One image stream of a camera, as its node is started and as far as the catalog knows it."""

    topic: str = Field(description="Full name of the image topic.")
    info_topic: str = Field(description="Full name of the topic with the intrinsics.")
    frame: str = Field(description="Optical frame: x to the right, y down, z forward.")
    width: Pixels = Field(description="Width in pixels.")
    height: Pixels = Field(description="Height in pixels.")
    encoding: str = Field(description="Encoding of the pixels, such as `rgb8`, or `16UC1` for depth in mm.")
    horizontal: PositiveMagnitude = Field(description="Whole horizontal angle of view, rad.")
    vertical: PositiveMagnitude = Field(description="Whole vertical angle of view, rad.")
    nearest_m: Magnitude = Field(description="Least distance along the optical axis.")
    farthest_m: PositiveMagnitude = Field(description="Greatest distance along the optical axis.")


class ContractCamera(ContractModel):
    """The stream that perception uses."""

    topic: str = Field(description="Full name of the image topic.")
    frame: str = Field(description="Optical frame of the images.")
    rate_hz: Annotated[Rate, Graded(ReviewArea.DEVICES, "rate of images", share=False)] = Field(
        description="Frames a second."
    )
    exposure_s: Annotated[Seconds, Graded(ReviewArea.TIME)] = Field(description="Exposure time.")
    clock: str = Field(description="Clock domain of the stamps.")
    images: tuple[ContractImages, ...] = Field((), description="Its streams, where their size and view are known.")


class ContractDriver(ContractModel):
    """A driver's own node, which moves a device on real hardware past every controller manager."""

    node: str = Field(description="Full name of the node.")
    program: str = Field(description="Package and executable.")
    joint_states: str | None = Field(None, description="Topic on which its program publishes joints, before remapping.")


class ContractEffect(ContractModel):
    """What one moment in the life of a real device does in the world, as far as the mock plays it."""

    motion: Motion = Field(Motion.NONE, description="What moves.")
    lock: ManagerLock = Field(ManagerLock.NONE, description="For how long its controller manager is blocked.")
    needs: dict[Need, Unmet] = Field({}, description="What must hold before it, and what happens otherwise.")
    largest_step: PositiveMagnitude | None = Field(
        None, description="Distance of a set point that is still followed, rad or m; null without bound."
    )
    leaves: HardwareState | None = Field(
        None, description="State of the component afterwards; null for the one that was asked for."
    )
    ends: tuple[Need, ...] = Field((), description="What a claim needs and no longer has afterwards.")


class ContractStop(ContractModel):
    """A state in which a device stops by itself."""

    motion: Motion = Field(Motion.NONE, description="What moves.")
    leaves: HardwareState = Field(description="State of the component meanwhile.")
    ends: tuple[Need, ...] = Field((), description="What a claim needs and does not have meanwhile.")
    left_by: LeftBy = Field(description="What ends it once its cause is gone.")


class ContractSwitched(ContractModel):
    """A device of a few states that digital outputs switch, or that its sensors tell."""

    states: dict[str, dict[str, bool]] = Field(description="What the sensors that are wired read in each state.")
    starts: str = Field(description="State at power-up.")
    time_s: Seconds = Field(0.0, description="Time from its outputs to the end of its way.")
    within_s: PositiveSeconds = Field(description="How long its client waits for the sensors.")
    holds: str | None = Field(None, description="State in which it holds a part or a tool.")
    outputs: dict[str, str] = Field({}, description="Command interface that drives each output.")
    inputs: dict[str, str] = Field({}, description="State interface that reads each sensor.")


class ContractDevice(ContractModel):
    """A device as the mock needs it."""

    model: Annotated[str, Graded(ReviewArea.DEVICES, rule=Rule.REPLACED)] = Field(description="Catalog entry.")
    kind: str = Field(description="Kind of device.")
    prefix: str = Field(description="Put before its joint and link names.")
    root_link: str = Field(description="Link that is mounted.")
    architecture: Annotated[str, Graded(ReviewArea.DEVICES, "owner of the command path", Rule.DANGEROUS)] = Field(
        "ros2", description="Who owns the command path."
    )
    hardware_component: str | None = Field(None, description="Name of its ros2_control component.")
    driver: ContractDriver | None = Field(None, description="What moves it where it has no component on real hardware.")
    speed_scaling_interface: str | None = Field(None, description="State interface of its speed scaling.")
    gripper: Annotated[ContractGripper | None, Graded(ReviewArea.DEVICES)] = Field(
        None, description="What a gripper adds."
    )
    camera: ContractCamera | None = Field(None, description="What a camera adds.")
    switched: ContractSwitched | None = Field(None, description="What a device that outputs switch adds.")
    law: ControlLaw | None = Field(
        None, description="How its real joints follow commands; null where nothing moves it on a path."
    )
    effects: dict[Moment, ContractEffect] = Field(
        {}, description="What its real hardware does as it is activated and claimed, and as its program or link ends."
    )
    stops: dict[str, ContractStop] = Field({}, description="States in which it stops by itself.")
    reports: dict[Need, str] = Field({}, description="Topic on which the cell hears whether a claim has what it needs.")
    nan_after_inactive: bool = Field(
        False, description="The driver holds NaN commands after `inactive`; activate it directly."
    )
    command_timeout_s: PositiveSeconds | None = Field(
        None, description="Longest silence of its manager before the real hardware ends its program."
    )


class ContractAdapter(ContractModel):
    """A device that its vendor's library drives behind an adapter, where no controller does."""

    joints: tuple[str, ...] = Field(description="Joints in the order of states and commands.")
    units: tuple[Literal["rad", "m"], ...] = Field(description="Unit of each joint's position.")
    action: str = Field(description="Full name of the action that takes its trajectories.")
    state_topic: str = Field(description="Full name of the topic of its stamped state.")
    client: Annotated[str | None, Graded(ReviewArea.CONTROL, "permitted client", Rule.DANGEROUS, why=SECOND_CLIENT)] = (
        Field(None, description="Name of the one node that may command it.")
    )
    command_period_s: Period = Field(description="Time from one command to the next.", gt=0.0)
    command_timeout_s: Annotated[PositiveSeconds, Graded(ReviewArea.CONTROL, "watchdog", Rule.LOOSER, why=LONGER)] = (
        Field(description="Watchdog: silence after which it stops.", gt=0.0)
    )
    stop_time_s: Annotated[PositiveSeconds, Graded(ReviewArea.CONTROL, "time to stop", Rule.FIGURE, why=LONGER)] = (
        Field(description="Longest time from a hold to standstill.", gt=0.0)
    )
    goal_time_s: Annotated[Seconds, Graded(ReviewArea.CONTROL, "time past the end", Rule.LOOSER, why=UNSEEN)] = Field(
        description="Time past the end of a trajectory until standstill.", gt=0.0
    )
    path_tolerance: Annotated[PositiveMagnitude, Graded(ReviewArea.CONTROL, "", Rule.LOOSER, "joint", why=DEVIATES)] = (
        Field(description="Distance from the command that ends a goal, rad or m.", gt=0.0)
    )
    start_positions: tuple[Coordinate, ...] = Field(description="Where the mock's joints stand at first, rad or m.")


class ContractSimulatedJoint(ContractModel):
    """A joint that lags, saturates or is measured with noise; rad and rad/s, or m and m/s."""

    lag_s: Seconds = Field(0.0, description="Time constant of a first-order lag; 0 for no lag.")
    noise: Magnitude = Field(0.0, description="Largest error of the measured position; 0 for no error.")
    max_velocity: PositiveMagnitude | None = Field(
        None, description="Speed at which it saturates; null where it does not."
    )
