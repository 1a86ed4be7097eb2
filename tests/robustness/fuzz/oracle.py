"""What must hold for every input, whatever stands in it."""

from __future__ import annotations

import json
import os
import shutil
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import yaml

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.deployment import plan_deployment
from cellc.compiler.emit.audit.audit import emit as emit_audit
from cellc.compiler.emit.emit_all import emit_all
from cellc.compiler.feasibility import compute, disabled_links, motion_answer
from cellc.compiler.pipeline import Checked, check, compile_cell
from cellc.contract.diagnostics import Diagnostic, Severity
from cellc.contract.diagnostics.unsafe_text import HIDDEN
from cellc.contract.printing import as_text
from cellc.contract.store.cache import OFF
from cellc.mock.cell import load
from cellc.mock.errors import MockError
from cellc.robot.description.packages import use_packages
from cellc.tools.diagnose.diagnose import diagnose
from cellc.tools.report.github_report import render_github
from cellc.tools.report.json_report import render_json
from cellc.tools.report.resolved import flatten, resolved_tree
from cellc.tools.report.sarif_report import render_sarif
from cellc.tools.report.text_report import render_text
from tests.cli.run import run
from tests.robustness.fuzz.bases import PARTS
from tests.robustness.fuzz.cache_damage import damage_cache
from tests.robustness.fuzz.forked_child import forking
from tests.robustness.fuzz.inputs import FOLDER, OUT, SPEC, URDF, XACRO, FuzzInput

SHARES = {"render": 0.05, "show": 0.1, "build": 0.08, "mock": 0.1, "forgetful": 0.05, "rehearse": 0.05}
"""How many of the inputs that come so far go through what a check does not need."""


@dataclass(frozen=True)
class Find:
    """What does not hold: a word of `WRONGS`, and one line or a traceback."""

    wrong: str
    text: str


WRONGS = ("traceback", "hang", "memory", "wrong answer", "message", "artifact", "died")


class Sandbox:
    """A folder that inputs are written into one after the other, and what is known of those before.

    Attributes:
        folder: holds ``parts`` of the corpus, which an input may name.
        cache: the folder where cellc keeps answers meanwhile.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "cell"
        self.cache = folder / "kept" / "cellc"
        self.folder.mkdir()
        self.cache.mkdir(parents=True)
        shutil.copytree(PARTS, self.folder / "parts")
        os.environ["XDG_CACHE_HOME"] = str(self.cache.parent)
        os.environ["XDG_STATE_HOME"] = str(folder / "state")
        use_packages([str(self.folder)])
        os.environ.pop(OFF, None)
        self._written: dict[str, bytes] = {}
        self._kept: set[tuple[tuple[str, bytes], ...]] = set()
        self._truths: dict[tuple[tuple[str, bytes], ...], tuple[object, ...]] = {}

    def write(self, files: Mapping[str, bytes]) -> None:
        """Write files, with nothing left of the input before; a file that is there already is not written again."""
        for name in self._written.keys() - files.keys():
            (self.folder / name).unlink()
        for name in self._written.keys() & files.keys():
            if self._written[name] is not files[name]:
                (self.folder / name).unlink()
        for name, data in files.items():
            if self._written.get(name) is not data:
                file = self.folder / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(data)
        self._written = dict(files)

    def forget(self, folder: str) -> None:
        """Remove a folder with all that was written into it."""
        shutil.rmtree(self.folder / folder, ignore_errors=True)
        self._written = {name: data for name, data in self._written.items() if not name.startswith(f"{folder}/")}

    def fill_cache(self) -> None:
        """Have the answers of the cell kept, where they are not from an input before."""
        key = tuple(sorted(self._written.items()))
        if key not in self._kept:
            _answers()
            self._kept.add(key)

    def truth(self) -> tuple[object, ...]:
        """Return the answers that a run gives which keeps nothing; cells recur, so they are computed once."""
        key = tuple(sorted(self._written.items()))
        if key not in self._truths:
            with _keeping_nothing():
                self._truths[key] = _answers()
        return self._truths[key]


def judge(given: FuzzInput, sandbox: Sandbox, *, in_child: bool = False) -> list[Find]:
    """Take an input through the public entry points and return what does not hold.

    Args:
        in_child: start the children that read what strangers wrote, as commands do; forks of this process are faster.
    """
    with _inside(sandbox.folder), warnings.catch_warnings():
        warnings.simplefilter("error")  # what reaches standard error in words of a library is no answer
        try:
            with nullcontext() if in_child else forking(), _few_samples():
                sandbox.write(given.files)
                judged = {"folder": _generated, "cache": _remembered, "import": _imported}.get(given.kind, _spec)
                return list(judged(given, sandbox))
        except Exception:
            return [Find("traceback", traceback.format_exc())]


def _spec(given: FuzzInput, sandbox: Sandbox) -> Iterator[Find]:
    """Judge a cell: what is said of it, what is built of it, and what the mock makes of that."""
    chance = given.chance
    wanted = {step for step, share in SHARES.items() if chance.random() < share}
    checked = check(SPEC)
    yield from _messages(checked.diagnostics)
    if "render" in wanted:
        yield from _rendered(checked)
    if checked.graph is not None and "forgetful" in wanted:
        with _keeping_nothing():
            yield from _differences(_said(check(SPEC)), _said(checked))
    if checked.graph is not None and "show" in wanted:
        list(flatten(resolved_tree(checked.graph.cell), ""))
        diagnose("the arm stops with a tolerance violation", checked.graph.cell)
        list(emit_audit(checked.graph, plan_deployment(checked.graph)))
    if checked.ok and "build" in wanted:
        yield from _built(checked, sandbox if "mock" in wanted else None)


def _built(checked: Checked, sandbox: Sandbox | None) -> Iterator[Find]:
    outcome = compile_cell(checked)
    for found in outcome.diagnostics:
        yield Find("artifact", f"{found.code}: {found.message}")
    if outcome.value is None:
        yield Find("artifact", "a cell without an error is not built")
        return
    yield from _unreadable(outcome.value)
    again = check(SPEC)
    assert again.graph is not None  # it was there a moment ago
    texts = {artifact.path: artifact.text for artifact in emit_all(again.graph, plan_deployment(again.graph))}
    for artifact in outcome.value:
        if texts.get(artifact.path, artifact.text) != artifact.text:
            yield Find("artifact", f"{artifact.path} differs between two builds")
    if sandbox is not None:
        sandbox.write({f"{FOLDER}/{item.path}": item.text.encode() for item in outcome.value})
        try:
            cell = load(Path(FOLDER))
            for name in cell.rehearsals[:1]:
                cell.run(name)
        except MockError as error:
            yield Find("artifact", f"the mock refuses what was built: {error}")


def _unreadable(artifacts: Sequence[Artifact]) -> Iterator[Find]:
    readers: dict[str, Callable[[str], object]] = {
        ".json": json.loads,
        ".yaml": lambda text: yaml.load(text, Loader=yaml.CSafeLoader),
        **dict.fromkeys((".xml", ".urdf", ".srdf", ".svg"), ElementTree.fromstring),
    }
    for artifact in artifacts:
        reader = readers.get(os.path.splitext(artifact.path)[1])
        try:
            artifact.text.encode()
            if reader is not None:
                reader(artifact.text)
        except (ValueError, yaml.YAMLError, SyntaxError) as error:
            yield Find("artifact", f"{artifact.path} cannot be read back: {error}")


def _generated(given: FuzzInput, sandbox: Sandbox) -> Iterator[Find]:
    """Judge a generated folder: it runs, or is refused in words."""
    try:
        cell = load(Path(FOLDER), edited=True)
        names = cell.rehearsals if given.chance.random() < SHARES["rehearse"] else ()
        for name in names[:1]:
            cell.run(name)
    except MockError as error:
        if not str(error).strip():
            yield Find("message", "refused without a word")


def _imported(given: FuzzInput, sandbox: Sandbox) -> Iterator[Find]:
    """Judge an import through its command: it succeeds, or is refused in words, and reaches nothing but its folder."""
    before = _names(sandbox.folder)
    try:
        named = XACRO if XACRO in given.files else URDF
        ran = run("import", named, "-o", OUT, *(["--cell"] if given.chance.random() < 0.5 else []))
        said = ran.out + ran.err
        if "Traceback" in said or "bug of cellc" in said or ran.code not in (0, 1, 2):
            yield Find("traceback", said)
        if not said.strip():
            yield Find("message", "ended without a word")
        for name in sorted(_names(sandbox.folder) - before - {SPEC}):
            if not name.startswith(f"{OUT}/"):
                yield Find("wrong answer", f"wrote `{name}`")
        if ran.code == 0 and given.chance.random() < 0.2:
            if run("import", "--check", OUT).code != 0:
                yield Find("wrong answer", "what was imported is not as it was imported")
            again = run("import", named, "-o", OUT)
            if again.code != 0:
                yield Find("wrong answer", f"a second import is refused: {again.out + again.err}")
    finally:
        sandbox.forget(OUT)
        (sandbox.folder / SPEC).unlink(missing_ok=True)


def _names(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_symlink() or path.is_file()}


def _remembered(given: FuzzInput, sandbox: Sandbox) -> Iterator[Find]:
    """Judge the cache: whatever stands in it, the answer is that of a run that keeps nothing."""
    sandbox.fill_cache()
    with _kept_aside(sandbox.cache) if given.damage else nullcontext():
        damage_cache(sandbox.cache, given.damage, given.chance)
        sandbox.write({**given.files, **given.later})
        kept = _answers()
    yield from _differences(sandbox.truth(), kept)


@contextmanager
def _kept_aside(cache: Path) -> Iterator[None]:
    """Put the cache back as it is now."""
    aside = cache.with_name("aside")
    shutil.copytree(cache, aside)
    try:
        yield
    finally:
        if cache.is_dir() and not cache.is_symlink():
            shutil.rmtree(cache)
        else:
            cache.unlink(missing_ok=True)
        aside.rename(cache)


def _answers() -> tuple[object, ...]:
    checked = check(SPEC)
    if checked.graph is None:
        return _said(checked)
    return (*_said(checked), motion_answer(checked.graph), disabled_links(checked.graph))


def _said(checked: Checked) -> tuple[Diagnostic, ...]:
    return checked.diagnostics


def _differences(forgetful: Sequence[object], kept: Sequence[object]) -> Iterator[Find]:
    if tuple(forgetful) != tuple(kept):
        here = [one for one in kept if one not in forgetful]
        there = [one for one in forgetful if one not in kept]
        yield Find("wrong answer", f"from memory {here}, and without {there}")


def _messages(found: Sequence[Diagnostic]) -> Iterator[Find]:
    for finding in found:
        if not finding.message.strip():
            yield Find("message", f"{finding.code} says nothing")
        if finding.severity is Severity.ERROR and (
            not finding.span.file or finding.span.line < 1 or finding.span.column < 1
        ):
            yield Find("message", f"{finding.code}: no place: {finding.span}")


def _rendered(checked: Checked) -> Iterator[Find]:
    """Show the findings in every format, as the one door prints them."""
    findings = checked.findings
    printed = as_text(render_text(findings.diagnostics, findings.texts), color=False)
    printed += as_text(render_github(findings.diagnostics, Path.cwd()), color=False)
    render_json(findings.diagnostics).encode()
    render_sarif(findings.diagnostics, Path.cwd()).encode()
    if (found := HIDDEN.search(printed)) is not None:
        yield Find("message", f"prints {found[0]!a}")


@contextmanager
def _few_samples() -> Iterator[None]:
    """Draw as many configurations as for the largest cells, a twentieth of those for a small one."""
    before = compute.SAMPLES
    vars(compute)["SAMPLES"] = compute.LEAST_SAMPLES
    try:
        yield
    finally:
        vars(compute)["SAMPLES"] = before


@contextmanager
def _inside(folder: Path) -> Iterator[None]:
    before = os.getcwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


@contextmanager
def _keeping_nothing() -> Iterator[None]:
    before = os.environ.get(OFF)
    os.environ[OFF] = "1"
    try:
        yield
    finally:
        os.environ.pop(OFF) if before is None else os.environ.update({OFF: before})
