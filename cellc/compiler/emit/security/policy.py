"""``security/policy.xml``: who may publish, subscribe, serve and call; everything else is denied.

SROS2 policy 0.2.0, read by ``ros2 security create_permission``. One enclave a node, one for the controller manager's
process with its controllers and hardware nodes, one for the spawners, one for the program of the bring-up, one for
what people type while they pass the gates, and
one for the command with which they act there. Only the clients that the spec declares may call an action and only its
sources may publish a topic. Left out: keys and certificates, which belong into no repository.

What nodes of one kind have in common is once in ``security/common.xml`` and included by XInclude, which sros2 resolves
as it loads a policy (sros2 0.13.0, sros2/policy/__init__.py, and its own test/policies/common).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.first_goal import NODE, first_goals
from cellc.compiler.deploy.spawning import spawnings
from cellc.compiler.emit.security.rights import (
    Kind,
    Profile,
    Rights,
    bring_up_process,
    manager_client,
    manager_process,
    node_profiles,
    observer,
    people,
    rights_of_kinds,
    sender,
)
from cellc.compiler.formats.xml_text import element, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.enclaves import (
    bring_up_enclave,
    commissioning_enclave,
    enclave_of,
    first_goal_enclave,
    manager_enclave,
    observe_enclave,
    people_enclave,
    spawner_enclave,
)
from cellc.contract.bring_up import BringUp

_COMMON = "common.xml"
_POLICY = {"version": "0.2.0", "xmlns:xi": "http://www.w3.org/2001/XInclude"}
_LISTS = {
    "publish": "topics",
    "subscribe": "topics",
    "reply": "services",
    "request": "services",
    "execute": "actions",
    "call": "actions",
}


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the policy, and what it includes."""
    cell, header = graph.cell, plan.header.text
    enclaves, shared = dict(_enclaves(cell, plan.bring_up)), rights_of_kinds(cell, plan.bring_up)
    used = {kind for profiles in enclaves.values() for profile in profiles for kind in profile.kinds}
    kinds = [kind for kind, rights in shared.items() if kind in used and any(rights)]
    common = (element(kind.value, children=_lists(shared[kind])) for kind in kinds)
    policy = (_enclave(path, profiles, kinds) for path, profiles in enclaves.items())
    yield Artifact(f"security/{_COMMON}", render(element("common", children=common), header))
    yield Artifact("security/policy.xml", render(element("policy", _POLICY, [element("enclaves", {}, policy)]), header))


def granted(cell: Cell, plan: BringUp) -> Mapping[str, frozenset[tuple[str, str]]]:
    """Return what each node may do, as pairs of right and name, by the node's full name."""
    shared = rights_of_kinds(cell, plan)
    found: dict[str, frozenset[tuple[str, str]]] = {}
    for profile in (profile for _, profiles in _enclaves(cell, plan) for profile in profiles):
        rights = profile.all_rights(shared)._asdict()
        pairs = frozenset((right, name) for right, names in rights.items() for name in names)
        found[profile.full_name] = found.get(profile.full_name, frozenset()) | pairs
    return found


def _enclaves(cell: Cell, plan: BringUp) -> Iterator[tuple[str, tuple[Profile, ...]]]:
    for node in cell.nodes:
        if node.source is not NodeSource.STANDARD or node.name != "controller_manager":
            yield enclave_of(cell, node), tuple(node_profiles(cell, node))
    for manager in cell.managers:
        yield manager_enclave(cell, manager), tuple(manager_process(cell, manager))
        yield spawner_enclave(cell, manager), tuple(_spawners(cell, manager))
    yield bring_up_enclave(cell), tuple(bring_up_process(cell, plan))
    if senders := tuple(sender(cell, f"/{NODE}", goal.action, goal.topic) for goal in first_goals(cell)):
        yield first_goal_enclave(cell), senders
    yield observe_enclave(cell), (observer(cell, plan),)
    yield people_enclave(cell), tuple(people(cell))
    yield commissioning_enclave(cell), tuple(people(cell, Kind.COMMISSIONING))


def _spawners(cell: Cell, manager: ControllerManager) -> Iterator[Profile]:
    # The spawner names itself after its first controller.
    for spawning in spawnings(manager):
        yield manager_client(cell, manager, f"spawner_{spawning.controllers[0]}")


def _enclave(path: str, profiles: Iterable[Profile], kinds: Iterable[Kind]) -> Element:
    elements = (_profile(profile, kinds) for profile in profiles)
    return element("enclave", {"path": path}, [element("profiles", children=elements)])


def _profile(profile: Profile, kinds: Iterable[Kind]) -> Element:
    """Return ``<profile>``: what it includes, and one list for each right that it has besides."""
    namespace, _, node = profile.full_name.rpartition("/")
    included = (_include(kind) for kind in profile.kinds if kind in kinds)
    return element("profile", {"ns": namespace or "/", "node": node}, [*included, *_lists(profile.own)])


def _include(kind: Kind) -> Element:
    return element("xi:include", {"href": _COMMON, "xpointer": f"xpointer(/common/{kind.value}/*)"})


def _lists(rights: Rights) -> Iterator[Element]:
    """Yield one list a right; a name is once in each, in alphabetical order."""
    for right, names in rights._asdict().items():
        if names:
            plural = _LISTS[right]
            entries = (element(plural[:-1], text=name) for name in sorted(set(names)))
            yield element(plural, {right: "ALLOW"}, entries)
