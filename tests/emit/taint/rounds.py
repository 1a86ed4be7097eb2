"""One round: a hostile text in every place of a folder at once, and what became of it in all that is made."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from unittest.mock import patch

from cellc.compiler.pipeline import Checked, compile_cell
from tests.emit.taint.judge import differences
from tests.emit.taint.outputs import outputs
from tests.emit.taint.payloads import PAYLOADS, WAYS, text_of, twin_of
from tests.emit.taint.places import Place, families, places_of, single
from tests.emit.taint.programs import misled
from tests.emit.taint.trial import Files, Trial, checked_with, errors_of, tried
from tests.robustness.fuzz.forked_child import forking

KINDS = ("single", "family")
"""Each place alone, or a name at once with what refers to it."""


@contextmanager
def behind_the_readers() -> Iterator[None]:
    """Let texts in that other programs evaluate, so that what writes files is held by itself."""
    with (
        patch("cellc.compiler.source.compose.substitution", lambda text: None),
        patch("cellc.robot.description.urdf_reader.substitution", lambda text: None),
    ):
        yield


@dataclass(frozen=True, slots=True)
class Round:
    """What a round showed; ``faults`` is empty where every text was refused, or was text everywhere."""

    trial: Trial
    faults: tuple[str, ...]


def run(
    folder: Path,
    files: Files,
    kind: str,
    turn: int,
    endings: tuple[str, ...] = (".yaml", ".urdf"),
    suspects: Mapping[Place, str] = MappingProxyType({}),
) -> Round:
    """Give every place the payload whose turn it is, let what refuses refuse, and read what is made of the rest.

    Args:
        kind: one of ``KINDS``.
        turn: as many turns as there are payloads give each of them to each place.
        endings: of the files whose places are tried.
        suspects: the code of places whose texts are refused on the line of another, as far as they are known.
    """
    texts = _texts(files, kind, turn, endings)
    with forking():
        trial = tried(folder, files, texts, suspects)
        said = (fault for checked in (*trial.seen, trial.checked) for fault in outputs(checked))
        return Round(trial, (*dict.fromkeys(said), *_faults(folder, files, trial)))


def _texts(files: Files, kind: str, turn: int, endings: tuple[str, ...]) -> dict[Place, str]:
    places = tuple(place for place in places_of(files) if place.file.endswith(endings))
    units = [(place,) for place in single(places)] if kind == "single" else list(families(places).values())
    # The mark of a family comes first: what is sorted by name stays in order.
    ways = WAYS if kind == "single" else WAYS[1:]
    payloads = list(PAYLOADS.values())
    return {
        place: text_of(payloads[(number + turn) % len(payloads)], number, ways[turn % len(ways)], place.original)
        for number, unit in enumerate(units)
        for place in unit
    }


def _faults(folder: Path, files: Files, trial: Trial) -> Iterator[str]:
    harmless = {place: twin_of(text, place.original) for place, text in trial.taken.items()}
    twin = checked_with(folder, files, harmless)
    yield from (f"the harmless twin is refused: {error.span}: {error.message}" for error in errors_of(twin))
    if twin.ok:
        texts = {harmless[place]: text for place, text in trial.taken.items()}
        made = _made(trial.checked)
        yield from differences(made, _made(twin), texts)
        yield from misled(made)


def _made(checked: Checked) -> Mapping[str, str]:
    compiled = compile_cell(checked)
    assert compiled.value is not None
    assert not compiled.diagnostics, [found.message for found in compiled.diagnostics]
    return {artifact.path: artifact.text for artifact in compiled.value}
