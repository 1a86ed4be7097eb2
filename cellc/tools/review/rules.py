"""How changes are graded: one row for each kind of value and of thing, in the order of docs/review.md.

The first row whose pattern fits a path counts. A part of a pattern in braces means any name, and the names are the
subject; `...` at the end represents whatever follows. What a row that `follows` tells is a repetition: it is reported
only where no other change explains it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import get_args

from cellc.contract.grading import LONGER, OTHER_LOAD, Graded
from cellc.contract.vocabulary import ApprovalArea, AttemptOutcome, GateCode, Grade, ReviewArea
from cellc.tools.review.leaves import Leaves, Path

_A = ReviewArea


@dataclass(frozen=True, slots=True)
class Row:
    """One kind of value.

    Args:
        pattern: path with braces for names, parts separated by a blank; `{what}` is the part that changed, `{_}` any
            part.
    """

    pattern: str
    grade: Graded

    @property
    def parts(self) -> tuple[str, ...]:
        """The pattern part by part."""
        return tuple(self.pattern.split(" "))


@dataclass(frozen=True, slots=True)
class Thing:
    """A kind of thing that is added or removed as a whole; its values are then not reported one by one.

    Args:
        shown: the value that is reported with it.
        follows: it is reported only where nothing else of its name was added or removed.
        asks: areas of approval that are asked beside that of the area.
        holds: what it must have had for its removal to be dangerous; of one without that it is reviewed.
    """

    pattern: str
    area: ReviewArea
    noun: str
    added: Grade
    removed: Grade
    breaking: bool = False
    shown: str = ""
    why: str = ""
    follows: bool = False
    holds: str = ""
    asks: tuple[ApprovalArea, ...] = ()

    @property
    def parts(self) -> tuple[str, ...]:
        """The pattern part by part."""
        return tuple(self.pattern.split(" "))


_S, _R, _D = Grade.SAFE, Grade.REVIEW, Grade.DANGEROUS

_UNMEASURED = "its frames rest on no measurement"
_UNHELD = "the joints that it held have no controller"
_UNCOMPARED = "what is set in the robot is no longer compared"

THINGS: Sequence[Thing] = (
    Thing("contract frames {frame}", _A.FRAMES, "frame", _R, _R, breaking=True, shown="parent"),
    Thing("placement {frame}", _A.FRAMES, "pose", _R, _R, follows=True),
    Thing(
        "contract calibrations {calibration}", _A.CALIBRATION, "calibration", _R, _D, shown="revision", why=_UNMEASURED
    ),
    Thing("interface {interface}", _A.INTERFACES, "interface", _R, _R, breaking=True, shown="type"),
    Thing("interface {interface} publishers {node}", _A.INTERFACES, "publisher", _R, _R, breaking=True),
    Thing("interface {interface} subscribers {node}", _A.INTERFACES, "subscriber", _S, _R),
    Thing(
        "interface {interface} servers {node}",
        _A.INTERFACES,
        "server",
        _D,
        _D,
        breaking=True,
        why="another server answers",
    ),
    Thing(
        "interface {interface} clients {node}", _A.CONTROL, "client", _D, _R, why="another client may request motion"
    ),
    Thing(
        "controller {controller}",
        _A.CONTROL,
        "controller",
        _R,
        _D,
        shown="plugin",
        why=_UNHELD,
        holds="command_interfaces",
    ),
    Thing("manager {manager} switches {switch}", _A.CONTROL, "controller switch", _R, _R),
    Thing("manager {manager}", _A.CONTROL, "controller manager", _R, _D, why=_UNHELD),
    Thing("contract clocks {clock}", _A.TIME, "clock", _R, _R),
    Thing("contract devices {device}", _A.DEVICES, "device", _R, _R, shown="model"),
    Thing("contract adapters {device}", _A.CONTROL, "adapter", _R, _D, why="nothing bounds the commands of the device"),
    Thing("contract joint_limits {joint}", _A.LIMITS, "limits", _R, _D, why="the joint no longer has limits"),
    Thing("stage {stage}", _A.LIMITS, "stage of commissioning", _S, _D, why="planned motion has one stage fewer"),
    Thing("contract groups {group}", _A.MOTION, "planning group", _R, _R),
    Thing("contract poses {pose}", _A.MOTION, "named pose", _S, _R),
    Thing("contract goals {goal}", _A.MOTION, "goal", _S, _R),
    Thing(
        "rehearsals {rehearsal}",
        _A.REHEARSALS,
        "rehearsal",
        _S,
        _R,
        shown="expect",
        why="this behavior is no longer rehearsed",
    ),
    Thing(
        "step real {step}",
        _A.START_ORDER,
        "hardware startup step",
        _D,
        _D,
        shown="phase",
        why="hardware starts in another way",
    ),
    Thing("step mock {step}", _A.START_ORDER, "mock startup step", _R, _R, shown="phase", follows=True),
    Thing(
        "watch {watch}",
        _A.SAFETY,
        "watch that deactivates controllers",
        _S,
        _D,
        why="controllers may stay active though their device stopped",
    ),
    Thing("check payload {device}", _A.PAYLOAD, "payload to set in the robot", _R, _D, shown="mass", why=OTHER_LOAD),
    Thing("check tcp {device}", _A.PAYLOAD, "TCP to set in the robot", _R, _D, why=_UNCOMPARED),
    Thing("check load {device}", _A.PAYLOAD, "load to set in the robot", _R, _D, why=OTHER_LOAD),
    Thing("check joint_impedance {device}", _A.SAFETY, "impedance of the joints", _R, _D, why=_UNCOMPARED),
    Thing("check tool_impedance {device}", _A.SAFETY, "impedance at the tool", _R, _D, why=_UNCOMPARED),
    Thing(
        "check tool_voltage {device}",
        _A.SAFETY,
        "voltage of the tool connector",
        _D,
        _R,
        why="a tool for another voltage fails, or is destroyed",
    ),
    Thing("check thresholds {device}", _A.SAFETY, "collision thresholds of the robot", _R, _D, why=_UNCOMPARED),
    Thing("area {area}", _A.SAFETY, "shared area", _R, _D, why="arms may meet in it"),
    Thing("excused blocker {finding}", _A.GATES, "excuse of a blocker", _D, _S, why="the finding no longer blocks"),
    Thing("excused {_} {finding}", _A.GATES, "excuse of a finding", _R, _S),
    Thing(
        "real shapes {link}",
        _A.MODEL,
        "collision shapes",
        _R,
        _D,
        why="planning no longer avoids `{}`",
        follows=True,
    ),
    Thing("real inertia {link}", _A.MODEL, "mass and inertia", _R, _R, follows=True),
    Thing("real joint {joint}", _A.MODEL, "joint", _R, _R, shown="type"),
    Thing(
        "real hardware {component}",
        _A.CONTROL,
        "hardware component",
        _R,
        _D,
        shown="plugin",
        why="nothing drives its joints",
    ),
    Thing("parameters {_} {node}", _A.CONTROL, "parameters of a node", _R, _R, follows=True),
    Thing("spec nodes {node}", _A.CONTROL, "node", _R, _R, shown="package", asks=("graph",)),
    Thing(
        "file config/frames.yaml calibrations {calibration}",
        _A.CALIBRATION,
        "measurement",
        _R,
        _D,
        why=_UNMEASURED,
        follows=True,
    ),
    Thing("file config/recording_qos.yaml {topic}", _A.FIGURES, "recording", _R, _R, follows=True),
    Thing(
        "file config/uncertainty.json quantities {quantity}",
        _A.REHEARSALS,
        "sweep quantity",
        _R,
        _R,
        shown="source",
    ),
    Thing("file {file}", _A.CONTROL, "parameter file", _R, _R, follows=True),
    Thing("contract clock_of {node}", _A.TIME, "stamp clock", _R, _R, follows=True),
)
"""An added or removed thing is listed once; where rows of both tables fit, the thing counts."""

AREA_OF_FILE: Sequence[tuple[str, ReviewArea]] = (
    ("gates/", _A.GATES),
    ("middleware/", _A.NETWORK),
    ("security/", _A.NETWORK),
    ("launch/", _A.START_ORDER),
    ("scripts/", _A.START_ORDER),
    ("sources.repos", _A.VERSIONS),
    ("package.xml", _A.VERSIONS),
    ("urdf/", _A.MODEL),
    ("sim/", _A.MODEL),
    ("config/moveit/", _A.MOTION),
    ("config/", _A.CONTROL),
)
"""Area of a file by the beginning of its path; what is not one of these is a document."""

APPROVAL: Mapping[ReviewArea, ApprovalArea] = {
    _A.SAFETY: "safety",
    _A.CALIBRATION: "time_tf",
    _A.FRAMES: "time_tf",
    _A.TIME: "time_tf",
    _A.MODEL: "controller",
    _A.PAYLOAD: "vendor",
    _A.LIMITS: "controller",
    _A.CONTROL: "controller",
    _A.MOTION: "controller",
    _A.INTERFACES: "graph",
    _A.QOS: "graph",
    _A.DEVICES: "vendor",
    _A.VERSIONS: "vendor",
    _A.NETWORK: "network",
    _A.START_ORDER: "graph",
    _A.GATES: "safety",
    _A.REHEARSALS: "data",
    _A.OWNERS: "graph",
    _A.FIGURES: "data",
    _A.DOCUMENTS: "graph",
}
"""Area of approval for each area of a change."""


def approval_of(path: Path) -> ApprovalArea | None:
    """Return the area of approval of a value that its area alone does not decide: that is asked beside it.

    The owner of an approval area has a say when another takes it over; stiffness is a matter of safety, too.
    """
    if path[:2] == ("contract", "approvals"):
        return next((area for area in get_args(ApprovalArea) if area == path[2]), None)
    return "safety" if path[:2] == ("contract", "devices") and path[3:5] == ("law", "joints") else None


_STOPS = (AttemptOutcome.EMERGENCY_STOP, AttemptOutcome.PROTECTIVE_STOP)


def is_stop_timing(row: Row, path: Path, leaves: Leaves) -> bool:
    """Tell whether a value says how soon motion stops: a watchdog, a time to stop, a bound of a rehearsed stop.

    Safety is asked of it, too.
    """
    is_bound = path[0] == "rehearsals" and path[2:] == ("within_s",)
    return row.grade.why == LONGER or (is_bound and leaves.get((*path[:2], "expect")) in _STOPS)


_G = GateCode
REPEATED: Mapping[ReviewArea, tuple[GateCode, ...]] = {
    _A.SAFETY: (_G.G5,),
    _A.CALIBRATION: (_G.G1, _G.L5),
    _A.FRAMES: (_G.G1, _G.L5),
    _A.TIME: (_G.G3, _G.L5),
    _A.MODEL: (_G.G1,),
    _A.PAYLOAD: (_G.G5,),
    _A.LIMITS: (_G.G1,),
    _A.CONTROL: (_G.G2, _G.L6),
    _A.MOTION: (_G.G2,),
    _A.INTERFACES: (_G.G2, _G.L3),
    _A.QOS: (_G.G2, _G.L4),
    _A.DEVICES: (_G.G0, _G.L1),
    _A.VERSIONS: (_G.G0, _G.L2),
    _A.NETWORK: (_G.G3, _G.L1),
    _A.START_ORDER: (_G.G2, _G.L6),
    _A.GATES: (_G.G0, _G.L1),
    _A.REHEARSALS: (_G.G2,),
    _A.OWNERS: (),
    _A.FIGURES: (_G.G7,),
    _A.DOCUMENTS: (),
}
"""First gate, and first layer, that a change asks for again: what comes after them rests on them."""


def fits(pattern: Sequence[str], path: Path) -> Fit | None:
    """Return what a path names where a pattern fits it; None where it does not."""
    open_end = pattern[-1] == "..."
    fixed = pattern[:-1] if open_end else pattern
    if len(path) < len(fixed) or (len(path) > len(fixed) and not open_end):
        return None
    subject, of = list[str](), list[str]()
    for wanted, part in zip(fixed, path, strict=False):
        if wanted == "{what}":
            of.append(part)
        elif wanted.startswith("{"):
            subject += [part] if wanted != "{_}" else []
        elif wanted != part:
            return None
    return Fit(tuple(subject), (*of, *path[len(fixed) :]))


@dataclass(frozen=True, slots=True)
class Fit:
    """The names of the subject in a path, and the part of it that changed where the pattern leaves that open."""

    subject: tuple[str, ...]
    of: tuple[str, ...]


HANDED = "owner of "
"""How the quantity begins of what somebody is responsible for; who hands it over is asked, too."""
LATER = "center of mass"
"""What is listed behind the mass that it is of."""


def quantity_of(row: Row, fit: Fit) -> str:
    """Return what changed of a subject, in words."""
    of = ".".join(fit.of).removesuffix("_kg")
    return f"{row.grade.quantity} {LATER if of == 'center_of_mass' else of}".rstrip()
