"""An attempt as it was recorded, to play back as a rehearsal is; beside it the rehearsal, and where they are apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cellc.contract.attempt import PacketStep
from cellc.tools.attempt.compare import NOT_MADE, Comparison, Parting, partings
from cellc.tools.attempt.record import UNKNOWN, Report
from cellc.tools.view.bag_motion import Pictures
from cellc.tools.view.playback import STEP_NS, Apart, Ghost, Mark, Moment, Run, moment_of, run_of
from cellc.tools.view.skeleton import Skeleton

MOST_STEPS = 300
"""Steps that a page shows; a task has tens, and a bag without one as many as it has goals."""
_LONGEST_TEXT = 400
_POSE = 7

_Places = NDArray[np.float64]


def bag_run(name: str, report: Report, pictures: Pictures, skeleton: Skeleton) -> Run:
    """Return a bag as the page plays it back; times are counted from its begin."""
    end, finding = report.end, report.end.finding
    end_s = max(pictures.end_ns, 0) / 1e9
    moments = list(_moments(report))
    run = run_of(
        name,
        UNKNOWN if end.outcome is None else end.outcome.value,
        "" if finding is None else cut(f"{finding.layer}: {finding.message}"),
        moments,
        [time_ns / 1e9 for time_ns in pictures.times_ns],
        skeleton.postures(dict(zip(pictures.joints, pictures.positions.T, strict=True)), [{}] * len(pictures.times_ns)),
        max([end_s, *(moment.until_s for moment in moments)]),
    )
    return replace(run, recorded=True)


def cut(text: str) -> str:
    """Return a text of a bag that is no longer than a page needs."""
    return text if len(text) <= _LONGEST_TEXT else f"{text[:_LONGEST_TEXT]} …"


def _moments(report: Report) -> Iterator[Moment]:
    """Yield each step; one that the bag shows no instant of is at the end of the step before, and takes no time."""
    last_s = 0.0
    for attempt in report.attempts[:-1][:MOST_STEPS]:
        from_s, until_s = report.span_s(attempt) or (last_s, last_s)
        outcome = UNKNOWN if attempt.outcome is None else attempt.outcome.value
        reason = "" if attempt.finding is None else cut(f"{attempt.finding.layer}: {attempt.finding.message}")
        stamps_s = {step: report.since_begin_s(at_ns) for step, at_ns in attempt.stamps.items()}
        last_s = max(from_s, until_s)
        yield moment_of((from_s, last_s), cut(attempt.step), outcome, reason, stamps_s)


def beside(run: Run, number: int, other: Run, skeleton: Skeleton, comparison: Comparison) -> Run:
    """Return a run with another one as its ghost, in step at the acceptance of the first goal.

    Args:
        number: of the other run on the page.
    """
    shift_s = round(_first_s(run) - _first_s(other), 3)
    apart = tuple(_apart(run, other, shift_s, skeleton))
    marks = tuple(_marks(run, comparison))
    return replace(run, ghost=Ghost(number, other.name, shift_s, apart, marks))


def _first_s(run: Run) -> float:
    """Return when the first goal was accepted, or when the first step began where no goal was."""
    accepted = [mark.at_s for moment in run.moments for mark in moment.phases if mark.name == PacketStep.ACCEPTED.value]
    return min(accepted, default=run.moments[0].from_s if run.moments else 0.0)


def _marks(run: Run, comparison: Comparison) -> Iterator[Mark]:
    """Yield one mark for each step at which both part; of those that were not made the first one."""
    by_step: dict[int, list[Parting]] = {}
    for each in partings(comparison.steps[:MOST_STEPS]):
        by_step.setdefault(each.number, []).append(each)
    last_s, is_made = (run.moments[-1].until_s if run.moments else run.end_s), True
    for number, found in by_step.items():
        real = found[0].step.real
        at_s = last_s if real is None or real.at_s is None else min(max(0.0, real.at_s), run.end_s)
        kinds = ", ".join(each.what for each in found)
        if is_made or kinds != NOT_MADE:
            yield Mark(round(at_s, 3), f"step {number}: {kinds}")
        is_made = kinds != NOT_MADE


def _apart(run: Run, other: Run, shift_s: float, skeleton: Skeleton) -> Iterator[Apart]:
    """Yield where both are farthest apart within each moment of the run; what perception finds is left out."""
    if not run.times or not other.times:
        return
    moving = sorted({track.group for each in (run, other) for track in each.tracks if track.group < skeleton.links})
    for moment in run.moments:
        step_s = max(STEP_NS / 1e9, (moment.until_s - moment.from_s) / 1000)
        times = np.append(np.arange(moment.from_s, moment.until_s, step_s), moment.until_s)
        far = [
            np.linalg.norm(_places(run, group, times) - _places(other, group, times - shift_s), axis=1)
            for group in moving
        ]
        if not far:
            yield Apart(moment.from_s, 0.0, "")
            continue
        group, at = np.unravel_index(int(np.argmax(far)), np.shape(far))
        yield Apart(round(float(times[at]), 3), round(float(far[group][at]), 4), skeleton.groups[moving[group]])


def _places(run: Run, group: int, times: Sequence[float] | _Places) -> _Places:
    """Return where a group is at some times, in m, shape (times, 3)."""
    track = next((each.poses for each in run.tracks if each.group == group), None)
    if track is None:
        first = _POSE * group
        return np.tile(np.array(run.base[first : first + 3]), (len(times), 1))
    poses = np.array(track).reshape(-1, _POSE)
    return np.stack([np.interp(times, run.times, poses[:, axis]) for axis in range(3)], axis=1)
