"""Lines that several gates ask of the command path: owner, goal, cancel and tolerance, by the traces of attempts."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.contract import ContractController
from cellc.mock.gates.gate import GateCheck, judged
from cellc.mock.gates.witness import Testimony
from cellc.mock.record import PacketStep
from cellc.mock.task.bounds import cancel_bound_s

_WHOLE = (PacketStep.GOAL_SENT, PacketStep.ACCEPTED, PacketStep.WRITTEN, PacketStep.DRIVEN, PacketStep.RETURNED)


def commanded(testimony: Testimony) -> Iterator[tuple[str, ContractController]]:
    """Yield the controllers that are active and take goals, by name."""
    for manager in testimony.contract.managers.values():
        for name, controller in manager.controllers.items():
            if controller.active and controller.action is not None:
                yield name, controller


def owners(testimony: Testimony) -> GateCheck:
    """Judge whether each command interface has the one owner that the contract says."""
    good: list[str] = []
    bad: list[str] = []
    for witness in testimony.witnesses:
        for stage in witness.result.bringup:
            if stage.stage == "claim":
                bad += [f"{witness.name}: {problem}" for problem in stage.problems]
                good = good or [f"{witness.name}: {fact}" for fact in stage.facts]
    text = "Each command interface is claimed by its one owner"
    return judged(text, good, bad, "a run whose bring-up came to the claims")


def goal_trace(testimony: Testimony, controller: str) -> GateCheck:
    """Judge whether a goal was seen accepted, driven and answered."""
    good = [
        f"{witness.name}, {attempt.step}: accepted, driven, {attempt.result.status}"
        for witness, attempt in testimony.attempts(controller)
        if attempt.result is not None and attempt.outcome == "succeeded" and witness.has_mark(attempt, *_WHOLE)
    ]
    text = f"A goal to {controller} is accepted, driven and answered"
    return judged(text, good, [], "a run in which it drives its joints and succeeds")


def cancel_trace(testimony: Testimony, controller: str) -> GateCheck:
    """Judge whether cancelled goals are held within the bound, where their joints were moving."""
    bound_s = cancel_bound_s(testimony.contract)
    good: list[str] = []
    bad: list[str] = []
    for witness, attempt in testimony.attempts(controller):
        cancel = attempt.cancel
        moved = witness.has_mark(attempt, PacketStep.DRIVEN)
        if cancel is None or attempt.outcome != "cancelled" or not moved:
            continue
        if cancel.latency_s is None or cancel.latency_s > bound_s:
            bad.append(f"{witness.name}, {attempt.step}: not held within {bound_s:g} s")
        else:
            good.append(f"{witness.name}, {attempt.step}: held after {cancel.latency_s * 1e3:.0f} ms")
    text = f"A cancelled goal of {controller} is held within {bound_s:g} s on mock hardware"
    return judged(text, good, bad, "a run that cancels it while its joints move")


def tolerance_trace(testimony: Testimony, controller: str) -> GateCheck:
    """Judge whether a violated tolerance ends the attempt by name."""
    good: list[str] = []
    bad: list[str] = []
    for witness, attempt in testimony.attempts(controller):
        if attempt.outcome != "tolerance_violation":
            continue
        line = f"{witness.name}, {attempt.step}: {attempt.fault_code}"
        (good if witness.passed else bad).append(line)
    text = f"A violated tolerance of {controller} ends in a named outcome within its bound"
    return judged(text, good, bad, "a run in which one of its joints does not follow")
