"""The devices of the catalog, and which of them answer what somebody looks for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from textwrap import wrap

from pydantic import TypeAdapter, ValidationError

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.load import CatalogDevice, device_names, load_device
from cellc.compiler.formats.markdown_table import Link, table
from cellc.compiler.spec.quantity import Length, Mass, Quantity
from cellc.contract.diagnostics.wording import aligned
from cellc.contract.printing import Line, Style, Styled


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """What somebody looks for; None where everything will do. Lengths in m, masses in kg, both at least."""

    words: tuple[str, ...] = ()
    kind: str | None = None
    reach_m: float | None = None
    payload_kg: float | None = None
    distro: str | None = None


def entries() -> Iterator[CatalogDevice]:
    """Yield every device of the catalog, in alphabetical order."""
    for name in device_names():
        entry = load_device(name).value
        assert entry is not None  # package data, held valid by the catalog's tests
        yield entry


class Answer(str, Enum):
    """Whether a device has the figures that are wanted."""

    YES = "yes"
    NO = "no"
    UNKNOWN = "UNKNOWN"


def answers(wanted: Wanted) -> Mapping[Answer, tuple[CatalogDevice, ...]]:
    """Return the devices by their answer; what states no figure does not answer no.

    Devices of another name, kind or distribution are left out, and without a kind all but arms where a reach is wanted.
    """
    kind = "arm" if wanted.reach_m is not None and wanted.kind is None else wanted.kind
    asked = [entry for entry in entries() if _is_asked(entry.model, replace(wanted, kind=kind))]
    given = [_answer(entry.model, wanted) for entry in asked]
    return {
        answer: tuple(entry for entry, found in zip(asked, given, strict=True) if found is answer) for answer in Answer
    }


def _answer(model: DeviceModel, wanted: Wanted) -> Answer:
    figures = ((wanted.reach_m, reach_of(model)), (wanted.payload_kg, payload_of(model)))
    stated = [(least, figure) for least, figure in figures if least is not None]
    if any(figure is not None and figure < least - _ROUNDING for least, figure in stated):
        return Answer.NO
    return Answer.UNKNOWN if any(figure is None for _, figure in stated) else Answer.YES


def _is_asked(model: DeviceModel, wanted: Wanted) -> bool:
    packages = model.packages
    said = (model.model, model.vendor, model.summary, model.kind, packages.driver, packages.sdk, packages.description)
    text = " ".join(part for part in said if part).lower()
    return (
        all(word.lower() in text for word in wanted.words)
        and wanted.kind in (None, model.kind)
        and (wanted.distro is None or wanted.distro in distributions(model))
    )


_ROUNDING = 1e-9


def reach_of(model: DeviceModel) -> float | None:
    """Return the vendor's figure in m."""
    return None if model.limits.reach is None else model.limits.reach.value.si


def payload_of(model: DeviceModel) -> float | None:
    """Return the vendor's figure in kg."""
    return None if model.limits.payload is None else model.limits.payload.value.si


def distributions(model: DeviceModel) -> tuple[str, ...]:
    """Name the distributions for which the vendor's packages are released or built, in the order of the facts."""
    rows = (row for row in model.versions if row.part == "driver" and row.distro is not None)
    return tuple(dict.fromkeys(row.distro.value for row in rows if row.distro and (row.known or row.built_from)))


def meters(text: str) -> float:
    """Return a length in m from a text with its unit, as in a spec.

    Raises:
        ValueError: the text is not a length; the message says why.
    """
    return _read(_LENGTH, text)


def kilograms(text: str) -> float:
    """Return a mass in kg from a text with its unit, as in a spec.

    Raises:
        ValueError: the text is not a mass; the message says why.
    """
    return _read(_MASS, text)


_LENGTH, _MASS = TypeAdapter(Length), TypeAdapter(Mass)


def _read(figure: TypeAdapter[Quantity], text: str) -> float:
    try:
        return figure.validate_python(text).si
    except ValidationError as problem:
        raise ValueError(problem.errors()[0]["msg"].removeprefix("Value error, ")) from None


def listed(devices: Iterable[CatalogDevice], columns: int) -> Iterator[Line]:
    """Yield a line for each device: model, kind, vendor, reach, payload, distributions, what it is.

    What it is comes below where a terminal of so many columns has no room for it.
    """
    rows = [_columns(entry.model) for entry in devices]
    facts = aligned((_HEAD[:-1], *(row[:-1] for row in rows)))
    beside = max(map(len, facts)) + 2
    margin = beside if columns - beside >= _NARROWEST else 4
    for number, (fact, row) in enumerate(zip(facts, (_HEAD, *rows), strict=True)):
        words = [" " * margin + line for line in wrap(row[-1], max(_NARROWEST, columns - margin)) or [""]]
        lines = [fact, *words] if margin < beside else [fact.ljust(margin) + words[0].lstrip(), *words[1:]]
        yield from ((Styled(line, Style.DIM),) if number == 0 else line for line in lines if rows)


_NARROWEST = 40
"""Columns that a sentence needs."""


def answered(given: Mapping[Answer, tuple[CatalogDevice, ...]], wanted: Wanted, columns: int) -> Iterator[Line]:
    """Yield the devices that have what is wanted, and then those of which it is not known, and those that have less."""
    yield from listed(given[Answer.YES], columns)
    reasons = {Answer.UNKNOWN: "not known, no figure is stated", Answer.NO: "no, too small"}
    for answer, reason in reasons.items() if wanted.reach_m is not None or wanted.payload_kg is not None else ():
        names = ", ".join(entry.model.model for entry in given[answer])
        if names:
            yield from wrap(f"{reason}: {names}", columns, subsequent_indent="  ", break_on_hyphens=False)


_HEAD = ("model", "kind", "vendor", "reach", "payload", "driver for", "what it is")


def _columns(model: DeviceModel) -> tuple[str, ...]:
    reach, payload = model.limits.reach, model.limits.payload
    return (
        model.model,
        model.kind,
        model.vendor,
        "" if reach is None else reach.value.text,
        "" if payload is None else payload.value.text,
        " ".join(distributions(model)),
        model.summary,
    )


def listed_in_table(devices: Iterable[CatalogDevice]) -> str:
    """Write the same as a table of Markdown, each model with a link to its page."""
    rows = (_columns(entry.model) for entry in devices)
    return table(_HEAD, ((Link(row[0], f"{row[0]}.md"), *row[1:]) for row in rows))
