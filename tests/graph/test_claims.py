"""Which controllers own what, in every state that declared switches reach."""

from __future__ import annotations

from cellc.compiler.cell.control import Controller, ControllerManager, ControllerSwitch
from cellc.compiler.graph.claims import ClaimGraph, WrittenParameter, can_switch, explore
from cellc.contract.diagnostics import Span
from cellc.contract.vocabulary import Behavior

SPAN = Span("cell.yaml", 1, 1, 1, 2)


def controller(name: str, *claims: str, active: bool = False) -> Controller:
    return Controller(
        name=name,
        path=("control", "controllers", name),
        span=SPAN,
        manager="control",
        label=name,
        kind="forward_command",
        behavior=Behavior.FORWARD_COMMAND,
        plugin="any/Plugin",
        command_interfaces=claims,
        active=active,
    )


def switch(name: str, activate: tuple[str, ...] = (), deactivate: tuple[str, ...] = ()) -> ControllerSwitch:
    return ControllerSwitch(name=name, path=("switches", name), span=SPAN, activate=activate, deactivate=deactivate)


def graph(controllers: tuple[Controller, ...], switches: tuple[ControllerSwitch, ...] = ()) -> ClaimGraph:
    manager = ControllerManager(
        name="control", path=("control",), span=SPAN, update_rate_hz=500.0, controllers=controllers, switches=switches
    )
    return ClaimGraph(tuple(explore(manager)))


def test_start_state_holds_the_controllers_that_are_active() -> None:
    claims = graph((controller("a", "j/position", active=True), controller("b", "j/position")))
    (start,) = claims.at_start()
    assert [c.name for c in start.active] == ["a"]
    assert list(claims.conflicts()) == []


def test_conflict_is_found_two_switches_away_with_the_way_there() -> None:
    controllers = (
        controller("a", "j/position", active=True),
        controller("b", "k/position"),
        controller("c", "j/position"),
    )
    switches = (switch("first", ("b",)), switch("second", ("c",), ("b",)))
    (conflict,) = graph(controllers, switches).conflicts()
    assert conflict.state.switches == ("first", "second")
    assert (conflict.interface, conflict.first.name, conflict.second.name) == ("j/position", "a", "c")


def test_nothing_is_reached_through_a_refused_switch() -> None:
    controllers = (
        controller("a", "j/position", active=True),
        controller("b", "j/position"),
        controller("c", "k/position"),
    )
    switches = (switch("clash", ("b",)), switch("then", ("c",), ("b",)))
    assert "c" not in graph(controllers, switches).ever_active("control")


def test_exchange_of_claims_in_one_switch_is_no_conflict() -> None:
    controllers = (controller("a", "j/position", active=True), controller("b", "j/position"))
    switches = (switch("to_b", ("b",), ("a",)), switch("to_a", ("a",), ("b",)))
    claims = graph(controllers, switches)
    assert list(claims.conflicts()) == []
    assert claims.ever_active("control") == {"a", "b"}
    assert len(claims.states) == 2


def test_strict_switch_is_refused_as_the_controller_manager_does() -> None:
    # controller_manager, STRICT: deactivate what is not active, or activate what is, aborts; both lists restart.
    assert not can_switch(frozenset({"a"}), switch("x", (), ("b",)))
    assert not can_switch(frozenset({"a"}), switch("x", ("a",)))
    assert can_switch(frozenset({"a"}), switch("x", ("a",), ("a",)))


def test_items_of_a_parameter_are_those_of_its_list_or_itself() -> None:
    of_list = WrittenParameter(controller("a"), "joints", ("left", "right"), ("parameters", "joints"))
    assert list(of_list.items()) == [(("parameters", "joints", 0), "left"), (("parameters", "joints", 1), "right")]
    of_text = WrittenParameter(controller("a"), "joint", "left", ("parameters", "joint"))
    assert list(of_text.items()) == [(("parameters", "joint"), "left")]
