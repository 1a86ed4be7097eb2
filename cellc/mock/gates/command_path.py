"""L6 and G2: goals, owners, cancel and tolerance on the mock, and how rehearsals and campaign ended."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from cellc.contract.attempt import PacketStep
from cellc.contract.contract import ContractController
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.campaign.limits import merge
from cellc.mock.gates.gate import GateCheck, failed, judged, passed, unknown
from cellc.mock.gates.runs import GateEvidence
from cellc.mock.sweep.summary import count_lines
from cellc.mock.task.bounds import cancel_bound_s

_WHOLE = (PacketStep.GOAL_SENT, PacketStep.ACCEPTED, PacketStep.WRITTEN, PacketStep.DRIVEN, PacketStep.RETURNED)

_MOCK_PACKAGE = "mock_components/"
"""Package of ros2_control whose plugins have nothing behind them."""


def commanded(evidence: GateEvidence) -> Iterator[tuple[str, ContractController]]:
    """Yield the controllers that are active and take goals, by name."""
    for manager in evidence.contract.managers.values():
        for name, controller in manager.controllers.items():
            if controller.active and controller.action is not None:
                yield name, controller


def owners(evidence: GateEvidence) -> GateCheck:
    """Judge whether each command interface has the one owner that the contract says."""
    good: list[str] = []
    bad: list[str] = []
    for run in evidence.runs:
        for stage in run.result.bringup:
            if stage.stage == "claim":
                bad += [f"{run.name}: {problem}" for problem in stage.problems]
                good = good or [f"{run.name}: {fact}" for fact in stage.facts]
    text = "Each command interface is claimed by its one owner"
    return judged(text, good, bad, "a run whose bring-up reached the claims")


def goal_trace(evidence: GateEvidence, controller: str) -> GateCheck:
    """Judge whether a goal was seen accepted, driven and answered."""
    good = [
        f"{run.name}, {attempt.step}: accepted, driven, {attempt.result.status}"
        for run, attempt in evidence.attempts(controller)
        if attempt.result is not None and attempt.outcome == AttemptOutcome.SUCCEEDED and run.has_mark(attempt, *_WHOLE)
    ]
    text = f"A goal to {controller} is accepted, driven and answered"
    return judged(text, good, [], "a run in which it drives its joints and succeeds")


def cancel_trace(evidence: GateEvidence, controller: str) -> GateCheck:
    """Judge whether canceled goals are held within the bound, where their joints were moving."""
    bound_s = cancel_bound_s(evidence.contract)
    good: list[str] = []
    bad: list[str] = []
    for run, attempt in evidence.attempts(controller):
        cancel = attempt.cancel
        moved = run.has_mark(attempt, PacketStep.DRIVEN)
        if cancel is None or attempt.outcome != AttemptOutcome.CANCELED or not moved:
            continue
        if cancel.latency_s is None or cancel.latency_s > bound_s:
            bad.append(f"{run.name}, {attempt.step}: not held within {bound_s:g} s")
        else:
            good.append(f"{run.name}, {attempt.step}: held after {cancel.latency_s * 1e3:.0f} ms")
    text = f"A canceled goal of {controller} is held within {bound_s:g} s on mock hardware"
    return judged(text, good, bad, "a run that cancels it while its joints move")


def tolerance_trace(evidence: GateEvidence, controller: str) -> GateCheck:
    """Judge whether a violated tolerance ends the attempt by name."""
    good: list[str] = []
    bad: list[str] = []
    for run, attempt in evidence.attempts(controller):
        if attempt.outcome != AttemptOutcome.TOLERANCE_VIOLATION:
            continue
        line = f"{run.name}, {attempt.step}: {attempt.fault_code}"
        (good if run.passed else bad).append(line)
    text = f"A violated tolerance of {controller} ends in a named outcome within its bound"
    return judged(text, good, bad, "a run in which one of its joints does not follow")


def command_path_checks(evidence: GateEvidence) -> Iterator[GateCheck]:
    """Yield the lines of L6."""
    yield _no_real_interface(evidence)
    yield owners(evidence)
    for name, _ in commanded(evidence):
        yield goal_trace(evidence, name)
        yield cancel_trace(evidence, name)
        yield tolerance_trace(evidence, name)


def _no_real_interface(evidence: GateEvidence) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for component in evidence.folder.description.hardware:
        (good if component.plugin.startswith(_MOCK_PACKAGE) else bad).append(
            f"{component.name}: {component.plugin or 'no plugin'}"
        )
    name = evidence.contract.files.urdf_mock
    return judged(f"No component of {name} is a route to a real interface", good, bad, "a hardware component")


def mock_run_checks(evidence: GateEvidence) -> Iterator[GateCheck]:
    """Yield the lines of G2."""
    yield _rehearsals(evidence)
    yield _with_masses(evidence)
    yield from _rates(evidence)
    yield _bringup(evidence)
    yield unknown("The launch file starts the nodes", "`ros2 launch` on a host with ROS 2")
    yield owners(evidence)
    yield _servers(evidence)
    for name, _ in commanded(evidence):
        yield cancel_trace(evidence, name)
    yield _faults(evidence)
    yield _limits(evidence)


def _rates(evidence: GateEvidence) -> Iterator[GateCheck]:
    """Judge each expected rate of success by its sweep, and cite what it takes to make that again."""
    drawn = evidence.folder.uncertainty
    swept = {sweep.rehearsal: sweep for sweep in evidence.sweeps}
    for name, expected in () if drawn is None else drawn.expected.items():
        text = f"{name} succeeds in {expected.success:.6g} of its runs or more, where not everything is known exactly"
        needed = f"a sweep of {name} that decides it with confidence {expected.confidence:.6g}: `cellc gates --sweep N`"
        swept_cell = swept.get(name)
        if swept_cell is None:
            yield unknown(text, needed)
            continue
        runs, rate = islice(count_lines(swept_cell), 2)
        cells = (f"{runs}, {evidence.contract.configuration_id}", rate)
        if swept_cell.verdict is None:
            yield unknown(text, f"{needed} above {len(swept_cell.runs)}; {rate}")
        else:
            yield passed(text, cells) if swept_cell.verdict else failed(text, cells)


def _rehearsals(evidence: GateEvidence) -> GateCheck:
    text = "Every rehearsal ends as declared"
    seen = {run.name: run for run in evidence.runs if run.declared}
    bad = [f"{name}: {run.result.outcome}" for name, run in seen.items() if not run.passed]
    missing = [entry.name for entry in evidence.folder.rehearsals if entry.name not in seen]
    if bad:
        return failed(text, bad)
    if missing or not seen:
        return unknown(text, f"a run of {', '.join(missing) or 'a rehearsal'}")
    return passed(text, [f"{name}: {run.result.outcome}" for name, run in seen.items()])


def _with_masses(evidence: GateEvidence) -> GateCheck:
    text, physics = "With masses, drives and contacts too every rehearsal ends as declared", evidence.physics
    bad = [f"{each.name}: {each.outcome}, {each.reason}" for each in physics.results if not each.passed]
    good = [f"{each.name}: {each.outcome}" for each in physics.results]
    good = [f"{physics.computed_by}, {good[0]}", *good[1:]] if good else []
    return judged(text, good, bad, physics.needed or "a rehearsal")


def _bringup(evidence: GateEvidence) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for run in evidence.undisturbed():
        stages = run.result.bringup
        bad += [f"{run.name}: {stage.stage}: {problem}" for stage in stages for problem in stage.problems]
        if stages and all(stage.passed for stage in stages):
            good.append(f"{run.name}: {', '.join(stage.stage for stage in stages)} passed")
    return judged("The cell starts in stages", good, bad, "a run without faults")


def _servers(evidence: GateEvidence) -> GateCheck:
    """Judge by the graph of the contract, which the mock executes as it is declared."""
    good: list[str] = []
    bad: list[str] = []
    for name, interface in evidence.contract.interfaces.items():
        if interface.kind == "action":
            servers = ", ".join(source.node for source in interface.sources) or "no server"
            clients = ", ".join(sink.node for sink in interface.sinks) or "no client"
            (good if len(interface.sources) == 1 else bad).append(f"{name}: {servers} for {clients}")
    return judged("Each action has one server and the declared clients", good, bad, "an action")


def _faults(evidence: GateEvidence) -> GateCheck:
    runs = [run for run in evidence.runs if not run.declared]
    bad = [f"{run.name}: {run.result.outcome}" for run in runs if not run.passed]
    good = [f"{len(runs)} runs of the campaign"] if runs else []
    text = "Every fault at every step ends in a named outcome within its bound"
    return judged(text, good, bad, "a campaign: `cellc gates`")


def _limits(evidence: GateEvidence) -> GateCheck:
    reports = [run.limits for run in evidence.runs if run.limits is not None]
    total = merge(reports)
    shares = ", ".join(f"{peak.quantity} {peak.share:.1%}" for peak in total.peaks)
    moved = any(peak.share > 0.0 for peak in total.peaks)
    good = [f"{len(reports)} runs, largest share of a limit: {shares}"] if moved else []
    bad = [str(excess) for excess in total.excesses]
    return judged(
        "No commanded trajectory exceeds a limit", good, bad, "a campaign in which a trajectory moves a joint"
    )
