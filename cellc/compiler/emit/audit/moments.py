"""Tables of the audit on what devices do by themselves: at each moment of their life, and in a stop."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.cell.stops import effect_of, stops_of
from cellc.compiler.deploy.watches import heard
from cellc.compiler.formats.escape import code
from cellc.compiler.formats.markdown_table import TableCell, table
from cellc.contract.vocabulary import CommandAuthority, LeftBy, ManagerLock, Moment

_NOT_STATED = "not stated"
_AUTHORITY = {
    CommandAuthority.TAKEN: "takes command of the device",
    CommandAuthority.GIVEN_BACK: "returns command of the device",
    CommandAuthority.UNKNOWN: "command of the device: unknown",
}


def moments_section(cell: Cell) -> str:
    """Write what each device does as its driver starts, is activated, claimed, released and ended."""
    return table(("device", "moment", "moves", "besides", "if missing", "what happens"), _moments(cell))


def _moments(cell: Cell) -> Iterator[tuple[TableCell, ...]]:
    for device in cell.devices:
        hardware = device.control.hardware
        effects = {} if hardware is None else {_words(moment): effect for moment, effect in hardware.effects.items()}
        starts = {f"start of {code(node)}": effect for node, effect in device.control.starts.items()}
        offered = ((offer.name, offer.effect) for offer in device.control.offers if offer.effect)
        answered = (call for owner in cell.controllers if owner.device == device.name for call in owner.calls.items())
        calls = {f"call of {code(name)}": effect for name, effect in (*offered, *answered)}
        for moment, effect in {**effects, **starts, **calls}.items():
            missing = tuple(f"{_words(need)}: {_words(otherwise)}" for need, otherwise in effect.needs.items())
            direct = hardware is not None and hardware.direct_activation and moment == Moment.ACTIVATE
            once = (f"in one call from {hardware.initial_state}",) if direct and hardware is not None else ()
            besides = (*once, *_besides(effect))
            yield device.name, moment, effect.motion.value, besides, missing, effect.does


def _besides(effect: Effect) -> Iterator[str]:
    """Yield what a moment does besides motion."""
    if effect.authority is not CommandAuthority.UNCHANGED:
        yield _AUTHORITY[effect.authority]
    if effect.lock is not ManagerLock.NONE:
        yield f"blocks the controller manager: {_words(effect.lock)}"
    if effect.drops_part:
        yield "drops a held part"
    if effect.leaves is not None:
        yield f"component: {effect.leaves}"
    if effect.ends:
        yield f"a claim lacks: {', '.join(map(_words, effect.ends))}"


def _words(name: str) -> str:
    return name.replace("_", " ")


def stops_section(cell: Cell) -> str:
    """Write what a stop of each device leaves, how this cell hears of it, and what brings its motion back."""
    return table(("device", "stop", "component", "heard on", "ends by", "then"), _stops(cell))


def _stops(cell: Cell) -> Iterator[tuple[TableCell, ...]]:
    for device in cell.devices:
        topic_of = {need: proof.topic for need, proof in heard(cell, device).items()}
        for state in stops_of(device):
            effect = effect_of(device, state)
            lost = (*(() if effect is None else effect.ends), *state.ends)
            left = _NOT_STATED if effect is None or effect.leaves is None else effect.leaves
            topics = tuple(dict.fromkeys(code(topic_of[need]) for need in lost if need in topic_of))
            known = topics or "nothing" if left == "active" else "the component"
            goes_on = device.control.hardware is not None and topics and state.left_by is not LeftBy.ACTIVATION
            resumed = (
                device.control.hardware.effects.get(Moment.PROGRAM_RESUME)
                if device.control.hardware and goes_on
                else None
            )
            then = resumed or effect
            yield device.name, state.name, left, known, state.left_by.value, then.does if then else _NOT_STATED
