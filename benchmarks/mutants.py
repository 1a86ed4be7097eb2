"""Mutation test of cellc: one small change at a time, and how many the tests of the same folder notice.

``python benchmarks/mutants.py [--count 200] [--seed 1] [--stage NAME] [--folder DIR]``. Mutants are drawn evenly by
lines of code over the stages. ``tests/nearest.py`` names the nearest tests of a stage. They run once with probes,
which record the statements that each test executes. Each mutant then runs only the tests that reach it, near and quick
ones first, up to the first failure. A statement that no test executes by itself is run against all near tests.
Everything happens in a copy of the checkout in ``--folder``: a second call resumes there, and probes only test files
that have changed.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate
from pathlib import Path

import pytest
from mutation.apart import ENDLESS, apart
from mutation.mutations import Mutant, mutants_of
from mutation.probe import Recorder, plant, record, statements
from mutation.swap import swap

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tests.nearest import nearest, stage_of  # noqa: E402  the checkout comes before what is installed

for _name in ("tests", "tests.nearest"):  # each copy has tests of its own
    del sys.modules[_name]

_LOADED = "numpy pydantic networkx yaml jsonschema click hypothesis xdist pinocchio ruckig xacro yourdfpy lxml.etree"
_QUIET = ("-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-o", "addopts=")
_LONGEST_S = 60.0
"""So long a file of tests may take with probes; what it tests beyond that is not asked."""
_FEW = 25
_NOTICED = ("killed", "endless")
_MOMENT = [1_000_000_000]
_ENDLESS = 5
"""So many times as long as its tests take a mutant may take before it is taken for one that never ends."""


@dataclass(frozen=True)
class Reached:
    """What the tests of a checkout execute, and how long each takes."""

    took: dict[str, float]
    executed: dict[tuple[str, int], set[str]]
    """The tests that execute a statement, by its file and line."""
    called: dict[str, set[str]]
    """The tests that execute anything in a file."""
    anywhere: bool = False
    """Whether tests of other folders than the nearest are asked, too."""
    seconds: float = 40.0
    """So long the tests of one mutant may take, as they took without it; the slowest are left out."""


def main() -> None:
    """Print the share of mutants that are noticed, by stage, and those that are not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--stage", action="append", help="only this one")
    parser.add_argument("--folder", type=Path, default=Path(tempfile.gettempdir(), "cellc_mutants"))
    parser.add_argument("--probe", action="store_true", help="only ask which test executes what")
    parser.add_argument("--known", action="store_true", help="ask of no further test what it executes")
    parser.add_argument("--share", default="1/1", help="judge the first third of them with 1/3; all are shown")
    parser.add_argument("--seconds", type=float, default=40.0, help="so long the tests of a mutant may take")
    parser.add_argument("--anywhere", action="store_true", help="by the tests of all folders, not the nearest alone")
    parser.add_argument("--again", action="store_true", help="judge again what survived a former call")
    options = parser.parse_args()
    options.folder.mkdir(exist_ok=True, parents=True)
    for name in _LOADED.split():
        importlib.import_module(name)
    wanted = options.stage or stages()
    reached = reach(options, list(dict.fromkeys(near for file in sources(wanted) for near in nearest(file))))
    if options.probe:
        return
    chosen, tree = draw(options.count, options.seed, wanted), copied(options.folder / "tree")
    record = options.folder / f"seed_{options.seed}.jsonl"
    record.touch()
    known = {name for name, end in _recorded(record).items() if not options.again or end["end"] in _NOTICED}
    part, parts = map(int, options.share.split("/"))
    rest = [mutant for mutant in chosen[part - 1 :: parts] if mutant.name not in known]
    reached = replace(reached, seconds=options.seconds, anywhere=options.anywhere)
    apart(tree, options.folder / "progress.txt", partial(_judge_each, rest, tree, reached, record), 1e6)
    ends = {mutant.name: {"end": "not judged"} for mutant in chosen} | _recorded(record)
    summary(chosen, {mutant.name: ends[mutant.name]["end"] for mutant in chosen})


def _judge_each(chosen: list[Mutant], tree: Path, reached: Reached, record: Path) -> int:
    """Judge mutants from a process that has loaded what they change."""
    _load(file.relative_to(tree).as_posix() for file in sorted((tree / "cellc").rglob("*.py")))
    for mutant in chosen:
        begin = time.monotonic()
        end = {"name": mutant.name} | judged(mutant, tree, reached)
        with record.open("a", encoding="utf-8") as out:
            out.write(json.dumps(end) + "\n")
        print(f"{time.monotonic() - begin:.1f}", end["end"], mutant.name, end["by"], flush=True)
    return 0


def _recorded(record: Path) -> dict[str, dict[str, str]]:
    lines = record.read_text(encoding="utf-8").splitlines()
    return {end["name"]: end for end in map(json.loads, lines)}


def _load(sources: Iterable[str]) -> None:
    for source in sources:
        if not source.endswith("__main__.py"):
            with suppress(ImportError):  # an extra that is not there
                importlib.import_module(source.removesuffix(".py").removesuffix("/__init__").replace("/", "."))


def summary(chosen: list[Mutant], ends: dict[str, str]) -> None:
    """Print the figures by stage, then the survivors."""
    total = Counter(stage_of(mutant.file) for mutant in chosen)
    noticed = Counter(stage_of(mutant.file) for mutant in chosen if ends[mutant.name] in _NOTICED)
    for stage in sorted(total):
        print(f"{stage:16} {noticed[stage]:4} of {total[stage]}")
    for mutant in chosen:
        if ends[mutant.name] not in _NOTICED:
            print(ends[mutant.name], mutant.name)
    killed = sum(noticed.values())
    print(f"{killed} of {len(chosen)} mutants noticed, {killed / len(chosen):.1%}")


def stages() -> list[str]:
    """Return the parts of cellc that have sources."""
    return sorted({stage_of(file.relative_to(ROOT).as_posix()) for file in (ROOT / "cellc").rglob("*.py")})


def sources(wanted: list[str]) -> list[str]:
    """Return the sources of some parts of cellc."""
    files = sorted(file.relative_to(ROOT).as_posix() for file in (ROOT / "cellc").rglob("*.py"))
    return [file for file in files if stage_of(file) in wanted]


def draw(count: int, seed: int, wanted: list[str]) -> list[Mutant]:
    """Draw mutants, so many of each stage as it has a share in the lines of code, in an order that says nothing."""
    chance = random.Random(seed)
    found = list(_drawn(count, chance, wanted))
    chance.shuffle(found)
    return found


def _drawn(count: int, chance: random.Random, wanted: list[str]) -> Iterator[Mutant]:
    files = defaultdict(list)
    for file in sorted((ROOT / "cellc").rglob("*.py")):
        lines = sum(1 for line in file.read_text(encoding="utf-8").splitlines() if line.strip())
        files[stage_of(file.relative_to(ROOT).as_posix())].append((file, lines))
    sizes = {stage: sum(lines for _, lines in files[stage]) for stage in wanted}
    exact = {stage: count * size / sum(sizes.values()) for stage, size in sizes.items()}
    quota = {stage: int(share) for stage, share in exact.items()}
    for stage in sorted(exact, key=lambda one: quota[one] - exact[one])[: count - sum(quota.values())]:
        quota[stage] += 1
    for stage in wanted:
        drawn: set[tuple[str, int]] = set()
        while len(drawn) < quota[stage]:
            file = chance.choices([file for file, _ in files[stage]], [lines for _, lines in files[stage]])[0]
            found = mutants_of(file, ROOT)
            line = chance.choice(sorted({mutant.line for mutant in found} or {0}))
            if line and (str(file), line) not in drawn:
                drawn.add((str(file), line))
                yield chance.choice([mutant for mutant in found if mutant.line == line])


def copied(tree: Path) -> Path:
    """Bring a copy of what git knows or would add up to date; what was compiled there stays."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout.decode().split("\0")
    wanted = {name for name in listed if name and (ROOT / name).is_file()}
    for source in tree.rglob("*.py"):
        if source.relative_to(tree).as_posix() not in wanted:
            source.unlink()
    for name in sorted(wanted):
        if not (tree / name).is_file() or (tree / name).read_bytes() != (ROOT / name).read_bytes():
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, tree / name)
    return tree


def reach(options: argparse.Namespace, wanted: list[str]) -> Reached:
    """Run the tests with probes where that is not known yet, and return what they execute."""
    folder: Path = options.folder
    store = folder / "reached"
    store.mkdir(exist_ok=True)
    files = list(dict.fromkeys(file for name in wanted for file in _tests_of(ROOT / name)))
    kept = {file: store / f"{hashlib.sha256(file.read_bytes()).hexdigest()[:24]}.json" for file in files}
    missing = [file for file in files if not kept[file].exists()]
    if missing and not options.known:
        probed = copied(folder / "probed")
        places = plant(probed)
        if apart(probed, folder / "log.txt", partial(_probe_each, probed, missing, places, kept), 1e6):
            sys.exit(f"the tests could not be run with probes: {folder / 'log.txt'} says why")
    took: dict[str, float] = {}
    executed, called = defaultdict(set), defaultdict(set)
    for file in (file for file in files if kept[file].exists()):
        results = json.loads(kept[file].read_text(encoding="utf-8"))
        took |= results["took"]
        for test, numbers in results["executed"].items():
            for source, line in (results["places"][str(number)] for number in numbers):
                executed[source, line].add(test)
                called[source].add(test)
    return Reached(took, executed, called)


def _tests_of(near: Path) -> list[Path]:
    return [near] if near.name.startswith("test_") else sorted(near.rglob("test_*.py"))


def _probe_each(probed: Path, missing: list[Path], places: list[tuple[str, int]], kept: dict[Path, Path]) -> int:
    """Run files of tests, each in a process of its own: what is kept for a session is built for each."""
    _load(sorted({source for source, _ in places}))
    for file in (file for file in missing if not kept[file].exists()):
        begin = time.monotonic()
        code = apart(probed, probed / "log.txt", partial(_probe, probed, file, places, kept[file]), 4 * _LONGEST_S)
        if not kept[file].exists():
            record(Recorder(_LONGEST_S), probed / "hits.txt", places, kept[file])
        with (probed / "../probed.txt").open("a") as out:
            out.write(f"{file.relative_to(ROOT)} {code} {time.monotonic() - begin:.1f}\n")
    return 0


def _probe(probed: Path, file: Path, places: list[tuple[str, int]], kept: Path) -> int:
    hits, recorder = probed / "hits.txt", Recorder(_LONGEST_S)
    hits.write_text("", encoding="utf-8")
    os.environ["CELLC_MUTANTS_HITS"] = str(hits)
    code = int(pytest.main([*_QUIET, file.relative_to(ROOT).as_posix()], plugins=[recorder]))
    record(recorder, hits, places, kept)
    return code


@dataclass(frozen=True, eq=False)  # pytest keeps its plugins in a set
class Chosen:
    """A plugin of pytest that runs these tests alone, in this order."""

    order: dict[str, int]
    failed: Path

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        kept = [item for item in items if item.nodeid in self.order]
        items[:] = sorted(kept, key=lambda item: self.order[item.nodeid])

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed.write_text(report.nodeid, encoding="utf-8")


def judged(mutant: Mutant, tree: Path, reached: Reached) -> dict[str, str]:
    """Run the tests that may notice a mutant until one fails: a few that are near and quick, then the others."""
    tests = candidates(mutant, reached)
    if not tests:
        return {"end": "unreached", "by": ""}
    file = tree / mutant.file
    file.write_bytes(mutant.applied((ROOT / mutant.file).read_bytes()))
    _mark_as_new(file)
    try:
        at_import = _at_import(mutant, reached)
        # What a test calls may be called by an import, too, as what makes a function a rule: loaded again at the end.
        for some, reloaded in ((tests[:_FEW], at_import), (tests[_FEW:], at_import), (tests[:_FEW], not at_import)):
            if some and (reloaded or not at_import):
                end, by = _run(some, mutant, tree, reached, reloaded=reloaded)
                if end != "survived":
                    return {"end": end, "by": by}
        return {"end": "survived", "by": f"{len(tests)} tests"}
    finally:
        shutil.copy2(ROOT / mutant.file, file)


def _run(tests: list[str], mutant: Mutant, tree: Path, reached: Reached, *, reloaded: bool) -> tuple[str, str]:
    """Run tests in this order up to the first that fails; return how that ended, and which noticed it.

    Args:
        reloaded: load all of cellc again with the mutant, instead of changing one function of what is loaded.
    """
    failed = tree.parent / "failed.txt"
    failed.write_text("", encoding="utf-8")
    files = sorted({test.partition("::")[0] for test in tests})
    plugin = Chosen({test: at for at, test in enumerate(tests)}, failed)

    def work() -> int:
        if not reloaded:
            source = (ROOT / mutant.file).read_bytes()
            swap(tree / mutant.file, source, mutant.applied(source))
        else:
            for name in [name for name in sys.modules if name.partition(".")[0] == "cellc"]:
                del sys.modules[name]
        return int(pytest.main([*_QUIET, "-x", *files], plugins=[plugin]))

    seconds = _ENDLESS * sum(reached.took[test] for test in tests) + 30
    code = apart(tree, tree.parent / "log.txt", work, seconds)
    if code in (0, 5):
        return "survived", ""
    if code == pytest.ExitCode.INTERNAL_ERROR:
        return "not judged", f"{tree.parent / 'log.txt'} says why"
    return ("endless" if code == ENDLESS else "killed"), failed.read_text(encoding="utf-8") or f"exit code {code}"


def _at_import(mutant: Mutant, reached: Reached) -> bool:
    """Tell whether what a mutant changes is evaluated by an import alone, or only in a copy, as an emitted program."""
    return not mutant.statements or not _executing(mutant, reached)


def _executing(mutant: Mutant, reached: Reached) -> set[str]:
    """Return the tests that execute what a mutant changes in a function."""
    probed = {line for line, _ in statements((ROOT / mutant.file).read_bytes())}
    line = next((line for line in mutant.statements if line in probed), 0)
    return reached.executed.get((mutant.file, line), set())


def candidates(mutant: Mutant, reached: Reached) -> list[str]:
    """Return the tests that may notice a mutant: those that execute it, then the rest of their files.

    Of those that execute it, the ones that go where few go in its file come first: what a finding, an error or an end
    of a branch needs is seen there. Others of a file matter where the first of them builds what all look at. What a
    module evaluates as it is imported may be looked at by every test; those that call a function of it go first.
    """
    folders = [(f"{name}/", f"{name}::") for name in nearest(mutant.file)]
    near = {test for test in reached.took if reached.anywhere or any(test.startswith(folder) for folder in folders)}
    executing = _executing(mutant, reached) if mutant.statements else reached.called.get(mutant.file, set())
    direct = executing & near or executing  # where none of its own folder executes it, those that do are the nearest
    files = {test.partition("::")[0] for test in direct if not reached.anywhere}
    at_import = _at_import(mutant, reached)
    beside = {test for test in near - direct if at_import or test.partition("::")[0] in files}
    rare = _rarity(mutant.file, reached)
    own = Path(mutant.file).stem

    def nearness(test: str) -> tuple[bool, bool, float, float]:
        named = test.replace("-", "_")  # as codes are written in the names of cases
        return test in beside, own not in named and rare[test] < 0.5, -round(rare[test], 1), reached.took[test]

    return _within(sorted(direct | beside, key=nearness), reached)


def _rarity(file: str, reached: Reached) -> dict[str, float]:
    """Return how far each test goes in a source where few others go: each statement counts one, shared by its tests."""
    rare: dict[str, float] = defaultdict(float)
    for (source, _), tests in reached.executed.items():
        if source == file:
            for test in tests:
                rare[test] += 1 / len(tests)
    return rare


def _within(tests: list[str], reached: Reached) -> list[str]:
    """Return the first of some tests, as far as the time for one mutant goes."""
    short = [test for test in tests if reached.took[test] < reached.seconds]
    sums = accumulate(reached.took[test] for test in short)
    return [test for test, total in zip(short, sums, strict=True) if total < reached.seconds]


def _mark_as_new(file: Path) -> None:
    """Give a source a time of its own: bytecode is known by the second in which its source was written."""
    _MOMENT[0] += 10
    os.utime(file, (_MOMENT[0], _MOMENT[0]))


if __name__ == "__main__":
    main()
