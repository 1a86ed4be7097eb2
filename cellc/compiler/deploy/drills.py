"""Drills of gates G5 and G7: stops, cables and restarts on the robot, each with what its vendor's driver does then.

The outcomes are the facts that the mock plays: what moves, the state of the component, and what the cell hears.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.cell.stops import effect_of, stops_of
from cellc.compiler.cell.vendor import SafetyState
from cellc.compiler.deploy.gate_motion import Values, sentences
from cellc.compiler.deploy.processes import adapted_devices
from cellc.compiler.deploy.releases import moved_by_activation, restart_of
from cellc.compiler.deploy.watches import heard
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.bring_up import WATCH_WITHIN_S
from cellc.contract.vocabulary import LeftBy, Moment, Motion, Need

_MOVES: Mapping[Motion, str] = {
    Motion.NONE: "The arm must not move.",
    Motion.HOLDS: "The arm must hold its position.",
    Motion.MOVES: "The arm moves by itself.",
    Motion.JUMPS: "The arm goes to old set points in one step.",
    Motion.FALLS: "The arm falls.",
    Motion.UNKNOWN: "No source says whether the arm moves.",
}
_ALL_MOVE: Mapping[Motion, str] = {
    Motion.NONE: "No arm may move.",
    Motion.HOLDS: "Each arm must hold its position.",
    Motion.MOVES: "Each arm moves by itself.",
    Motion.JUMPS: "Each arm goes to old set points in one step.",
    Motion.FALLS: "Each arm falls.",
    Motion.UNKNOWN: "No source says whether the arms move.",
}
"""The same of several arms that one act stops."""
_ONCE_STOPPED: Mapping[Motion, str] = {
    **_MOVES,
    Motion.NONE: "Once it has stopped, the arm must not move.",
    Motion.HOLDS: "Once it has stopped, the arm must hold its position.",
}
"""The same of an arm that moved when it was stopped."""
_CALM = (Motion.NONE, Motion.HOLDS)
_REPEATED = "Where it repeats gates, skip the goals and drills above this line."


def early_drills(graph: CellGraph) -> Iterator[Values]:
    """Yield drills of hardware that nothing has moved yet: devices, what people do, and what must follow."""
    if not _activated_arms(graph.cell):
        yield from _without_a_claim(graph.cell, "as in G4, with the drives as they are")


def late_drills(graph: CellGraph) -> Iterator[Values]:
    """Yield the same drills where arms must be activated first."""
    if _activated_arms(graph.cell):
        yield from _without_a_claim(graph.cell, restart_of(graph.cell))


def claimed_drills(graph: CellGraph) -> Iterator[Values]:
    """Yield the drills of claimed arms, each with the way back to a claim."""
    for device in _drilled(graph.cell):
        yield from ((device.name, act, follows) for act, follows in _with_a_claim(graph.cell, device))


def adapter_drills(graph: CellGraph) -> Iterator[Values]:
    """Yield what people try on arms behind an adapter without a claim: only its author knows what it does."""
    for device in _adapted(graph.cell):
        yield (
            device.name,
            "Unplug the communication cable of the arm for 10 s and plug it in again. Leave the power on.",
        )
        yield device.name, f"End the hardware launch with Ctrl-C. Start it again {restart_of(graph.cell)}."


def claimed_adapter_drills(graph: CellGraph) -> Iterator[Values]:
    """Yield how people stop such an arm while it moves, out of its reach, and how they recover it."""
    for device in _adapted(graph.cell):
        stop = _tripped(device)
        if stop is not None and stop.trip is not None:
            act = f"{stop.trip} while the arm moves on a small goal. Record the stopping distance."
            yield device.name, f"{act} Then follow Recovery of {stop.name} in `audit.md` to its last step."


def open_drills(graph: CellGraph) -> Iterator[Values]:
    """Yield the arms that no source says how to stop out of reach, with the state and what must follow."""
    for device in _drilled(graph.cell):
        stop = _tripped(device)
        effect = None if stop is None else effect_of(device, stop)
        if stop is not None and stop.trip is None and effect is not None:
            yield device.name, stop.name, _stopped(graph.cell, device, stop, effect)


def interlocks(graph: CellGraph) -> Iterator[Values]:
    """Yield the areas that one arm at a time may be in, with who grants them."""
    return ((area.name, area.granted_by) for area in graph.cell.areas if not area.released)


def pulled(graph: CellGraph) -> Iterator[Values]:
    """Yield what moves as it is activated, and how: no joint state shows it before."""
    return ((name, sentences(effect.does)) for name, effect in moved_by_activation(graph.cell))


def claimed(graph: CellGraph) -> Iterator[Values]:
    """Yield the arms that controllers claim, with what a claim does."""
    for device in _drilled(graph.cell):
        effect = _effects(device).get(Moment.CLAIM)
        if effect is not None:
            yield device.name, sentences(effect.does)


def _drilled(cell: Cell) -> Iterator[Device]:
    """Return the arms that a driver moves, and no adapter."""
    adapted = adapted_devices(cell)
    return (device for device in cell.devices if device.kind == "arm" and device.name not in adapted)


def _adapted(cell: Cell) -> Iterator[Device]:
    return (cell.device(name) for name in sorted(adapted_devices(cell)) if cell.device(name).kind == "arm")


def _activated_arms(cell: Cell) -> bool:
    activated = {name for name, _ in moved_by_activation(cell)}
    return any(device.name in activated for device in _drilled(cell))


def _without_a_claim(cell: Cell, again: str) -> Iterator[Values]:
    """Yield the drills of the cables, then that of all launches: only a restart restores some drivers after a cable."""
    for device in _drilled(cell):
        yield from ((device.name, act, follows) for act, follows in _of_the_cable(cell, device))
    effects = [(device, _effects(device).get(Moment.DEACTIVATE)) for device in _drilled(cell)]
    ended = [(device, effect) for device, effect in effects if effect is not None]
    if ended:
        falling = [device.name for device, effect in ended if effect.motion is Motion.FALLS]
        act = f"{_supported(falling)}End the hardware launch with Ctrl-C, if it still runs."
        follows = f"{_each_follows(cell, ended)} Start the launch again {again}."
        yield " and ".join(device.name for device, _ in ended), act, follows


def _each_follows(cell: Cell, ended: Sequence[tuple[Device, Effect]]) -> str:
    """Return what follows for each arm, in one text where it is the same for all."""
    texts = {device.name: _follows(cell, device, effect, ()) for device, effect in ended}
    if len(set(texts.values())) > 1:
        return " ".join(f"{name}: {text}" for name, text in texts.items())
    return _follows(cell, *ended[0], (), _MOVES if len(texts) == 1 else _ALL_MOVE)


def _of_the_cable(cell: Cell, device: Device) -> Iterator[tuple[str, str]]:
    """Yield what follows on a cut and on a reconnection; before a claim no program runs, so that no topic changes."""
    effects = _effects(device)
    cut, again = effects.get(Moment.LINK_LOST), effects.get(Moment.RECONNECT)
    if cut is None or again is None:
        return
    if again.motion in _CALM and cut.motion in _CALM:
        ended = "" if cut.leaves == "active" else " Its controller manager may have ended instead."
        act = "Unplug the communication cable of the arm for 10 s. Leave the power on."
        yield act, _follows(cell, device, cut, ()) + ended
        yield "Plug the communication cable in again.", _follows(cell, device, again, ()) + ended
    else:
        act = "Do not unplug the communication cable of the arm while its hardware component is active."
        yield act, f"{_MOVES[again.motion].removesuffix('.')} on reconnection."


def _with_a_claim(cell: Cell, device: Device) -> Iterator[tuple[str, str]]:
    stop = _tripped(device)
    effect = None if stop is None else effect_of(device, stop)
    if stop is None or effect is None or stop.trip is None:
        return
    falling = [other.name for other in _drilled(cell) if _falls(other)] if effect.motion is Motion.FALLS else []
    act = f"{_supported(falling)}{stop.trip} while the arm moves on a small goal. Record the stopping distance."
    yield act, _stopped(cell, device, stop, effect)
    if effect.leaves == "active" and stop.left_by is not LeftBy.ACTIVATION:
        yield from _resumed(cell, device, stop, effect)
    yield _recovered(device, stop, falling), "The controllers of the arm must be active again."


def _resumed(cell: Cell, device: Device, stop: SafetyState, effect: Effect) -> Iterator[tuple[str, str]]:
    """Yield what nothing may move by: the end of the stop, and a program that goes on after a jog."""
    hears = any(need in heard(cell, device) for need in (*effect.ends, *stop.ends))
    follows = "Nothing may move before the claim is acknowledged." if hears else _MOVES[Motion.JUMPS]
    after = "Check that no controller of the arm is active. With a hand on the stop, end the cause and reset the stop."
    yield f"In this drill only, let the arm resume without its Recovery. {after} Do not jog the arm.", follows
    resumed = _effects(device).get(Moment.PROGRAM_RESUME)
    if resumed is not None and resumed.motion is Motion.JUMPS:
        jog = "Never jog it while its program is paused. Stop the program, jog one joint, and start the program."
        yield f"In this drill only, jog the arm while none of its controllers is active. {jog}", follows


def _recovered(device: Device, stop: SafetyState, falling: Sequence[str]) -> str:
    """Return how people come back to a claim, which every line after the drill needs."""
    others = f" Do the same for each of {' and '.join(falling)} that lost power." if len(falling) > 1 else ""
    if any(way.state == stop.name for way in device.procedures.safety.recovery):
        return f"Follow Recovery of {stop.name} in `audit.md` to its last step.{others} {_REPEATED}"
    unknown = f"UNKNOWN: how to recover from {stop.name}. Look it up in the vendor's manual.{others}"
    return f"{unknown} Authorize the claim of the arm again."


def _tripped(device: Device) -> SafetyState | None:
    """Return the stop that people try: one that is tripped out of reach, else a protective one, else its first."""
    stops = stops_of(device)
    tripped = (stop for stop in stops if stop.trip is not None)
    protective = (stop for stop in stops if stop.name == "protective_stop")
    return next(iter((*tripped, *protective, *stops)), None)


def _falls(device: Device) -> bool:
    effect = _effects(device).get(Moment.STOP)
    return effect is not None and effect.motion is Motion.FALLS


def _supported(falling: Sequence[str]) -> str:
    """Return what is done first where arms fall; the power of one may be that of another."""
    if not falling:
        return ""
    return f"From out of reach, place a stand just below {' and '.join(falling)}. "


def _effects(device: Device) -> Mapping[Moment, Effect]:
    return {} if device.control.hardware is None else device.control.hardware.effects


def _stopped(cell: Cell, device: Device, stop: SafetyState, effect: Effect) -> str:
    """Return what follows on a stop during a goal, with what becomes of goal and claim."""
    lost = (*effect.ends, *stop.ends)
    if effect.leaves != "active":
        ends = "Its goal must end and its controllers must be inactive."
    elif any(need in heard(cell, device) for need in lost):
        ends = f"Within {shortest(WATCH_WITHIN_S)} s, its claim must be dropped and its goal must end."
    else:
        ends = "Nothing ends its goal. Cancel it."
    return f"{_follows(cell, device, effect, lost, _ONCE_STOPPED)} {ends}"


def _follows(
    cell: Cell, device: Device, effect: Effect, lost: tuple[Need, ...], moves: Mapping[Motion, str] = _MOVES
) -> str:
    """Return what moves, the state of the component, and the topics that say so."""
    said = [moves[effect.motion]]
    if effect.drops_part:
        said.append("What it holds falls.")
    if effect.leaves is not None:
        said.append(f"Its hardware component must be {effect.leaves}.")
        telling = heard(cell, device)
        topics = dict.fromkeys(telling[need].topic for need in lost if need in telling)
        if topics:
            said.append(f"The stop must show on {' and '.join(topics)}.")
        elif effect.leaves == "active":
            said.append("No topic reports this.")
    return " ".join(said)
