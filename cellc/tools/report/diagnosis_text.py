"""Diagnoses as lines for people: what is certain, what is asked where nothing is, and what rules each cause out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from cellc.contract.printing import Line, Style, Styled

if TYPE_CHECKING:
    from cellc.tools.diagnose.diagnose import Answer, Cause, First, Route, Suspicion
    from cellc.tools.diagnose.symptoms import LayerKnowledge


def render_answer(answer: Answer) -> Iterator[Line]:
    """Yield what a text may mean; where no layer is certain, first the question that decides."""
    yield from (f"named: {line}" for line in answer.named)
    if not answer.fits:
        yield from _nearest(answer)
        yield from render_first(answer.first)
        yield from render_routes(answer.routes)
    elif answer.weak:
        yield (
            Styled(f"not sure, no known symptom fits well; the part is likely: {answer.routes[-1].name}", Style.BOLD),
        )
        yield f"one question decides: {answer.ask}"
        yield from _counted(answer)
        yield from render_first(answer.first)
        yield from render_routes(answer.routes)
        yield from ("", (Styled("or, by their words alone, one of these:", Style.BOLD),))
        for suspicion in answer.suspicions:
            yield f"  {suspicion.layer}: {suspicion.symptom}"
            yield from (f"    {number}. {cause.text}?" for number, cause in enumerate(suspicion.causes, 1))
            yield f"    do not: {suspicion.never}"
        yield "  `cellc diagnose` with one of these names instead of the text shows what rules each cause out"
    elif answer.ask:
        layers = list(dict.fromkeys(suspicion.layer for suspicion in answer.suspicions))
        guess = f"likely, not sure: {layers[0]}" if answer.likely else f"not sure: {', or '.join(layers)}?"
        yield (Styled(guess, Style.BOLD),)
        yield from _question("one question decides", answer, "; or ")
        yield from _counted(answer)
        yield from render_first(answer.first)
        first, *others = answer.suspicions
        yield from ("", *_suspicion(first))
        for suspicion in others:
            yield from ("", *_further(suspicion))
        yield from render_routes(answer.routes, "if none of these: ")
    else:
        yield from render_suspicions(answer.suspicions)


def _counted(answer: Answer) -> Iterator[Line]:
    if answer.stated:
        yield f"counted with, as the text says it: {'; '.join(answer.stated)}"


def render_first(first: Sequence[First]) -> Iterator[Line]:
    """Yield what is looked at first, each cause with the one observation that tells."""
    if first:
        yield from ("", (Styled("first looks, by the parts and words that the text names:", Style.BOLD),))
    for number, each in enumerate(first, 1):
        part = f"{each.part}: " if each.part else ""
        yield f"  {number}. {part}{each.cause}?"
        yield "     ", Styled("$" if each.is_command else "look at", Style.BLUE), f" {each.action}"
    sources = dict.fromkeys(each.source for each in first if each.source)
    if sources:
        yield f"  source: {'; '.join(sources)}"


def render_routes(routes: Sequence[Route], intro: str = "") -> Iterator[Line]:
    """Yield what is looked at, in the order in which it halves what is left."""
    for number, route in enumerate(routes):
        yield from ("", (Styled(f"{intro if number == 0 else ''}{route.name}, in this order", Style.BOLD),))
        for place, step in enumerate(route.steps, 1):
            mark = "$" if step.is_command else "look at"
            yield f"  {place}. ", Styled(mark, Style.BLUE), f" {step.action}"
            yield "     ", Styled("either", Style.GREEN), f" {step.good}"
            yield "     ", Styled("or", Style.GREEN), f" {step.bad}"
        yield f"  source: {route.source}"


def _question(intro: str, answer: Answer, between: str) -> Iterator[Line]:
    yield f"{intro}: {answer.ask}"
    yield "  ", Styled("yes", Style.GREEN), f": {between.join(answer.yes)}"
    yield "  ", Styled("no", Style.GREEN), f": {between.join(answer.no)}"


def _nearest(answer: Answer) -> Iterator[Line]:
    yield "UNKNOWN: no known symptom fits" + ("; the nearest are:" if answer.suspicions else "")
    for suspicion in answer.suspicions:
        yield "  ", Styled(f"{suspicion.layer}: {suspicion.symptom}", Style.BOLD)
        yield f"    most likely: {suspicion.causes[0].text}"
    yield from _question("ask first", answer, ", then ")
    yield "use other words or paste a line of the log; `cellc diagnose` alone lists every symptom"


def render_suspicions(suspicions: tuple[Suspicion, ...]) -> list[Line]:
    """Return every suspicion with its hypotheses, the best first, separated by empty lines."""
    shown: list[Line] = []
    for suspicion in suspicions:
        shown += ["", *_suspicion(suspicion)]
    return shown[1:]


def render_symptoms(layers: Sequence[LayerKnowledge]) -> list[Line]:
    """Return the name of every symptom under the layer that it belongs to."""
    shown: list[Line] = []
    for layer in layers:
        shown += ["", (Styled(layer.title, Style.BOLD),), *(f"  {symptom.name}" for symptom in layer.symptoms)]
    number = sum(len(layer.symptoms) for layer in layers)
    example = layers[0].symptoms[0].name
    return [
        *shown[1:],
        "",
        f'{number} symptoms; `cellc diagnose "{example}" cell.yaml` lists the causes of one',
    ]


def _further(suspicion: Suspicion) -> Iterator[Line]:
    """Yield a suspicion that is not the first one, with the first observation of each cause."""
    yield (Styled(f"{suspicion.layer}: {suspicion.symptom}", Style.BOLD),)
    for number, cause in enumerate(suspicion.causes, 1):
        yield from _cause(number, replace(cause, steps=cause.steps[:1], omitted=0))
    yield f"  do not: {suspicion.never}"


def _suspicion(suspicion: Suspicion) -> Iterator[Line]:
    yield (Styled(f"{suspicion.layer}: {suspicion.symptom}", Style.BOLD),)
    if suspicion.evidence:
        yield f"  named in the line: {', '.join(suspicion.evidence)}"
    for name in suspicion.unknown:
        yield f"  {name} is not part of this cell"
    for number, cause in enumerate(suspicion.causes, 1):
        yield from _cause(number, cause)
    yield f"  do not: {suspicion.never}"
    yield f"  who decides: {suspicion.owner}"
    yield f"  source: {suspicion.source}"


def _cause(number: int, cause: Cause) -> Iterator[Line]:
    yield f"  {number}. {cause.text}?"
    for step in cause.steps:
        mark = "$" if step.is_command else "look at"
        yield "     ", Styled(mark, Style.BLUE), f" {step.action}"
        if not step.refuted:
            yield "       it shows the node behind the line, NODE below: a logger is no name of a node"
            continue
        yield "       ", Styled("less likely if" if step.blind else "ruled out if", Style.GREEN), f" {step.refuted}"
        if step.blind:
            yield f"       not more than that: {step.blind}"
    if cause.omitted:
        yield f"     likewise for {cause.omitted} more; name one in the symptom to see it alone"
