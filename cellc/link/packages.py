"""Binds `packages:`, the folders of the repository in which ROS packages lie that descriptions name."""

from __future__ import annotations

import os
from pathlib import Path

from cellc.description.packages import lies_under, repository_of
from cellc.diagnostics import Diagnostic, Outcome, Severity
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec


def link_packages(spec: CellSpec, document: SourceDocument) -> Outcome[tuple[str, ...]]:
    """Return each folder as the current folder sees it; of one that may not be searched, why.

    A folder is relative to the file that names it, as includes are, and lies in the repository of the spec with every
    link followed; without version control that is the spec's own folder.
    """
    repository = repository_of(os.path.dirname(document.file) or ".")
    folders: list[str] = []
    problems: list[Diagnostic] = []
    for number, written in enumerate(spec.packages):
        place = document.locate(("packages", number))
        folder = os.path.normpath(Path(place.file).parent / written).replace(os.sep, "/")
        if os.path.isabs(written) or not lies_under(folder, repository):
            code, message = "include-escape", f"`{written}` leads out of the repository of the spec"
            advice = "name a folder of the repository, relative to the spec, or give it with `--package-path`"
        elif not os.path.isdir(folder):
            code, message = "file-not-found", f"there is no folder `{folder}`"
            advice = "name the folder that holds the packages, relative to the spec"
        else:
            folders.append(folder)
            continue
        problems.append(Diagnostic(code, Severity.ERROR, message, place, ("packages", number), advice))
    return Outcome(None if problems else tuple(folders), tuple(problems))
