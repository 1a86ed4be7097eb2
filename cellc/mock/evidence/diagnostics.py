"""What /diagnostics would say: controllers and hardware components that are active, and missed update cycles."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.mock.control import ControllerManager
from cellc.mock.evidence.bag.messages import DiagnosticStatus
from cellc.mock.plant import Plant

_OK, _WARN, _ERROR = 0, 1, 2


def diagnose(plant: Plant, now_ns: int) -> tuple[DiagnosticStatus, ...]:
    """Return the present status of every controller manager and of its update loop."""
    return tuple(_statuses(plant, now_ns))


def _statuses(plant: Plant, now_ns: int) -> Iterator[DiagnosticStatus]:
    for name, manager in plant.control.managers.items():
        namespace = plant.contract.managers[name].namespace.strip("/")
        node = f"{namespace}/controller_manager" if namespace else "controller_manager"
        yield _activity(f"{node}: Controllers Activity", "controllers", _controllers(manager), _WARN)
        yield _activity(f"{node}: Hardware Components Activity", "hardware components", _components(manager), _ERROR)
        histories = [history for (owner, _), history in plant.control.histories.items() if owner == name]
        missed = sum(history.missed_until(now_ns) for history in histories)
        text = "no update cycle was missed" if missed == 0 else f"{missed} update cycles were missed"
        yield DiagnosticStatus(
            _ERROR if missed else _OK, f"{node}: Update Cycles", text, (("missed_cycles", str(missed)),)
        )


def _activity(name: str, what: str, states: tuple[tuple[str, str], ...], level: int) -> DiagnosticStatus:
    active = all(state == "active" for _, state in states)
    text = f"all {what} are active" if active else f"not all {what} are active"
    return DiagnosticStatus(_OK if active else level, name, text, states)


def _controllers(manager: ControllerManager) -> tuple[tuple[str, str], ...]:
    return tuple((controller.name, controller.state) for controller in manager.list_controllers())


def _components(manager: ControllerManager) -> tuple[tuple[str, str], ...]:
    return tuple((component.name, component.state) for component in manager.list_hardware_components())
