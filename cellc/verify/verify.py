"""Read our artifacts back with parsers that we did not write."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.artifact import Artifact
from cellc.diagnostics import Diagnostic
from cellc.graph.cell_graph import CellGraph
from cellc.verify.codes import Disagreement
from cellc.verify.description import cell_poses, check_description
from cellc.verify.files import check_json, check_text


def verify(artifacts: Sequence[Artifact], graph: CellGraph) -> tuple[Diagnostic, ...]:
    """Return a diagnostic for everything that foreign parsers make of the artifacts and the cell does not mean.

    Each finding is a bug of cellc; it stands at the name of the cell. Importing this module takes about half a second
    and is left to commands that build.
    """
    place = graph.cell.locate("cell")
    found = [disagreement.at(place) for disagreement in _disagreements(artifacts, graph)]
    return tuple(sorted(found, key=Diagnostic.sort_key))


def _disagreements(artifacts: Sequence[Artifact], graph: CellGraph) -> Iterator[Disagreement]:
    malformed = tuple(check_text(artifacts))
    yield from malformed
    yield from check_json(artifacts)
    frames = cell_poses(graph.frames)
    joints = [joint for device in graph.cell.devices for joint in device.joints]
    broken = {disagreement.path for disagreement in malformed}
    for artifact in artifacts:
        if artifact.path.endswith(".urdf") and artifact.path not in broken:
            yield from check_description(artifact, frames, joints)
