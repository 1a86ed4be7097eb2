"""No key without an effect: deleted alone, a file or a finding is another, or it states what is assumed without it.

What a changed value does is in ``tests/review/test_every_leaf.py``. Keys that do nothing beside others have rules:
``policy-without-effect``, ``impedance-without-effect``, ``threads-without-effect``, ``load-of-nothing`` and more.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest

from cellc.compiler.pipeline import check, emit_cell
from tests.cells import EVERY_CELL, spec_of
from tests.foreign_yaml import safe_load
from tests.sample import sample

_SHARE = 36
_HOLD_NAMES = frozenset(
    (
        "adapters", "areas", "approvals", "calibrations", "callbacks", "controllers", "devices", "frames", "from",
        "goals", "groups", "hosts", "interfaces", "managers", "mock_plugins", "mock_programs", "nics", "nodes",
        "packages", "parameters", "poses", "rehearsals", "remaps", "responsibilities", "scene", "switches", "to",
        "tolerances",
    )
)  # fmt: skip
_PLACES = re.compile(r"\.yaml:\d+(:\d+)?|\"(line|column|end_line|end_column)\": \d+|[0-9a-f]{16,}")

ASSUMED = {
    "bringup.gates": "`standard`",
    "control.host": "the only host",
    "devices.*.architecture": "`ros2`",
    "devices.*.connection.first_port": "the first that is free",
    "devices.*.limits.acceleration": "100 %",
    "devices.*.mount.xyz": "0 0 0 m",
    "devices.*.program.mode": "`local`",
    "devices.*.serial": "UNKNOWN",
    "hosts.*.clock.domain": "`ros`",
    "interfaces.*.from.*.reliability": "`reliable`",
    "interfaces.*.to.*.reliability": "`reliable`",
    "managers.*.host": "the only host",
    "nodes.*.host": "the only host",
    "rehearsals.*.confidence": "95 %",
    "safety.recovery.acknowledge": "`operator`",
    "versions.rollback": "UNKNOWN, as its two keys",
    "versions.rollback.configuration": "UNKNOWN",
    "versions.rollback.image": "UNKNOWN",
}
"""What cells state although it is so without the key."""


def _keys(data: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        if isinstance(key, str):
            yield (*path, key)
        yield from _keys(value, (*path, key))


def _kind(path: tuple[str | int, ...]) -> str:
    pairs = zip((None, *path), path, strict=False)
    return ".".join("*" if isinstance(key, int) or above in _HOLD_NAMES else key for above, key in pairs)


def _shown(file: str, data: Any) -> tuple[list[str], dict[str, str]]:
    """Return the findings of a spec and its files, without places in the spec and without what hashes it."""
    checked = check(file, {file: json.dumps(data, indent=1)})
    emitted = emit_cell(checked).value if checked.ok else None
    files = {file.path: _PLACES.sub("", file.text) for file in emitted or () if file.path != "manifest.json"}
    return [f"{found.code} {found.message}" for found in checked.diagnostics], files


def _without(data: Any, path: tuple[str | int, ...]) -> Any:
    copy = json.loads(json.dumps(data))
    holder = copy
    for key in path[:-1]:
        holder = holder[key]
    del holder[path[-1]]
    return copy


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_a_key_that_is_deleted_changes_something(cell: str, request: pytest.FixtureRequest) -> None:
    file = spec_of(cell).as_posix()
    data = json.loads(json.dumps(safe_load(spec_of(cell).read_text(encoding="utf-8")), default=str))
    before = _shown(file, data)
    kinds = {_kind(path): path for path in _keys(data)}
    taken = sample(request, list(kinds.items()), _SHARE, lambda kind: f"{cell}: {kind[0]}")
    silent = {kind for kind, path in taken if _shown(file, _without(data, path)) == before}
    assert silent <= ASSUMED.keys()
