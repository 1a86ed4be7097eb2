"""The links of a device: its description and what that rests on, and where the cell has it mounted."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import field
from typing import Annotated

from cellc.compiler.cell.entity import ELSEWHERE, STATED, Entity, Part, Places
from cellc.compiler.cell.frame import WORLD
from cellc.contract.frozen import dataclass
from cellc.contract.grading import Graded
from cellc.contract.transforms import Pose, identity
from cellc.contract.vocabulary import ReviewArea
from cellc.robot.description.model import Description


@dataclass(frozen=True, slots=True, kw_only=True)
class VendorDescription:
    """The description of the vendor's own package, as far as that is available.

    Args:
        package: its name; ``folder`` is where it was found, empty where it was not.
        description: prefix applied; None where it is not at hand or cannot be read, and ``refused`` says why.
    """

    package: str
    folder: str = ""
    description: Description | None = None
    refused: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class KinematicCalibration(Entity):
    """A file of one robot's kinematics; ``name`` is its path as written.

    Args:
        sha256: of its text.
        hash: what names the table in the robot; the driver compares it.
        measured, owner: as written; UNKNOWN where nothing is.
        offset_m, turn_rad: the most by which a joint differs from that of the type.
    """

    sha256: str
    hash: str
    measured: str
    owner: str
    offset_m: float
    turn_rad: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Kinematics:
    """Whether the description has the joints of this very robot, or those of its type.

    Args:
        tool: the command that reads them off the robot, into ``FILE``, for people to read; ``package`` has it.
        command: the same with ``{address}``, which becomes a word of the shell.
        state: what the robot is in meanwhile.
        nominal_hash: what names the table of the type.
        calibration: the file that they are from; None where they are nominal.
    """

    tool: str
    command: str
    package: str | None
    state: str
    nominal_hash: str
    calibration: KinematicCalibration | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Body(Part):
    """Links and frames of a device; names of links carry the prefix, those of frames do not.

    Args:
        description: links and joints; frames as URDF.
        root_link: the link that is mounted.
        frames: short names of the catalog and local link names → links.
        tool_frame: the link where tools mount, for an arm.
        optical_frames: short names of frames that look along z.
        vendor_description: that of the vendor's package, whose shapes the links have; None where none is known.
        kinematics: whose joints the description has; None where robots of the type do not differ.
        allowed_collisions: pairs of links whose contact is not looked for.
        excused: codes of findings on the description that its folder excuses, and why.
        places: where the user wrote what of its `device.yaml`; None of a device of the catalog.
    """

    prefix: Annotated[str, STATED] = ""
    description: Annotated[Description, ELSEWHERE]
    root_link: str
    frames: Mapping[str, str] = field(default_factory=dict)
    tool_frame: str | None = None
    optical_frames: Annotated[tuple[str, ...], ELSEWHERE] = ()
    vendor_description: VendorDescription | None = None
    kinematics: Kinematics | None = None
    allowed_collisions: tuple[tuple[str, str], ...] = ()
    excused: Mapping[str, str] = field(default_factory=dict)
    places: Annotated[Places | None, ELSEWHERE] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class VendorMount:
    """How the vendor hangs a device on an arm of one model: on its frame of a short name, in this pose."""

    model: str
    frame: str
    pose: Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Mount(Part):
    """Where a device is, and what is mounted on it.

    Args:
        transform_root_to_parent: pose of the root link in ``parent_frame``.
        mounted_on: the day on which it was mounted for the last time; None where the spec does not say.
        vendor_mounts: how its vendor hangs it on arms, where the catalog tells.
        carries: devices mounted on this one, directly or on a frame of it.
    """

    parent_frame: str = WORLD
    transform_root_to_parent: Pose = field(default_factory=identity)
    mounted_on: Annotated[datetime.date | None, Graded(ReviewArea.CALIBRATION, "date of mounting")] = None
    vendor_mounts: tuple[VendorMount, ...] = ()
    carries: tuple[str, ...] = ()
