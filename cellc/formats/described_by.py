"""Which node can be asked for the description that a controller manager runs, so that its hardware plugins show."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.link.frames import ROBOT_STATE_PUBLISHER
from cellc.link.nodes import DESCRIPTION_PUBLISHER, description_home


def described_by(cell: Cell) -> tuple[str, ...]:
    """Return the nodes whose parameter ``robot_description`` is what the managers run, each once.

    Managers may have been started on several hosts, each with a target of its own: one answer does not tell of all.
    """
    return tuple(dict.fromkeys(_node(cell, manager) for manager in cell.managers))


def _node(cell: Cell, manager: ControllerManager) -> str:
    if cell.distro == "humble":  # its manager takes the description as a parameter, later ones from its publisher
        return manager.node
    if len(cell.managers) > 1:
        return f"{description_home(manager)}/{DESCRIPTION_PUBLISHER}"
    return f"/{ROBOT_STATE_PUBLISHER}"
