"""Every xacro file of some folders, expanded by the real xacro and by cellc: agree, both refuse, or how they differ.

    nice python -m benchmarks.xacro_differential FOLDER [FOLDER …] [--every N]

Each folder is a checkout, and all of them together are where packages are looked for, by both. The real xacro asks
`ament_index_python` for packages; a stand-in answers as cellc does, so that what is compared is the expansion alone.
Each file is expanded with the arguments that it declares, in a process of its own kind, with a bound of time.
"""

from __future__ import annotations

import multiprocessing
import signal
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import xacro

from cellc.contract.printing import show
from cellc.robot.description.packages import find_package, root_of, use_packages
from cellc.robot.description.xacro_expansion import expand_here

_WITHIN_S = 60
_ASKS_THE_MACHINE = ("xacro-refused-substitution", "xacro-outside-root")
"""Refused by intention, whatever the real xacro answers."""


@dataclass(frozen=True, slots=True)
class Row:
    """What became of a file, and what each side said where they differ."""

    file: Path
    outcome: str
    why: str = ""


def main() -> None:
    """Print a row for each file that differs, and how many do what."""
    given = sys.argv[1:]
    every = int(given.pop(given.index("--every") + 1)) if "--every" in given else 1
    folders = [Path(argument).resolve() for argument in given if argument != "--every"]
    files = [file for folder in folders for file in sorted(folder.rglob("*.xacro")) if file.is_file()][::every]
    rows = []
    with multiprocessing.get_context("fork").Pool(2, maxtasksperchild=20) as pool:
        for row in pool.imap(partial(_compared, folders), files):
            rows.append(row)
            if row.outcome.startswith("differ"):
                show(f"{row.outcome}: {row.file}: {row.why}")
    show(*(f"{count:5} {outcome}" for outcome, count in Counter(row.outcome for row in rows).most_common()))


def _compared(folders: list[Path], file: Path) -> Row:
    signal.signal(signal.SIGALRM, _too_late)
    signal.alarm(_WITHIN_S)
    use_packages([str(folder) for folder in folders])
    root, found = root_of(file), dict[str, str]()
    try:
        real, refusal = _real(file, root, found)
        ours = expand_here(file.as_posix(), {}, root.as_posix())
    except TimeoutError:
        return Row(file, "too long for one of them")
    finally:
        signal.alarm(0)
    said = "" if ours.value is not None else f"{ours.diagnostics[0].code}: {ours.diagnostics[0].message}"
    if real is None or ours.value is None:
        return _refused(file, real is None, refusal, said)
    apart = next(_differences(_root(real), _root(ours.value.text), found), "")
    return Row(file, "differ in what they write", apart) if apart else Row(file, "agree")


def _refused(file: Path, by_real: bool, refusal: str, said: str) -> Row:
    if by_real and said:
        return Row(file, "both refuse", f"{refusal} | {said}")
    if by_real:
        return Row(file, "differ: the real one alone refuses", refusal)
    asks = said.startswith(_ASKS_THE_MACHINE)
    return Row(file, "refused by intention" if asks else "differ: cellc alone refuses", said)


def _real(file: Path, root: Path, found: dict[str, str]) -> tuple[str | None, str]:
    """Return what the real xacro writes, or None and what it says; ``found`` gets the packages that it asked for."""

    def folder_of(name: str) -> str:
        folder = find_package(name, root.as_posix())
        if folder is None:
            raise LookupError(name)
        found[name] = folder
        return folder

    index, packages = ModuleType("ament_index_python"), ModuleType("ament_index_python.packages")
    packages.get_package_share_directory = folder_of  # type: ignore[attr-defined]
    sys.modules |= {"ament_index_python": index, "ament_index_python.packages": packages}
    try:
        document: Any = xacro.process_file(file.as_posix(), mappings={}, verbosity=0)
        return str(document.toprettyxml(indent="  ")), ""
    except TimeoutError:
        raise
    except Exception as error:
        return None, " ".join(f"{type(error).__name__}: {error}".split())[:300]


def _root(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(text)


def _differences(real: ElementTree.Element, ours: ElementTree.Element, found: dict[str, str]) -> Iterator[str]:
    """Yield what is otherwise in two trees: tags, attributes, texts without their white space, in order."""
    theirs, mine = (
        (
            item.tag,
            {name: _named(value, found) for name, value in item.attrib.items()},
            " ".join((item.text or "").split()),
        )
        for item in (real, ours)
    )
    if theirs != mine:
        yield f"{theirs} and {mine}"
    if len(real) != len(ours):
        yield f"{len(real)} and {len(ours)} elements in <{real.tag}>"
    for first, second in zip(real, ours, strict=False):
        yield from _differences(first, second, found)


def _named(value: str, found: dict[str, str]) -> str:
    """Name the file of a mesh by its package, as cellc does."""
    path = value.removeprefix("file://")
    for name, folder in sorted(found.items()):
        for written in (folder, f"/{folder}"):
            if path.startswith(f"{written}/"):
                return f"package://{name}{path[len(written) :]}"
    return value


def _too_late(_signal: int, _frame: object) -> None:
    raise TimeoutError


if __name__ == "__main__":
    main()
