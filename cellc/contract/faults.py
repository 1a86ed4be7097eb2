"""Faults of rehearsals, each declared once: its word, what it does, what it hits, by how much, how a run ends.

Models, schema and reference of the spec, linking, unknown names, completion, the layers of failures and the S2 gate
follow from a member of ``FaultKind``. ``cellc.mock.faults`` plays each kind.
"""

from __future__ import annotations

from collections.abc import Container
from typing import Literal

from cellc.contract.fault_declaration import Amount, By, Declared, FaultTarget, Hits, Interaction
from cellc.contract.vocabulary import AttemptOutcome, Term

GoalStep = Literal["move", "grip"]
"""Kinds of steps that send a goal to a controller, so that joints move."""
MOST_CYCLES = 100_000


_FRAME = Hits(FaultTarget.FRAME, "Frame.", "object")
_JOINT = Hits(FaultTarget.JOINT, "Joint, as `device/joint`.", "arm/elbow_joint")
_DEVICE = Hits(FaultTarget.STOPPABLE, "Device.", "arm")
_PROGRAMMED = Hits(FaultTarget.PROGRAMMED, "Device whose set points pass through a program.", "arm")
_LATE = (Interaction.LATE_SAMPLE,)
_SILENT = (Interaction.MISSING_RESPONDER,)
_BY_VENDOR = (
    AttemptOutcome.HARDWARE_FAULT,
    AttemptOutcome.CLAIM_FAILURE,
    AttemptOutcome.TOLERANCE_VIOLATION,
    AttemptOutcome.TIMEOUT,
    AttemptOutcome.UNCOMMANDED_MOTION,
    AttemptOutcome.GRIP_FAILURE,
)
"""Where a driver calls a stop a fault, or reports none, also of fingers, and where the device goes on by itself."""
_OFF_TRACK = (AttemptOutcome.TOLERANCE_VIOLATION, AttemptOutcome.GRIP_FAILURE)
"""The latter of fingers, which hold no part where they are."""
_CLAIM_OR_MOTION = (AttemptOutcome.CLAIM_FAILURE, AttemptOutcome.UNCOMMANDED_MOTION)


class FaultKind(Term):
    """What can be made to fail in a rehearsal."""

    meaning: str
    hits: Hits
    layers: tuple[AttemptOutcome, ...]
    by: By | None
    shows: tuple[Interaction, ...]

    def __new__(
        cls,
        word: str,
        meaning: str,
        hits: Hits,
        layers: tuple[AttemptOutcome, ...],
        by: By | None,
        shows: tuple[Interaction, ...],
    ) -> FaultKind:
        """Make a member of the parts of its ``Declared``."""
        kind = str.__new__(cls, word)
        kind._value_ = word
        kind.meaning, kind.hits, kind.layers, kind.by, kind.shows = meaning, hits, layers, by, shows
        return kind

    FREEZE = Declared(
        "freeze",
        "A device repeats its last sample with its old stamp: a camera its image, an arm its joint state.",
        Hits(FaultTarget.STREAM, "Camera, or device with joints.", "camera"),
        (AttemptOutcome.STALE_STATE,),
        shows=_LATE,
    )
    DELAY = Declared(
        "delay",
        "The samples of a device arrive late: the images of a camera, the joint states of an arm.",
        Hits(FaultTarget.STREAM, "Camera, or device with joints.", "arm"),
        (AttemptOutcome.STALE_STATE,),
        By(Amount.DELAY, "How late.", "300 ms"),
        _LATE,
    )
    DROP_FRAME = Declared(
        "drop_frame", "A frame is no longer published.", _FRAME, (AttemptOutcome.TF_FAILURE,), shows=_LATE
    )
    DOUBLE_FRAME = Declared(
        "double_frame",
        "A second node publishes a frame, and places it elsewhere.",
        _FRAME,
        (AttemptOutcome.TF_FAILURE,),
    )
    JUMP_CLOCK = Declared(
        "jump_clock",
        "A clock jumps, forwards, or back with a negative duration.",
        Hits(FaultTarget.CLOCK, "Host, device with a clock of its own, or domain.", "ros"),
        (AttemptOutcome.STALE_STATE, AttemptOutcome.TF_FAILURE),
        By(Amount.JUMP, "How far.", "-1 s"),
    )
    MISMATCH_QOS = Declared(
        "mismatch_qos",
        "An endpoint comes back with a profile that its peers do not match: it is never connected again.",
        Hits(FaultTarget.INTERFACE, "Interface.", "/object_pose"),
        (AttemptOutcome.STALE_STATE, AttemptOutcome.TF_FAILURE, AttemptOutcome.TIMEOUT),
        shows=_LATE + _SILENT,
    )
    UNRESPONSIVE = Declared(
        "unresponsive",
        "A server answers nothing: no goal response, no result, no answer to a cancel.",
        Hits(FaultTarget.SERVER, "Controller with an action, or node that serves one.", "move_group"),
        (AttemptOutcome.TIMEOUT,),
        shows=_SILENT,
    )
    UNREACHABLE = Declared(
        "unreachable",
        "A goal moves out of the reach of its group.",
        Hits(FaultTarget.GOAL, "Goal.", "pick"),
        (AttemptOutcome.PLANNING_FAILURE,),
    )
    REJECT = Declared(
        "reject",
        "A controller is inactive when its goal arrives.",
        Hits(FaultTarget.CONTROLLER, "Controller.", "arm_trajectory"),
        (AttemptOutcome.GOAL_REJECTION, AttemptOutcome.STALE_STATE),  # the latter of a broadcaster
        shows=_SILENT,
    )
    CANCEL = Declared(
        "cancel",
        "The client cancels the goal that is executing, or the first that executes after.",
        Hits(FaultTarget.STEP, "Kind of step whose goal is canceled.", "move"),
        (AttemptOutcome.CANCELED,),
    )
    SECOND_COMMANDER = Declared(
        "second_commander",
        "Another client sends a goal to the action of a controller.",
        Hits(FaultTarget.COMMANDED, "Controller.", "arm_trajectory"),
        (AttemptOutcome.WRONG_OWNER,),
    )
    SWITCH = Declared(
        "switch",
        "Somebody switches controllers: as a declared switch says, or one controller off and on again.",
        Hits(FaultTarget.SWITCH, "Declared switch, or controller that is restarted.", "to_effort"),
        (AttemptOutcome.WRONG_OWNER, AttemptOutcome.GOAL_REJECTION),
    )
    STICK = Declared("stick", "A joint no longer follows its command.", _JOINT, _OFF_TRACK)
    SLOW = Declared(
        "slow",
        "A joint follows its command no faster than it can.",
        _JOINT,
        (*_OFF_TRACK, AttemptOutcome.TIMEOUT),
        By(Amount.VELOCITY, "Its speed.", "2 deg/s"),
    )
    DISPLACE = Declared(
        "displace",
        "A joint is offset from its command, as after a push or a slipped gear.",
        _JOINT,
        _OFF_TRACK,
        By(Amount.DISPLACEMENT, "How far.", "0.3 rad"),
    )
    SCALE_SPEED = Declared(
        "scale_speed",
        "A device scales its speed, as with a slider or a safety function.",
        Hits(FaultTarget.SCALED, "Device with speed scaling.", "arm"),
        (AttemptOutcome.TIMEOUT,),
        By(Amount.FACTOR, "Share of the programmed speed.", "0 %"),
    )
    SKIP_CYCLES = Declared(
        "skip_cycles",
        "The update loop misses cycles.",
        Hits(FaultTarget.LOOP, "Number of cycles in a row.", 5),
        (AttemptOutcome.MISSED_CYCLE,),
    )
    WRONG_PAYLOAD = Declared(
        "wrong_payload",
        "An arm carries another load than the one set in it: it stops itself whenever it moves.",
        Hits(FaultTarget.ARM, "Arm.", "arm"),
        (AttemptOutcome.PROTECTIVE_STOP, *_BY_VENDOR),
    )
    PROTECTIVE_STOP = Declared(
        "protective_stop",
        "A device stops by itself, as its driver shows it; ``lasting`` until a person has acknowledged at the device.",
        Hits(FaultTarget.PROTECTED, "Device.", "arm"),
        (AttemptOutcome.PROTECTIVE_STOP, *_BY_VENDOR),
    )
    SAFEGUARD_STOP = Declared(
        "safeguard_stop",
        "A door or light curtain stops a device; ``lasting`` until it is closed, at which some devices go on.",
        Hits(FaultTarget.GUARDED, "Device.", "arm"),
        (AttemptOutcome.PROTECTIVE_STOP, *_BY_VENDOR),
    )
    EMERGENCY_STOP = Declared(
        "emergency_stop",
        "The drives of a device lose their power, as its driver shows it; ``lasting`` until a person has restored it.",
        Hits(FaultTarget.POWERED, "Device.", "arm"),
        (AttemptOutcome.EMERGENCY_STOP, *_BY_VENDOR),
    )
    RESTART_DRIVER = Declared(
        "restart_driver",
        "The driver of a device ends and comes back after ``lasting``: unconfigured, with an old goal waiting.",
        _DEVICE,
        (AttemptOutcome.HARDWARE_FAULT,),
    )
    CUT_NETWORK = Declared(
        "cut_network",
        "Nothing passes between a device and its host.",
        Hits(FaultTarget.STREAM, "Device.", "arm"),
        (*_BY_VENDOR, AttemptOutcome.STALE_STATE),
        shows=_LATE,
    )
    PROGRAM_STOP = Declared(
        "program_stop",
        "The program on a device's own controller stops; it follows no set points until it starts, after ``lasting``.",
        _PROGRAMMED,
        (AttemptOutcome.CLAIM_FAILURE, AttemptOutcome.TIMEOUT),  # the latter where nothing watches the program
    )
    PROGRAM_PAUSE = Declared(
        "program_pause",
        "The program on a device's own controller pauses, goals and claims stay alive; it goes on after ``lasting``.",
        Hits(FaultTarget.PAUSING, "Device whose program pauses.", "arm"),
        (AttemptOutcome.CLAIM_FAILURE, AttemptOutcome.TIMEOUT, AttemptOutcome.UNCOMMANDED_MOTION),
    )
    PROGRAM_START = Declared(
        "program_start",
        "Somebody starts the program on a device's own controller: from now on it follows set points.",
        _PROGRAMMED,
        _CLAIM_OR_MOTION,
    )
    JOG = Declared(
        "jog",
        "Somebody moves a joint by the pendant, which the robot lets them do while its program is stopped or paused.",
        Hits(FaultTarget.PROGRAMMED_JOINT, "Joint, as `device/joint`.", "arm/elbow_joint"),
        _CLAIM_OR_MOTION,
        By(Amount.DISPLACEMENT, "How far.", "5 deg"),
    )
    STALE_SET_POINTS = Declared(
        "stale_set_points",
        "The program of a device stops, somebody jogs its first joint, and the program starts again.",
        _PROGRAMMED,
        _CLAIM_OR_MOTION,
    )
    BRAKES_CLOSED = Declared(
        "brakes_closed",
        "The brakes of a device are closed; ``lasting`` until a person opens them.",
        Hits(FaultTarget.BRAKED, "Device whose claim needs open brakes.", "arm"),
        (AttemptOutcome.CLAIM_FAILURE, AttemptOutcome.PROTECTIVE_STOP),
    )
    MISSING_PART = Declared(
        "missing_part",
        "A part is seen, or believed, where none is: fingers close on nothing.",
        Hits(FaultTarget.PART, "Frame of a part.", "object"),
        (AttemptOutcome.GRIP_FAILURE,),
    )
    WRONG_PART = Declared(
        "wrong_part",
        "Another part lies where the right one is to be: wider, or narrower with a negative length.",
        Hits(FaultTarget.PART, "Frame of a part.", "object"),
        (AttemptOutcome.GRIP_FAILURE,),
        By(Amount.SIZE, "How much wider.", "-6 mm"),
    )
    LOSE_PART = Declared(
        "lose_part",
        "The fingers of a gripper lose their force: what they hold, now or later, falls.",
        Hits(FaultTarget.GRIPPER, "Gripper.", "gripper"),
        (AttemptOutcome.GRIP_FAILURE,),
    )
    SLIP = Declared(
        "slip",
        "What a gripper holds slides between its fingers, which stay as far apart.",
        Hits(FaultTarget.GRIPPER, "Gripper.", "gripper"),
        (AttemptOutcome.GRIP_FAILURE,),
        By(Amount.SIZE, "How far.", "5 mm"),
    )
    SILENT_SENSOR = Declared(
        "silent_sensor",
        "The sensors of a switched device read for ever what they read now.",
        Hits(FaultTarget.SENSED, "Device with sensors.", "gripper"),
        (AttemptOutcome.TIMEOUT,),
    )


STOP_STATES = {
    FaultKind.PROTECTIVE_STOP: ("protective_stop", "fault"),
    FaultKind.SAFEGUARD_STOP: ("safeguard_stop", "user_stop"),
    FaultKind.EMERGENCY_STOP: ("emergency_stop",),
}
"""States in which a device stops by a fault, the nearest first: one without protective stops goes into fault."""


def stop_state(kind: FaultKind, known: Container[str]) -> str | None:
    """Return the state, of those that a device knows, in which a fault stops it; None where it cannot."""
    return next((name for name in STOP_STATES[kind] if name in known), None)
