"""Cells of one call that would discover each other are told so, and only those."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cellc.compiler.rules.shared_domain import Presence, way_between
from cellc.contract.diagnostics import Span
from tests.cli.run import MINIMAL, run

_APART = ("10.1.0.1/24", "10.2.0.1/24")
_HERE = Span("cell.yaml", 1, 1, 1, 2)


def _cell(*cards: str, domain: int = 7, discovery: str = "multicast", peers: tuple[str, ...] = ()) -> Presence:
    return Presence("cell", _HERE, domain, discovery, cards, peers, _HERE)


def test_one_domain_in_one_subnet_meets_by_multicast() -> None:
    assert way_between(_cell("10.1.0.1/24"), _cell("10.1.0.2/24")) == "by multicast in 10.1.0.0/24"


def test_cells_that_ask_one_discovery_server_meet_through_it() -> None:
    ours, theirs = (replace(_cell(card, discovery="server"), servers=frozenset({"10.1.0.1:11811"})) for card in _APART)
    assert way_between(ours, theirs) == "through the server 10.1.0.1:11811"
    other = replace(theirs, servers=frozenset({"10.1.0.1:11812"}))
    assert way_between(ours, other) is None
    assert way_between(ours, _cell("10.1.0.2/24")) is None


def test_larger_subnet_around_a_smaller_one_meets_it() -> None:
    assert way_between(_cell("10.1.0.1/16"), _cell("10.1.3.2/24")) == "by multicast in 10.1.0.0/16"


def test_a_peer_of_the_other_cell_meets_it() -> None:
    ours = _cell("10.1.0.1/24", discovery="unicast", peers=("10.2.0.1",))
    assert way_between(ours, _cell("10.2.0.1/24", discovery="unicast")) == "through the peer 10.2.0.1"


@pytest.mark.parametrize(
    "other",
    [
        _cell("10.1.0.2/24", domain=8),
        _cell("10.2.0.2/24"),
        _cell("10.1.0.2/24", discovery="localhost"),
        _cell("10.1.0.2/24", discovery="off"),
        _cell("10.1.0.2/24", discovery="unicast", peers=("10.1.0.9",)),
        _cell("10.1.0.1/24"),
        _cell(),
    ],
    ids=["other domain", "other subnet", "localhost", "off", "no peer", "same computer", "no card"],
)
def test_cells_that_do_not_meet(other: Presence) -> None:
    assert way_between(_cell("10.1.0.1/24"), other) is None
    assert way_between(other, _cell("10.1.0.1/24")) is None


def _spec(folder: Path, name: str, address: str, domain: int) -> str:
    file = folder / f"{name}.yaml"
    text = Path(MINIMAL).read_text(encoding="utf-8").replace("cell: minimal", f"cell: {name}")
    network = f"network: {{domain_id: {domain}, discovery: multicast}}\n"
    hosts = f"hosts: {{pc: {{nics: {{cell: {{address: {address}, carries: [ros]}}}}}}}}\n"
    file.write_text(network + hosts + text, encoding="utf-8")
    return file.as_posix()


@pytest.mark.parametrize("command", ["check", "build"])
def test_second_cell_of_a_domain_is_reported_at_its_line(command: str, tmp_path: Path) -> None:
    first, second = _spec(tmp_path, "one", "10.1.0.1/24", 7), _spec(tmp_path, "two", "10.1.0.2/24", 7)
    output = ["-o", str(tmp_path / "out")] if command == "build" else []
    for _ in range(2):  # computed, and kept
        done = run(command, first, second, *output)
        assert done.code == 1
        assert "shared-domain-id" in done.out
        assert f"{second}:1" in done.out
        assert f"{first}:1" in done.out
    assert (tmp_path / "out" / "one").is_dir() is (command == "build")
    assert not (tmp_path / "out" / "two").exists()


def test_other_domain_is_not_reported(tmp_path: Path) -> None:
    first, second = _spec(tmp_path, "one", "10.1.0.1/24", 7), _spec(tmp_path, "two", "10.1.0.2/24", 8)
    assert "shared-domain-id" not in run("check", first, second).out
