"""Every fact of what a device does in the world reaches a file of a cell with the device, or is no fact of the catalog.

A fact is consumed if the cell is generated otherwise once the fact is another one: what no stage reads changes nothing.
A session takes one fact of four; with ``--long`` every one is taken.
"""

from __future__ import annotations

import enum
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import zip_longest
from pathlib import Path

import pytest
from pydantic import BaseModel

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.load import device_names, load_device
from cellc.compiler.deploy import deployment
from cellc.compiler.deploy.deployment import plan_deployment
from cellc.compiler.emit import gates
from cellc.compiler.emit.audit import audit
from cellc.compiler.emit.contract import contract
from cellc.compiler.emit.launch import launch
from cellc.compiler.graph.cell_graph import build_graph
from cellc.compiler.link import devices
from cellc.compiler.link.link import link
from cellc.compiler.source import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.parse import parse
from cellc.compiler.spec.quantity import Quantity
from cellc.contract.diagnostics import Outcome
from cellc.contract.manifest import ConfigurationInputs
from tests.cells import EVERY_CELL, device_of, document_of, graph_of, spec_of, spec_text, there, written
from tests.cli.run import run
from tests.sample import sample

Place = tuple[str | int, ...]
_SHARE = 4
_ROOTS: tuple[Place, ...] = (
    ("safety",),
    ("control", "hardware", "real", "effects"),
    ("control", "hardware", "real", "reported_by"),
    ("control", "hardware", "real", "start"),
)
_BY_A_PERSON = "program: {played_by: operator, mode: local}"
_STARTED = ("program: {played_by: operator, mode: remote}", "program: {played_by: driver, mode: remote}")
_EVIDENCE = ("source", "why")
"""Keys that say where a fact is read; people find them on the page of the device."""


def _child(value: object, key: str | int) -> object:
    if isinstance(value, Mapping):
        return value.get(key)
    if isinstance(value, tuple):
        return value[int(key)]
    return getattr(value, str(key), None)


def _at(value: object, place: Place) -> object:
    for key in place:
        value = _child(value, key)
    return value


def _children(value: object) -> Iterator[tuple[str | int, object]]:
    if isinstance(value, BaseModel):
        yield from ((name, getattr(value, name)) for name in value.model_fields_set if name not in _EVIDENCE)
    elif isinstance(value, Mapping):
        yield from value.items()
    elif isinstance(value, tuple) and any(isinstance(item, BaseModel) for item in value):
        yield from enumerate(value)


def _facts(value: object, place: Place) -> Iterator[Place]:
    """Yield the places of facts that a file states below a value; what must hold is one fact for all distributions."""
    below = () if "needs" in place[-2:-1] else tuple(_children(value))
    if below:
        for key, child in below:
            yield from _facts(child, (*place, key))
    elif value is not None and not isinstance(value, BaseModel) and value not in ((), {}):
        yield place


def _other(value: object) -> object:
    """Return another value of the kind of this one."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, enum.Enum):
        return next(member for member in reversed(type(value)) if member is not value)
    if isinstance(value, Mapping):
        return {key: _other(one) for key, one in value.items()}
    if isinstance(value, tuple):
        return value[1:]
    if isinstance(value, Quantity):
        return replace(value, si=2.0 * value.si)
    if isinstance(value, (int, float)):
        return value + 1
    if isinstance(value, str):
        return {"active": "inactive", "inactive": "active", "unconfigured": "inactive"}.get(value, f"{value} otherwise")
    raise AssertionError(f"no other value of {value!r}")


def _changed(value: object, place: Place, new: object) -> object:
    if not place:
        return new
    key, inner = place[0], _changed(_child(value, place[0]), place[1:], new)
    if isinstance(value, BaseModel):
        return value.model_copy(update={str(key): inner})
    if isinstance(value, Mapping):
        return {**value, key: inner}
    assert isinstance(value, tuple)
    return tuple(inner if index == key else one for index, one in enumerate(value))


def _roots(model: DeviceModel) -> Iterator[Place]:
    """Yield where a device has facts of what it does: the life of its hardware, and effects of what its driver has."""
    yield from _ROOTS
    # What has another name in another distribution does the same there.
    for kind in ("nodes", "services", "actions"):
        effects = [one.effect for one in getattr(model, kind)]
        yield from ((kind, index, "effect") for index, one in enumerate(effects) if one not in effects[:index])
    for name, controller in model.controllers.items():
        stated = (index for index, service in enumerate(controller.services) if service.effect is not None)
        yield from (("controllers", name, "services", index, "effect") for index in stated)


@cache
def _parsed(spec: Path) -> tuple[CellSpec, SourceDocument]:
    document = document_of(spec)
    return there(parse(document).value), document


def _texts(spec: Path) -> Iterator[str]:
    graph = build_graph(there(link(*_parsed(spec)).value))
    plan = plan_deployment(graph)
    stages = (contract.emit, launch.emit, gates.emit, audit.emit)
    return (artifact.text for emit in stages for artifact in emit(graph, plan))


def _without_identity(_: object) -> ConfigurationInputs:
    """Leave out the hash over all facts: it tells no person, and no stage, what any of them says."""
    return ConfigurationInputs(calibrations={}, tf_publishers={}, urdf_sha256="", cell_sha256="")


@cache
def _cells() -> Mapping[str, tuple[Path, ...]]:
    """Return the cells of the repository by the models of their devices."""
    used: dict[str, list[Path]] = {}
    for cell in EVERY_CELL:
        for device in graph_of(spec_of(cell)).cell.devices:
            used.setdefault(device.model, []).append(spec_of(cell))
    return {model: tuple(dict.fromkeys(paths)) for model, paths in used.items()}


def _models() -> Iterator[str]:
    """Yield one device of each set of facts; the models of a family share theirs."""
    known: list[tuple[object, ...]] = []
    for name in sorted(device_names(), key=lambda name: (name not in _cells(), name)):
        model = device_of(name).model
        facts = tuple(_at(model, root) for root in _roots(model))
        if facts not in known and any(facts):
            known.append(facts)
            yield name


def _specs(name: str, folder: Path) -> tuple[Path, ...]:
    """Return cells with a device: those of the repository, the ways in which its program starts, or a first one."""
    if name not in _cells():
        assert run("init", "bench", name).code == 0
        return (folder / "cells/bench/cell.yaml",)
    others = []
    for number, started in enumerate(_STARTED if _BY_A_PERSON in spec_text(_cells()[name][0].parent.name) else ()):
        (folder / str(number)).mkdir()
        text = spec_text(_cells()[name][0].parent.name).replace(_BY_A_PERSON, started)
        others.append(written(folder / str(number), text))
    return (*_cells()[name], *others, *_with_every_controller(name, folder))


def _with_every_controller(name: str, folder: Path) -> Iterator[Path]:
    """Yield the first cell with a device, with the controllers of it that answer services and that the cell lacks."""
    cell = _cells()[name][0].parent.name
    text, model = spec_text(cell), device_of(name).model
    called = next(device.name for device in graph_of(spec_of(cell)).cell.devices if device.model == name)
    lacking = (kind for kind, one in model.controllers.items() if one.services and f"type: {kind}" not in text)
    lines = "".join(f"    {called}_{kind}: {{type: {kind}, device: {called}}}\n" for kind in lacking)
    if lines and text.count("  controllers:\n") == 1:
        (folder / "controllers").mkdir()
        yield written(folder / "controllers", text.replace("  controllers:\n", f"  controllers:\n{lines}"))


def _differ(texts: Sequence[str], others: Iterable[str]) -> bool:
    return any(text != other for text, other in zip_longest(texts, others))


@pytest.mark.parametrize("name", list(_models()))
def test_every_fact_of_a_device_changes_a_file(
    name: str, request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    specs = [*_specs(name, tmp_path)]
    entry = device_of(name)
    monkeypatch.setattr(deployment, "configuration_inputs", _without_identity)
    before = {spec: tuple(_texts(spec)) for spec in specs}
    unread = []
    facts = (fact for root in _roots(entry.model) for fact in _facts(_at(entry.model, root), root))
    for place in sample(request, facts, _SHARE):
        model = _changed(entry.model, place, _other(_at(entry.model, place)))
        assert isinstance(model, DeviceModel)
        other = replace(entry, model=model)

        def loaded(wanted: str, other: object = other) -> object:
            return Outcome(other) if wanted == name else load_device(wanted)

        with monkeypatch.context() as patched:
            patched.setattr(devices, "load_device", loaded)
            # The first text that differs is enough, and the cell that showed the fact before shows the next one.
            seen = next((spec for spec in specs if _differ(before[spec], _texts(spec))), None)
        if seen is None:
            unread.append(".".join(map(str, place)))
        else:
            specs.remove(seen)
            specs.insert(0, seen)
    assert unread == []
