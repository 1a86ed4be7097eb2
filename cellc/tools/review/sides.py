"""What is compared: a spec, a generated folder, or either of them in a git revision; each becomes one package."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from cellc.contract.diagnostics import Diagnostic, Severity
from cellc.contract.errors import CellcError
from cellc.contract.limits import limits, option
from cellc.contract.manifest import Manifest
from cellc.contract.printing import progress
from cellc.contract.reading import FormatError, read_json
from cellc.contract.review import ReviewFinding
from cellc.mock.errors import MockError
from cellc.mock.folder import read_text
from cellc.tools.report.json_report import as_review_finding
from cellc.tools.review.absent import no_package, no_path, not_in_revision
from cellc.tools.review.facts import MANIFEST, Facts, FactsError, facts_of
from cellc.tools.review.objects import RevisionError
from cellc.tools.review.revisions import Taken, repository_of

if TYPE_CHECKING:
    from cellc.compiler.pipeline import Checked
    from cellc.compiler.source.document import SourceDocument


class SideError(CellcError):
    """A side cannot be compared; the text is one line, lower case."""


class PlantSideError(SideError):
    """A side is a plant, whose own lines are compared, and not a package."""


@dataclass(frozen=True, slots=True)
class Side:
    """One side as asked for.

    Args:
        path: spec or folder; in a revision from the top of the repository of ``within``.
        revision: None for what is in the work tree.
        within: a folder in the repository.
        merged_into: the side is what ``revision`` and this revision have in common.
    """

    name: str
    path: str
    revision: str | None = None
    within: Path = Path()
    merged_into: str | None = None


@dataclass(frozen=True, slots=True)
class Package:
    """One side with everything that is compared.

    Attributes:
        files: text by path in the package.
        findings: what the check says, where the side is a spec.
        excused: what it would say without the comments of the spec.
        is_spec: whether it is one.
        document: the spec, where it is one.
    """

    name: str
    files: Mapping[str, str]
    facts: Facts
    findings: tuple[ReviewFinding, ...] = ()
    excused: tuple[ReviewFinding, ...] = ()
    is_spec: bool = False
    notes: tuple[str, ...] = ()
    document: SourceDocument | None = None

    @property
    def errors(self) -> tuple[ReviewFinding, ...]:
        """What keeps its package from being built."""
        return tuple(found for found in self.findings if found.severity == Severity.ERROR)


def sides(arguments: Sequence[str]) -> tuple[Side, Side]:
    """Return what one or two arguments name, as those of `git diff` do.

    One path is HEAD against the work tree. `A..B PATH` are two revisions, `A...B PATH` what B did since it left A,
    `REV PATH` a revision against the work tree. `REV:PATH` counts from the top of the repository, as git has it.

    Raises:
        SideError: an argument names nothing.
    """
    if len(arguments) == 1 and ".." in arguments[0] and "/" not in arguments[0] and not Path(arguments[0]).exists():
        raise SideError(f"expected a spec or a folder after `{arguments[0]}`")
    if len(arguments) == 1:
        if not Path(arguments[0]).exists():
            raise SideError(no_path(arguments[0]))
        _refuse_folder(arguments[0], Path(arguments[0]))
        return _revised("HEAD", arguments[0]), _stated(arguments[0])
    first, second = arguments
    _refuse_ambiguous(first, second)
    if not Path(first).exists():
        if ".." in first and ":" not in first:
            return _range(first, second)
        if ":" not in first:
            _refuse_unknown(first, second)
            return _revised(first, second), _stated(second)
    return _stated(first), _stated(second)


def _refuse_ambiguous(first: str, second: str) -> None:
    """Refuse a name of a file that a revision has too, as git does: a branch may hold a file named as its base."""
    if not Path(first).exists() or first.startswith(("/", "./", "../")):
        return
    named = first.partition(":")[0]
    try:
        repository = repository_of(Path(second).absolute())
        for revision in re.split(r"\.{2,3}", named):
            repository.commit(revision or "HEAD")
    except RevisionError:
        return
    raise SideError(
        f"`{first}` is a revision and a file; write `./{first}` for the file, or name the revision otherwise"
    )


def _refuse_unknown(first: str, second: str) -> None:
    """Refuse what is neither a revision nor there: a folder that was not built looks like a branch."""
    if "/" not in first or not Path(second).exists():
        return
    try:
        repository_of(Path(second).absolute()).commit(first)
    except RevisionError:
        raise SideError(no_path(first, second)) from None


def _stated(argument: str) -> Side:
    revision, colon, path = argument.partition(":")
    if Path(argument).exists() or not colon:
        return Side(argument, argument)
    if path.startswith(("./", "../")):
        return replace(_revised(revision, path), name=argument)
    return Side(argument, path, revision)


def _revised(revision: str, path: str) -> Side:
    """Return a path of the work tree as it is in a revision."""
    place = Path(path)
    folder = place if place.is_dir() else place.parent
    try:
        top = repository_of(folder.absolute()).top.resolve()
        inside = (place.parent.resolve() / place.name).relative_to(top).as_posix()
    except (RevisionError, ValueError) as problem:
        raise SideError(str(problem)) from None
    return Side(f"{revision}:{inside}", inside, revision, folder.absolute())


def _range(text: str, path: str) -> tuple[Side, Side]:
    dots = "..." if "..." in text else ".."
    first, _, second = text.partition(dots)
    before, after = (_revised(text or "HEAD", path) for text in (first, second))
    if dots == "...":
        before = replace(before, name=f"{text}:{before.path}", merged_into=after.revision)
    return before, after


@contextmanager
def packages(*wanted: Side) -> Iterator[tuple[tuple[Package, Path], ...]]:
    """Give the package of each side, with the path of its spec or folder for as long as it is there.

    Raises:
        SideError: a side cannot be read or linked.
    """
    with ExitStack() as stack:
        try:
            yield tuple(_package(side, stack) for side in wanted)
        except RevisionError as problem:
            raise SideError(str(problem)) from None


def located(side: Side, stack: ExitStack) -> Path:
    """Return the spec or folder of a side, which is there for as long as the stack is open.

    Raises:
        SideError: nothing is there.
    """
    if side.revision is None:
        return Path(side.path)
    try:
        return _taken(side, stack).path
    except RevisionError as problem:
        raise SideError(str(problem)) from None


def _taken(side: Side, stack: ExitStack) -> Taken:
    assert side.revision is not None  # the others are in the work tree
    repository = repository_of(side.within.absolute())
    revision = side.revision
    if side.merged_into is not None:
        revision = repository.merge_base(revision, side.merged_into)
    path = PurePosixPath(side.path).as_posix()
    if repository.objects.entry(repository.commit(revision), path) is None:
        instead = not_in_revision(repository, revision, path)
        raise SideError(f"revision `{revision}` has no `{path}`{instead}")
    return stack.enter_context(repository.taken(revision, path))


def _package(side: Side, stack: ExitStack) -> tuple[Package, Path]:
    if side.revision is None:
        return _read(side.name, Path(side.path), side.path), Path(side.path)
    taken = _taken(side, stack)
    package = _read(side.name, taken.path, taken.path.as_posix())
    named = _names_shown(side, taken)
    findings, excused = (
        tuple(_shown_from(finding, named) for finding in each) for each in (package.findings, package.excused)
    )
    links = (f"{side.name}: {taken.links} links or submodules were left out",) if taken.links else ()
    return replace(package, findings=findings, excused=excused, notes=(*package.notes, *links)), taken.path


def _names_shown(side: Side, taken: Taken) -> Mapping[str, str]:
    shown = f"{side.revision}:{PurePosixPath(side.path).parent.as_posix()}/"
    return {f"{taken.folder.as_posix()}/": shown, f"{taken.top.as_posix()}/": f"{side.revision}:"}


def findings_at(revision: str, file: str) -> tuple[ReviewFinding, ...]:
    """Return what a check says of a file as it is in a revision; nothing where the revision has no such file.

    Raises:
        SideError: there is no such revision.
    """
    from cellc.compiler.pipeline import judge

    side = _revised(revision, file)
    repository = repository_of(side.within.absolute())
    try:
        repository.commit(revision)
    except RevisionError as problem:
        raise SideError(str(problem)) from None
    try:
        with repository.taken(revision, side.path) as taken:
            named = _names_shown(side, taken)
            return tuple(_shown_from(as_review_finding(each), named) for each in judge(taken.path).diagnostics)
    except RevisionError:
        return ()


def _shown_from(found: ReviewFinding, named: Mapping[str, str]) -> ReviewFinding:
    """Return a finding of a spec in a private folder as one of the revision."""
    message, place = found.message, found.place
    for folder, name in named.items():
        message, place = message.replace(folder, name), place.replace(folder, name)
    return found.model_copy(update={"message": message, "place": place})


def _read(name: str, path: Path, shown: str) -> Package:
    try:
        with progress("comparing") as tell:
            tell(name)
            return _of_folder(name, path) if path.is_dir() else _of_spec(name, shown)
    except (FactsError, MockError) as problem:
        raise SideError(f"{name}: {problem}") from None


def _of_spec(name: str, file: str) -> Package:
    # Folders are compared without the compiler, which takes a second to load.
    from cellc.compiler.pipeline import check_buildable

    if not Path(file).exists():
        raise SideError(no_path(file))
    checked = check_buildable(file)
    if checked.plant is not None:
        raise PlantSideError(f"{name} is a plant: a plant is compared with a plant")
    return package_of(name, checked)


def package_of(name: str, checked: Checked) -> Package:
    """Return the package of a cell that was checked; of one in which rules find errors, what it would be.

    Raises:
        SideError: it cannot be linked, is beyond a limit, or does not exist.
    """
    from cellc.compiler.pipeline import emit_graph

    if checked.graph is None:
        raise SideError(first_error(name, checked.diagnostics))
    try:
        emitted = emit_graph(checked.graph)
    except Exception:
        # Emitters take for granted what rules find.
        if checked.ok:
            raise
        raise SideError(first_error(name, checked.diagnostics)) from None
    if emitted.value is None:
        raise SideError(first_error(name, (*checked.diagnostics, *emitted.diagnostics)))
    files = {artifact.path: artifact.text for artifact in emitted.value}
    findings = tuple(as_review_finding(diagnostic) for diagnostic in checked.diagnostics)
    excused = tuple(as_review_finding(diagnostic) for diagnostic in checked.excused)
    facts = facts_of(files, checked.graph.cell, checked.excused)
    return Package(name, files, facts, findings, excused, is_spec=True, document=checked.document)


def first_error(name: str, diagnostics: Sequence[Diagnostic]) -> str:
    """Say which error comes first of a side that holds some."""
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]
    more = f"; {len(errors) - 1} more" if len(errors) > 1 else ""
    first = errors[0]
    return f"{name}:{first.span.line}:{first.span.column}: {first.message}{more}; see `cellc check`"


def _refuse_folder(name: str, path: Path) -> None:
    if path.is_dir() and not (path / MANIFEST).exists():
        raise SideError(no_package(name, path))


def _of_folder(name: str, folder: Path) -> Package:
    _refuse_folder(name, folder)
    try:
        manifest = read_json(read_text(folder, MANIFEST), Manifest)
    except FormatError as problem:
        raise SideError(f"{name}: {MANIFEST}: {problem}") from None
    files, total = dict[str, str](), 0
    for path in (*manifest.files, MANIFEST):
        files[path] = read_text(folder, path)
        total += len(files[path])
        if total > limits().folder_total_bytes:
            text = f"names more than {limits().folder_total_bytes} bytes of files; {option('folder-total-bytes')}"
            raise SideError(f"{name}: {MANIFEST}: {text}")
    facts = facts_of(files)
    edited = tuple(f"{name}: `{path}` was edited after it was generated" for path in sorted(facts.edited))
    return Package(name, files, facts, notes=edited)
