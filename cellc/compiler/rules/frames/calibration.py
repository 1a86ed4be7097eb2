"""Rules on calibrations: who measured what, when, and how well."""

from __future__ import annotations

import datetime
import re
from collections.abc import Container, Mapping, Sequence

from cellc.compiler.cell.frame import WORLD, Frame, FrameKind
from cellc.compiler.cell.motion import CartesianGoal
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.vocabulary import UNKNOWN


@rule(Severity.ERROR)
def calibration_before_mounting(graph: CellGraph) -> Findings:
    """Yield calibrations of a mount, or of a frame on a device that is mounted on another, from before that day."""
    carried = {name for device in graph.cell.devices for name in device.mount.carries}
    for frame in graph.cell.frames:
        calibration = graph.cell.calibrations.get(frame.calibration or "")
        name = _device_that_moves(graph, frame, carried)
        if calibration is None or calibration.measured_on is None or name is None:
            continue
        device = graph.cell.device(name)
        if device.mount.mounted_on is not None and calibration.measured_on < device.mount.mounted_on:
            message = f"`{calibration.name}` must be measured after `{device.name}` was mounted, on"
            message += f" {device.mount.mounted_on}, got {calibration.measured_on}"
            related = (Related("mounted since then", graph.cell.locate(*device.path, "mount", "since")),)
            yield found(graph, (*calibration.path, "measured"), message, related=related)


def _device_that_moves(graph: CellGraph, frame: Frame, carried: Container[str | None]) -> str | None:
    """Return the device whose mounting moves a measured frame: its own, or the tool on which it is fixed."""
    if frame.kind is FrameKind.MOUNT:
        return frame.device
    carrier = graph.frames.get(frame.parent)
    name = None if carrier is None else carrier.device
    return name if name in carried else None


_YEAR = datetime.timedelta(days=366)


@rule(Severity.WARNING)
def calibration_of_another_time(graph: CellGraph) -> Findings:
    """Yield calibrations more than a year before or after the largest group of those that lie nearer together."""
    dated = [calibration for calibration in graph.cell.calibrations.values() if calibration.measured_on is not None]
    common = _largest_group([calibration.measured_on for calibration in dated if calibration.measured_on is not None])
    for calibration in dated:
        if calibration.measured_on is None or calibration.measured_on in common:
            continue
        side = "before" if calibration.measured_on < common[0] else "after"
        message = f"`{calibration.name}` must be measured within a year of the others, which were between"
        message += f" {common[0]} and {common[-1]}, got {calibration.measured_on}, {side} all of them"
        yield found(graph, (*calibration.path, "measured"), message)


def _largest_group(dates: Sequence[datetime.date]) -> list[datetime.date]:
    """Return the largest group of dates without a gap of more than a year, the later of two equal ones."""
    groups: list[list[datetime.date]] = []
    for date in sorted(dates):
        if groups and date - groups[-1][-1] <= _YEAR:
            groups[-1].append(date)
        else:
            groups.append([date])
    return max(groups, key=lambda group: (len(group), group[-1]), default=[])


@rule(Severity.ERROR)
def calibration_of_another_device(graph: CellGraph) -> Findings:
    """Yield calibrations that measured a device with another serial number than the one that is there."""
    for calibration in graph.cell.calibrations.values():
        for name, serial in calibration.serials.items():
            device = graph.cell.device(name)
            there = device.software.versions.serial
            if UNKNOWN not in (there, serial) and there != serial:
                message = f"`{calibration.name}` must be measured with this `{name}`, serial number {there},"
                related = (Related("is there now", graph.cell.locate(*device.path, "serial")),)
                path = (*calibration.path, "serials", name)
                yield found(graph, path, f"{message} got {serial}", related=related)


@rule(Severity.ERROR)
def calibration_of_two_frames(graph: CellGraph) -> Findings:
    """Yield frames that reuse a calibration for another transform."""
    first: dict[str, Frame] = {}
    for frame in graph.cell.frames:
        if frame.calibration is None:
            continue
        earlier = first.setdefault(frame.calibration, frame)
        if (earlier.parent, earlier.transform_to_parent) != (frame.parent, frame.transform_to_parent):
            message = f"calibration `{frame.calibration}` gives `{frame.name}` a different pose than `{earlier.name}`"
            related = (Related(f"first used for `{earlier.name}` here", earlier.span),)
            path = (*frame.path, "calibration")
            yield found(graph, path, message, related=related)


_EYE = re.compile(r"\beye[ _-]?(in|on|to)[ _-]?(the[ _-]?)?(hand|base)", re.IGNORECASE)


@rule(Severity.ERROR, assumes=("frame-cycle", "calibration-of-two-frames"))
def hand_eye_of_another_kind(graph: CellGraph) -> Findings:
    """Yield what rests on a calibration of an eye in the hand and does not move with one, and the other way around."""
    for frame in graph.cell.frames:
        calibration = graph.cell.calibrations.get(frame.calibration or "")
        said = None if calibration is None else _EYE.search(calibration.method)
        if calibration is None or said is None or frame.kind is FrameKind.DYNAMIC:
            continue
        in_hand = said[3].lower() == "hand" and said[1].lower() != "to"
        if in_hand is not any(edge.moving for edge in graph.frames.chain(frame.parent)):
            hung = "moves with no joint" if in_hand else "moves with an arm"
            message = f"`{calibration.name}` was measured `{said[0]}`, but `{frame.parent}`, which carries it, {hung}"
            related = (Related("how it was measured", graph.cell.locate(*calibration.path, "method")),)
            yield found(graph, (*frame.path, "parent"), message, related=related)


@rule(Severity.WARNING)
def calibration_without_evidence(graph: CellGraph) -> Findings:
    """Yield calibrations without samples, residual or method."""
    for name, calibration in graph.cell.calibrations.items():
        stated = (
            ("method", calibration.method),
            ("samples", calibration.samples),
            ("residual", calibration.residual_m),
        )
        missing = [field for field, value in stated if value is None or value == UNKNOWN]
        if missing:
            fields = ", ".join(f"`{field}`" for field in missing)
            message = f"calibration `{name}` does not state {fields}"
            yield found(graph, ("calibrations", name), message, f"write {fields}")


@rule(Severity.BLOCKER)
def calibration_without_owner(graph: CellGraph) -> Findings:
    """Yield calibrations without an owner."""
    for item in graph.responsibilities.of_kind("calibration"):
        if item.open:
            message = f"calibration `{item.name}` has no owner"
            yield found(graph, item.path, message)


_COARSEST_M = 0.005


@rule(Severity.WARNING)
def coarse_calibration(graph: CellGraph) -> Findings:
    """Yield calibrations that a frame rests on with a residual of more than 5 mm."""
    for calibration in graph.cell.calibrations.values():
        residual_m = calibration.residual_m
        users = graph.once(_users).get(calibration.name, ())
        most, related = _finest(graph, calibration.name)
        if users and residual_m is not None and residual_m > most:
            path = (*calibration.path, "residual")
            message = f"the residual of `{calibration.name}` must be at most {most * 1e3:.3g} mm,"
            related = (*related, *(Related("uses it", user.span) for user in users))
            yield found(graph, path, f"{message} got {graph.cell.text(*path)}", related=related)


def _users(graph: CellGraph) -> Mapping[str, tuple[Frame, ...]]:
    """Return the frames that name each calibration."""
    users: dict[str, list[Frame]] = {}
    for frame in graph.cell.frames:
        if frame.calibration is not None:
            users.setdefault(frame.calibration, []).append(frame)
    return {name: tuple(frames) for name, frames in users.items()}


def _finest(graph: CellGraph, name: str) -> tuple[float, tuple[Related, ...]]:
    """Return the least tolerance of the goals that rest on a calibration, at most the general one, m, and its place."""
    uncertainty = graph.cell.uncertainty
    stated = {} if uncertainty is None else uncertainty.tolerances_m
    goals = [goal for goal in graph.once(_resting).get(name, ()) if goal.name in stated]
    finest = min(goals, key=lambda goal: stated[goal.name], default=None)
    if finest is None or stated[finest.name] >= _COARSEST_M:
        return _COARSEST_M, ()
    place = graph.cell.locate("uncertainty", "tolerances", finest.name)
    return stated[finest.name], (Related(f"the tolerance of `{finest.name}`, which rests on it", place),)


def _resting(graph: CellGraph) -> Mapping[str, Sequence[CartesianGoal]]:
    """Return for each calibration the goals whose frame, or the tip that goes there, rests on it."""
    tips = {group.name: group.tip_frame for group in graph.cell.groups}
    resting: dict[str, list[CartesianGoal]] = {}
    for goal in graph.cell.goals:
        chains = (graph.frames.chain(name) for name in (goal.frame, tips.get(goal.group, "")))
        for name in {frame.calibration for chain in chains for frame in chain if frame.calibration is not None}:
            resting.setdefault(name, []).append(goal)
    return resting


_MOBILE = frozenset(
    ("agv", "amr", "cart", "carriage", "forklift", "mobile", "pallet", "shuttle", "trolley", "vehicle", "wagon")
)


@rule(Severity.WARNING)
def designed_mobile_frame(graph: CellGraph) -> Findings:
    """Yield designed frames on the world with such a word in their name."""
    for frame in graph.cell.frames:
        words = re.findall(r"[a-z]+", frame.name.lower())
        mobile = next((word for word in words if word in _MOBILE), None)
        if frame.designed and frame.parent == WORLD and mobile is not None:
            message = f"`{frame.name}` must be measured or published, because a {mobile} moves"
            yield found(graph, (*frame.path, "designed"), message)


_POINTS = 3


@rule(Severity.BLOCKER)
def too_few_reference_points(graph: CellGraph) -> Findings:
    """Yield measured frames that goals rest on, or that count points, with fewer than three."""
    targets = {goal.frame for goal in graph.cell.goals}
    for frame in graph.cell.frames:
        concerned = frame.name in targets or frame.reference_points > 0
        if frame.kind is FrameKind.FIXED and concerned and not frame.designed and frame.reference_points < _POINTS:
            message = f"`{frame.name}` must have at least {_POINTS} reference points, got {frame.reference_points}"
            path = (*frame.path, "reference_points")
            yield found(graph, path, message)


_LEAST_OF_CAMERA = 10
_LEAST_OF_OTHERS = 3


@rule(Severity.WARNING)
def too_few_samples(graph: CellGraph) -> Findings:
    """Yield calibrations below the number of samples that what rests on them needs."""
    cameras = {device.name for device in graph.cell.devices if device.kind == "camera"}
    for calibration in graph.cell.calibrations.values():
        users = graph.once(_users).get(calibration.name, ())
        least = _LEAST_OF_CAMERA if any(user.device in cameras for user in users) else _LEAST_OF_OTHERS
        if users and calibration.samples is not None and calibration.samples < least:
            what = "that of a camera" if least == _LEAST_OF_CAMERA else "any"
            message = f"calibration `{calibration.name}` must have at least {least} samples as {what},"
            yield found(graph, (*calibration.path, "samples"), f"{message} got {calibration.samples}")


@rule(Severity.BLOCKER)
def uncalibrated_frame(graph: CellGraph) -> Findings:
    """Yield fixed frames and camera mounts without a calibration."""
    cameras = {device.name for device in graph.cell.devices if device.kind == "camera"}
    for frame in graph.cell.frames:
        measured = frame.kind is FrameKind.FIXED or (frame.kind is FrameKind.MOUNT and frame.device in cameras)
        if measured and not frame.designed and frame.calibration is None:
            message = f"the pose of `{frame.name}` in `{frame.parent}` names no calibration"
            yield found(graph, frame.path, message)


@rule(Severity.BLOCKER)
def undated_calibration(graph: CellGraph) -> Findings:
    """Yield calibrations whose `measured` is no date."""
    for name, calibration in graph.cell.calibrations.items():
        if calibration.measured_on is None:
            message = f"`measured` of calibration `{name}` must be a date, got `{calibration.measured}`"
            yield found(graph, ("calibrations", name, "measured"), message)


@rule(Severity.WARNING)
def unused_calibration(graph: CellGraph) -> Findings:
    """Yield calibrations that no frame and no mount names."""
    used = {frame.calibration for frame in graph.cell.frames}
    for name in graph.cell.calibrations:
        if name not in used:
            message = f"no frame uses calibration `{name}`"
            # Links, boxes and the world are designed, too, but are never measured.
            designed = [frame for frame in graph.cell.frames if frame.designed and frame.kind is FrameKind.FIXED]
            related = tuple(Related("designed, without a measurement", frame.span) for frame in designed)
            yield found(graph, ("calibrations", name), message, related=related)
