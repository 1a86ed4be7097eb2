"""The devices of the catalog, and which of them answer what somebody looks for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

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


def found(wanted: Wanted) -> tuple[CatalogDevice, ...]:
    """Return the devices that answer everything that is wanted; what states no figure answers no question for one."""
    return tuple(entry for entry in entries() if _answers(entry.model, wanted))


def _answers(model: DeviceModel, wanted: Wanted) -> bool:
    packages = model.packages
    said = (model.model, model.vendor, model.summary, model.kind, packages.driver, packages.sdk, packages.description)
    text = " ".join(part for part in said if part).lower()
    reach, payload = reach_of(model), payload_of(model)
    return (
        all(word.lower() in text for word in wanted.words)
        and wanted.kind in (None, model.kind)
        and (wanted.reach_m is None or (reach is not None and reach >= wanted.reach_m - _ROUNDING))
        and (wanted.payload_kg is None or (payload is not None and payload >= wanted.payload_kg - _ROUNDING))
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


def listed(devices: Iterable[CatalogDevice]) -> Iterator[Line]:
    """Yield a line for each device: model, kind, reach, payload, distributions, what it is."""
    head, *rows = aligned((_HEAD, *(_columns(entry.model) for entry in devices)))
    if rows:
        yield (Styled(head, Style.DIM),)
    yield from rows


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
