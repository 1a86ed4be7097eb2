"""The rights that several controller managers in one cell bring: own descriptions, merged joint states, like names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.emit.security.profile import Profile

_MERGED = "/joint_states"
_DESCRIPTION = "/robot_description"


def own_namespace(manager: ControllerManager) -> str:
    """Return where the description of one of several managers is published."""
    return manager.namespace or f"/{manager.name}"


def description_topic(cell: Cell, manager: ControllerManager) -> str:
    """Return the topic from which a manager takes its hardware."""
    return f"{own_namespace(manager)}{_DESCRIPTION}" if len(cell.managers) > 1 else _DESCRIPTION


def of_namesake(cell: Cell, namespace: str, node: str, interface: str) -> bool:
    """Whether an interface belongs to a controller of the same name under another manager."""
    homes = {manager.namespace for manager in cell.managers for one in manager.controllers if one.name == node}
    return len(homes) > 1 and not interface.startswith(f"{namespace}/")


def merged(cell: Cell, topics: Iterable[str]) -> Iterator[str]:
    """Yield topics to listen to; the joint states of each of several managers come merged."""
    single = {f"{manager.namespace}{_MERGED}" for manager in cell.managers} if len(cell.managers) > 1 else set()
    return (_MERGED if topic in single else topic for topic in topics)


def description_publisher(manager: ControllerManager, common: Profile) -> Profile:
    """Return the rights of the node that says one manager's description, and no transform that anybody hears."""
    home = own_namespace(manager)
    said = (f"{home}{_DESCRIPTION}", f"{home}/unused/tf", f"{home}/unused/tf_static")
    return _with(common, home, "description_publisher", said, (f"{home}{_MERGED}",))


def joint_state_merger(cell: Cell, common: Profile) -> Profile:
    """Return the rights of the node that gathers the joint states of all managers."""
    heard = (_DESCRIPTION, *(f"{manager.namespace}{_MERGED}" for manager in cell.managers))
    return _with(common, "", "joint_state_merger", (_MERGED,), heard)


def _with(common: Profile, namespace: str, node: str, publish: tuple[str, ...], subscribe: tuple[str, ...]) -> Profile:
    return Profile(
        namespace=namespace,
        node=node,
        publish=(*common.publish, *publish),
        subscribe=(*common.subscribe, *subscribe),
        reply=common.reply,
    )
