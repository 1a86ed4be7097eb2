"""Drills of gates G5 and G7: stops, cables and restarts on the robot, each with what its vendor's driver does then.

The outcomes are the facts that the mock plays: what moves, the state of the component, and what the cell hears.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.cell.stops import effect_of, stops_of
from cellc.compiler.cell.vendor import SafetyState
from cellc.compiler.deploy.gate_motion import Values
from cellc.compiler.deploy.watches import heard
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.bring_up import WATCH_WITHIN_S
from cellc.contract.vocabulary import GateCode, LeftBy, Moment, Motion, Need

_MOVES: Mapping[Motion, str] = {
    Motion.NONE: "It must not move.",
    Motion.HOLDS: "It must hold its position.",
    Motion.MOVES: "It moves by itself.",
    Motion.JUMPS: "It goes to old set points in one step.",
    Motion.FALLS: "It falls: support it first.",
    Motion.UNKNOWN: "No source says whether it moves.",
}
_CALM = (Motion.NONE, Motion.HOLDS)


def drills(graph: CellGraph) -> Iterator[Values]:
    """Yield device, what people do, what must follow, and the gate: on active hardware first, then with a claim."""
    for device in _drilled(graph.cell):
        yield from ((device.name, act, follows, GateCode.G5) for act, follows in _without_a_claim(graph.cell, device))
        yield from ((device.name, act, follows, GateCode.G7) for act, follows in _with_a_claim(graph.cell, device))


def interlocks(graph: CellGraph) -> Iterator[Values]:
    """Yield the areas that one arm at a time may be in, with who grants them."""
    return ((area.name, area.granted_by) for area in graph.cell.areas if not area.released)


def pulled(graph: CellGraph) -> Iterator[Values]:
    """Yield what moves as it is activated, and how: no joint state shows it before."""
    for device in graph.cell.devices:
        effect = _effects(device).get(Moment.ACTIVATE)
        if effect is not None and effect.motion not in _CALM:
            yield device.name, effect.does


def claimed(graph: CellGraph) -> Iterator[Values]:
    """Yield the arms that controllers claim, with what a claim does."""
    for device in _drilled(graph.cell):
        effect = _effects(device).get(Moment.CLAIM)
        if effect is not None:
            yield device.name, effect.does


def _drilled(cell: Cell) -> Iterator[Device]:
    """Return the arms that a driver moves, and no adapter."""
    adapted = {each.device for each in cell.adapters}
    return (device for device in cell.devices if device.kind == "arm" and device.name not in adapted)


def _without_a_claim(cell: Cell, device: Device) -> Iterator[tuple[str, str]]:
    effects = _effects(device)
    if (ended := effects.get(Moment.DEACTIVATE)) is not None:
        began = "G4" if device.control.startup_state == "active" else "G4 and activate it as above"
        yield f"End the hardware launch with Ctrl-C. Start it again as in {began}.", _follows(cell, device, ended, ())
    cut, again = effects.get(Moment.LINK_LOST), effects.get(Moment.RECONNECT)
    if cut is None or again is None:
        return
    if again.motion in _CALM and cut.motion in _CALM:
        act = "Unplug its communication cable for 10 s. Leave its power on."
        yield act, _follows(cell, device, cut, cut.ends, hears=False)
        yield "Plug its communication cable in again.", _follows(cell, device, again, cut.ends)
    else:
        yield "Do not unplug its communication cable while it is active.", f"On reconnection: {_MOVES[again.motion]}"


def _with_a_claim(cell: Cell, device: Device) -> Iterator[tuple[str, str]]:
    stop = _tripped(device)
    effect = None if stop is None else effect_of(device, stop)
    if stop is None or effect is None:
        return
    lost = (*effect.ends, *stop.ends)
    follows = _follows(cell, device, effect, lost)
    reported = any(need in heard(cell, device) for need in lost)
    if effect.leaves != "active":
        ends = "Its goal must end and its controllers must be inactive."
    elif reported:
        ends = f"Within {shortest(WATCH_WITHIN_S)} s its claim must be dropped and its goal must end."
    else:
        ends = "Nothing ends its goal: cancel it."
    yield f"Trip {stop.name} during a small goal. Record the stopping distance.", f"{follows} {ends}"
    if effect.leaves == "active" and stop.left_by is not LeftBy.ACTIVATION:
        resumes = "Nothing may move before the claim is acknowledged." if reported else _MOVES[Motion.JUMPS]
        yield "Reset the stop and let the device continue, without a jog.", resumes
        resumed = _effects(device).get(Moment.PROGRAM_RESUME)
        if resumed is not None and resumed.motion is Motion.JUMPS:
            jog = "Do not jog it while its program is paused. Stop the program, jog one joint, and start the program."
            yield jog, resumes


def _tripped(device: Device) -> SafetyState | None:
    """Return the stop that people try: a protective one where the device has it, else its first."""
    stops = stops_of(device)
    return next((stop for stop in stops if stop.name == "protective_stop"), next(iter(stops), None))


def _effects(device: Device) -> Mapping[Moment, Effect]:
    return {} if device.control.hardware is None else device.control.hardware.effects


def _follows(cell: Cell, device: Device, effect: Effect, lost: tuple[Need, ...], *, hears: bool = True) -> str:
    """Return what moves, the state of the component, and the topics that say so."""
    said = [_MOVES[effect.motion]]
    if effect.drops_part:
        said.append("What it holds falls.")
    if effect.leaves is not None:
        said.append(f"Its component must be {effect.leaves}.")
        telling = heard(cell, device)
        topics = dict.fromkeys(telling[need].topic for need in lost if need in telling and hears)
        if topics:
            said.append(f"It must show on {' and '.join(topics)}.")
        elif effect.leaves == "active":
            said.append("No topic reports it.")
    return " ".join(said)
