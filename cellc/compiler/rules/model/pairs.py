"""Rules on pairs of links whose contact a description of one's own leaves out."""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.feasibility import meeting_links
from cellc.compiler.rules.described import in_its_file, is_own
from cellc.compiler.rules.geometry import SOUND_MODEL, USABLE_MESHES
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.robot.description.model import Description


@rule(Severity.WARNING, assumes=(*SOUND_MODEL, *USABLE_MESHES, "geometry-too-large"))
def allowed_pair_that_meets(graph: CellGraph) -> Findings:
    """Yield pairs of an arm that two joints or more move against each other, and that meet in some posture."""
    asked = {
        frozenset(pair): device
        for device in graph.cell.devices
        for pair in device.body.allowed_collisions
        if device.kind == "arm" and is_own(graph, device) and _bends(device.body.description, pair)
    }
    pairs = tuple((min(pair), max(pair)) for pair in map(tuple, asked))
    for met in meeting_links(graph, tuple(sorted(pairs))):
        device = asked[frozenset((met.first, met.second))]
        message = f"`{met.first}` and `{met.second}` of `{device.name}` meet in {met.reason} of all postures, but"
        message += " `allowed_collisions` takes their contact out of every check"
        links = (device.body.description.link(name) for name in (met.first, met.second))
        related = tuple(
            Related(f"`{link.name}`", link.span) for link in links if link is not None and link.span is not None
        )
        related += in_its_file(device, "allowed_collisions", _index(device, met.first, met.second))
        yield found(graph, (*device.path, "model"), message, related=related)


def _index(device: Device, *links: str) -> int:
    return [set(pair) for pair in device.body.allowed_collisions].index(set(links))


def _bends(description: Description, pair: tuple[str, str]) -> bool:
    """Tell whether two joints or more are between two links, none of which follows another: the jaws of a tool meet."""
    above = {joint.child: joint for joint in description.joints}
    chains: list[dict[str, bool]] = []
    for link in pair:
        chain: dict[str, bool] = {}
        while link in above and above[link].name not in chain:
            chain[above[link].name] = above[link].movable
            if above[link].mimic is not None:
                return False
            link = above[link].parent
        chains.append(chain)
    first, second = chains
    between = [
        moves for one, other in ((first, second), (second, first)) for name, moves in one.items() if name not in other
    ]
    return sum(between) > 1
