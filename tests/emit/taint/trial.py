"""Which places of a folder take a text, and where the others refuse it: many at once, the culprits looked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from cellc.compiler.pipeline import Checked, check
from cellc.contract.diagnostics import Diagnostic, Severity
from tests.emit.taint.places import Place, columns_of, with_texts

Files = Mapping[str, str]


@dataclass(slots=True)
class Trial:
    """What became of each place that was given a text.

    Attributes:
        taken: those where it stayed, with the checked spec that holds all of them.
        refused: those with an error on their line.
        elsewhere: those that have an error on another line.
        seen: what was said on the way.
    """

    checked: Checked
    taken: dict[Place, str]
    refused: dict[Place, Diagnostic] = field(default_factory=dict)
    elsewhere: dict[Place, Diagnostic] = field(default_factory=dict)
    seen: list[Checked] = field(default_factory=list)


def checked_with(folder: Path, files: Files, texts: Mapping[Place, str]) -> Checked:
    """Write the files with other texts at places into a folder, and check the spec there."""
    for name, text in with_texts(files, texts).items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return check(folder / "cell.yaml")


def tried(
    folder: Path, files: Files, texts: Mapping[Place, str], suspects: Mapping[Place, str] = MappingProxyType({})
) -> Trial:
    """Take out places with an error until none is left; an error on another line has one culprit, which is looked for.

    Places with one text are one: a name and what refers to it. Errors of one stage hide those of the next: it takes
    some rounds.

    Args:
        suspects: the code that places were culprits of with other texts; all of one code are taken out at once.
    """
    trial = Trial(checked_with(folder, files, texts), dict(texts))
    while errors := errors_of(trial.checked):
        trial.seen.append(trial.checked)
        hit = _hit(folder, files, trial.taken, errors)
        again = {place: errors[0] for place in trial.taken if suspects.get(place) == errors[0].code}
        if not hit and again:
            trial.elsewhere |= again
            hit = again
        elif not hit:
            text, error = _culprit(folder, files, trial.taken, errors[0])
            own = {place: error for place, one in trial.taken.items() if one == text}
            on_line = _hit(folder, files, dict.fromkeys(own, text), [error])
            (trial.refused if on_line else trial.elsewhere).update(own)
            hit = own
        else:
            by_text = {texts[place]: error for place, error in hit.items()}
            hit = {place: by_text[text] for place, text in trial.taken.items() if text in by_text}
            trial.refused |= hit
        for place in hit:
            del trial.taken[place]
        trial.checked = checked_with(folder, files, trial.taken)
    return trial


def errors_of(checked: Checked) -> list[Diagnostic]:
    """Return the findings that keep artifacts from being written."""
    return [diagnostic for diagnostic in checked.diagnostics if diagnostic.severity is Severity.ERROR]


def _culprit(folder: Path, files: Files, texts: Mapping[Place, str], error: Diagnostic) -> tuple[str, Diagnostic]:
    """Return the text that an error comes from, and the error: the last of the shortest beginning that shows it."""
    several = list(dict.fromkeys(texts.values()))
    assert several, f"with its own texts: {error}"
    low, high = 0, len(several)  # the first `low` do not show it, the first `high` do
    while high - low > 1:
        middle = (low + high) // 2
        some = set(several[:middle])
        given = {place: text for place, text in texts.items() if text in some}
        found = errors_of(checked_with(folder, files, given))
        if same := [finding for finding in found if (finding.code, finding.yaml_path) == (error.code, error.yaml_path)]:
            high, error = middle, same[0]
        else:
            low = middle
    return several[high - 1], error


def _hit(folder: Path, files: Files, texts: Mapping[Place, str], errors: list[Diagnostic]) -> dict[Place, Diagnostic]:
    """Return the places that an error marks; where it marks none exactly, nothing."""
    lines: dict[tuple[str, int], dict[Place, range]] = {}
    for place, columns in columns_of(files, texts).items():
        lines.setdefault((str(folder / place.file), place.line), {})[place] = columns
    found: dict[Place, Diagnostic] = {}
    for error in errors:
        here = lines.get((error.span.file, error.span.line), {})
        found |= {place: error for place, columns in here.items() if len(here) == 1 or error.span.column in columns}
    return found
