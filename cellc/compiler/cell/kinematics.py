"""What the description of a device rests on: the vendor's own package, and the joints of this very robot."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.compiler.cell.entity import Entity
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
