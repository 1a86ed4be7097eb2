"""What holds for every test: no folder of the user is touched, and modules are compiled once."""

from __future__ import annotations

import gc
import os
import signal
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.installed.install import Install


@pytest.fixture(scope="session", autouse=True)
def _cache_of_the_session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", _shared(tmp_path_factory, "cache"))
        patch.setenv("XDG_STATE_HOME", _shared(tmp_path_factory, "state"))
        patch.delenv("CELLC_NO_CACHE", raising=False)
        yield


@pytest.fixture(scope="session", autouse=True)
def _bytecode_of_the_session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Let the processes that tests start share their bytecode even where the checkout is to be kept free of it."""
    with pytest.MonkeyPatch.context() as patch:
        if os.environ.get("PYTHONDONTWRITEBYTECODE"):
            patch.delenv("PYTHONDONTWRITEBYTECODE")
            patch.setenv("PYTHONPYCACHEPREFIX", _shared(tmp_path_factory, "bytecode"))
        yield


@pytest.fixture(scope="session", autouse=True)
def _disk_of_the_session() -> Iterator[None]:
    """Wait for no disk: a process that is killed leaves what it wrote, and no test cuts the power."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: None)
        yield


@pytest.fixture(scope="session", autouse=True)
def _signals_of_a_terminal() -> None:
    """Let signals reach the processes that tests start even where the session was begun in the background."""
    for number, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, handler)


@pytest.fixture(scope="session")
def readme_install(tmp_path_factory: pytest.TempPathFactory) -> Install:
    """Give what README's first command makes; it takes a minute, so that the workers of one session share it."""
    from tests.installed.install import installed

    return installed(Path(_shared(tmp_path_factory, "installed")))


_ALWAYS = 4
"""Cases of a test that a session runs whatever its share is."""
_LEFT_OUT = pytest.StashKey[frozenset[Path]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addini("long_tests", "files and folders that `pytest` leaves to `pytest --long`", type="args", default=[])
    parser.addoption("--long", action="store_true", help="run the long tests alone")
    parser.addoption("--all", action="store_true", help="run the long tests too, in one session")
    parser.addoption("--share", type=int, default=1, metavar="N", help="of tests with many cases, run one case in N")


def pytest_configure(config: pytest.Config) -> None:
    """Decide what a call without a path runs; the workers of a session get its arguments, and decide the same."""
    long = [config.rootpath / path for path in config.getini("long_tests")]
    config.stash[_LEFT_OUT] = frozenset()
    if config.option.long and config.args_source is pytest.Config.ArgsSource.ARGS:
        raise pytest.UsageError("--long takes no path: a named path runs all that is in it")
    if config.option.long:
        config.args = list(map(str, long))
    elif config.args_source is pytest.Config.ArgsSource.TESTPATHS and not config.option.all:
        config.stash[_LEFT_OUT] = frozenset(long)


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    return True if collection_path in config.stash[_LEFT_OUT] else None


def pytest_collection(session: pytest.Session) -> None:
    """Let every second process of a session import its files from the last to the first.

    Rewriting assertions is half of the collection. What one process has rewritten, the other reads from the bytecode
    where they meet, instead of both rewriting the same file at the same time.
    """
    if os.environ.get("PYTEST_XDIST_WORKER", "")[-1:] not in tuple("13579"):
        return
    assertion = session.config.pluginmanager.get_plugin("assertion")
    assert assertion is not None
    assertion.pytest_collection(session)  # its hook must know what the session holds before the first import
    folders = [Path(argument.partition("::")[0]) for argument in session.config.args]
    files = {file for folder in folders for file in (folder.rglob("test_*.py") if folder.is_dir() else (folder,))}
    left_out = session.config.stash[_LEFT_OUT]
    for file in sorted(files, reverse=True):
        place = file.absolute().relative_to(session.config.rootpath).with_suffix("")
        if not any(path in left_out for path in (file.absolute(), *file.absolute().parents)):
            with suppress(Exception, pytest.skip.Exception):  # the collection meets it again, and reports it
                import_module(".".join(place.parts))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Let the longest files begin, so that no process waits for another at the end: first the one that runs mypy.

    Of tests with many cases, ``--share`` leaves some out, the same ones in every session.
    """
    left_out = set(_beyond_the_share(items, config.option.share))
    if left_out:
        config.hook.pytest_deselected(items=[item for item in items if item in left_out])
        items[:] = [item for item in items if item not in left_out]
    tests = Counter(item.path for item in items)
    long = {config.rootpath / path: place for place, path in enumerate(config.getini("long_tests"))}
    rank = {file: _rank(file, long) for file in tests}
    items.sort(key=lambda item: (rank[item.path], -tests[item.path], str(item.path)))


def _beyond_the_share(items: Iterable[pytest.Item], share: int) -> Iterator[pytest.Item]:
    """Yield the cases that a session leaves out: of each test, all but one in ``share``, and at least some remain."""
    cases: dict[str, list[pytest.Item]] = {}
    for item in items:
        cases.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for many in cases.values():
        many.sort(key=lambda item: zlib.crc32(item.nodeid.encode()))
        yield from many[max(_ALWAYS, -(-len(many) // share)) :]


def _rank(file: Path, long: Mapping[Path, int]) -> int:
    if file.name == "test_quality.py":
        return -1
    return min((long[place] for place in (file, *file.parents) if place in long), default=len(long))


def pytest_collection_finish() -> None:
    """Let the garbage collector pass over what stays to the end: modules, and twelve thousand tests."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say in one line what was not tested, and why; ``-rs`` names each test."""
    skipped = terminalreporter.getreports("skipped")
    missing = Counter(
        (_reason(report), "/".join(report.nodeid.partition("::")[0].split("/")[:2])) for report in skipped
    )
    reasons: dict[str, dict[str, int]] = {reason: {} for reason, _ in missing}
    for (reason, folder), number in sorted(missing.items()):
        reasons[reason][folder] = number
    told = [
        f"{', '.join(f'{number} of {folder}' for folder, number in folders.items())} ({reason})"
        for reason, folders in sorted(reasons.items(), key=lambda one: -sum(one[1].values()))
    ]
    if told:
        terminalreporter.write_line(f"not tested: {missing.total()} tests, {'; '.join(told)}")


def _reason(report: pytest.TestReport | pytest.CollectReport) -> str:
    """Return why a test was skipped, in the words of its mark."""
    said = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
    return said.removeprefix("Skipped: ").removeprefix("could not import ")


def _shared(factory: pytest.TempPathFactory, name: str) -> str:
    """Return a folder that the workers of one session share: what one has computed is there for the other."""
    base = factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / f"shared_{name}"
    folder.mkdir(mode=0o700, exist_ok=True)
    return str(folder)
