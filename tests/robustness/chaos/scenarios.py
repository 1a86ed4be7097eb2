"""What is done to commands, and what is held against what they leave."""

from __future__ import annotations

import os
import random
import shutil
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tests.cli.run import run as cellc
from tests.robustness.chaos.damages import DAMAGES, NOBODY
from tests.robustness.chaos.processes import (
    NEW,
    OLD,
    Ended,
    Place,
    Tree,
    finish,
    is_writing,
    put,
    run,
    small_disk,
    start,
    tree,
)

_MINE = {"minimal/notes.txt": "mine\n", "minimal/.minimal.tmp-mine": "mine\n"}


@dataclass
class Table:
    """Counts by row and column, and what was not as it shall be."""

    counts: dict[str, Counter[str]] = field(default_factory=dict)
    broken: list[str] = field(default_factory=list)

    def count(self, row: str, column: str) -> None:
        """Count one."""
        self.counts.setdefault(row, Counter())[column] += 1

    def hold(self, row: str, held: bool, what: str) -> None:
        """Note what does not hold."""
        if not held:
            self.count(row, "BROKEN")
            self.broken.append(f"{row}: {what}")
            print(f"BROKEN {row}: {what}", flush=True)

    def show(self) -> str:
        """Return a line for each row."""
        return "\n".join(
            f"{row:34} " + ", ".join(f"{name} {number}" for name, number in sorted(counts.items()))
            for row, counts in self.counts.items()
        )


class Chaos:
    """Runs commands in places of their own and holds what they leave against what they shall."""

    def __init__(self, work: Path, seed: int) -> None:
        """Make what fresh runs make, once."""
        self.random = random.Random(seed)
        self.table = Table()
        self._work = work
        self._number = 0
        self.fresh: dict[str, Tree] = {}
        self._load()
        for version in (OLD, NEW):
            place = self.place()
            _expect(run(place, place.build(version)))
            self.fresh[version] = tree(place.output / "minimal")
        self._commands = self._timed(place)

    def place(self, root: Path | None = None, version: str | None = None) -> Place:
        """Return an empty place, or one where a version was built and a person left files."""
        if root is None:
            self._number += 1
            root = self._work / str(self._number)
            root.mkdir(mode=0o755)
        place = Place(root)
        if version is not None:
            put(place.output / "minimal", self.fresh[version])
            for name, text in _MINE.items():
                (place.output / name).write_text(text)
        return place

    def _load(self) -> None:
        """Run commands in this process, so that forked ones spend their time in the command, as any user."""
        place = self.place()
        os.environ["XDG_CACHE_HOME"] = str(place.root / "cache")
        generated = str(place.output / "minimal")
        evidence = ("mock", generated, "--evidence", str(place.root / "evidence"))
        for arguments in (("build", str(place.root / place.spec(OLD)), "-o", str(place.output)), evidence):
            ran = cellc(*arguments)
            _expect(Ended(ran.code, ran.out + ran.err))

    def _timed(self, place: Place) -> dict[str, tuple[Callable[[Place], tuple[str, ...]], float]]:
        """Return each command that is killed, and how long it takes."""
        mock = ("mock", "generated/minimal")
        commands: dict[str, Callable[[Place], tuple[str, ...]]] = {
            "build": lambda place: place.build(NEW),
            "check": lambda place: ("check", place.spec(NEW)),
            "mock --records": lambda _: (*mock, "--records", "records.jsonl"),
            "mock --evidence": lambda _: (*mock, "--evidence", "evidence"),
            "campaign": lambda _: ("campaign", "generated/minimal", "--records", "records.jsonl"),
        }
        timed: dict[str, tuple[Callable[[Place], tuple[str, ...]], float]] = {}
        for name, command in commands.items():
            begin = time.monotonic()
            _expect(run(place, command(place)))
            timed[name] = (command, time.monotonic() - begin)
        self.records = {name: (place.root / "records.jsonl").read_bytes() for name in ("campaign",)}
        return timed

    def kills(self, number: int) -> None:
        """Kill commands at moments of their run, then run them again."""
        names = list(self._commands)
        # A campaign takes as long as forty builds.
        turns = [*names[:-1] * 8, names[-1]]
        for turn in range(number):
            name = turns[turn % len(turns)]
            command, lasts = self._commands[name]
            place = self.place(version=OLD)
            before = tree(place.root)
            if turn % 16 < 8:
                killed = run(place, command(place), kill_after=self.random.uniform(0, lasts))
            else:  # the moments that matter most are few
                killed = run(place, command(place), kill_after=self.random.uniform(0, 0.04), once=is_writing)
            self.table.count(f"kill {name}", "killed" if killed.code < 0 else "ended before")
            left = tree(place.output / "minimal")
            now = "old" if left == (old := self._with_mine(OLD)) else "new" if left == self._with_mine(NEW) else "both"
            if name == "build":
                self.table.count(f"kill {name}", f"folder {now}")
                self._hold_files(f"kill {name}", left)
            else:
                self.table.hold(f"kill {name}", left == old, "the generated folder changed")
            self._hold_next(f"kill {name}", place, command(place), before)
            shutil.rmtree(place.root)

    def _with_mine(self, version: str) -> Tree:
        mine = {name.removeprefix("minimal/"): text.encode() for name, text in _MINE.items()}
        return {**self.fresh[version], **mine}

    def _hold_files(self, row: str, left: Tree) -> None:
        old, new = self._with_mine(OLD), self._with_mine(NEW)
        half = [name for name, content in left.items() if content not in (old.get(name), new.get(name))]
        self.table.hold(row, not half, f"half-written: {half}")

    def _hold_next(self, row: str, place: Place, command: tuple[str, ...], before: Tree) -> None:
        """Hold that the command ends well now, and leaves what it would in a place where nothing had happened."""
        again = run(place, command)
        self.table.hold(row, again.code == 0, f"the next run ended with {again.code}: {again.said[-300:]}")
        whole = self._with_mine(NEW if command[0] == "build" else OLD)
        self.table.hold(row, tree(place.output / "minimal") == whole, "the next run left another folder")
        left = sorted(
            name
            for name in tree(place.root)
            if name not in before and (".tmp-" in name or ".part" in name or ".new" in name)
        )
        self.table.hold(row, not left, f"left after the next run: {left[:3]}")
        records = place.root / "records.jsonl"
        if row == "kill campaign":
            same = records.read_bytes() == self.records["campaign"]
            self.table.hold(row, same, "the next campaign wrote other records")

    def full(self, number: int) -> None:
        """Give commands a disk that is too small."""
        for turn in range(number):
            name = ("build", "mock --records", "mock --evidence")[turn % 3]
            with small_disk(self._work, self.random.randrange(280, 1000, 4)) as root:
                if root is None:
                    self.table.count(f"full disk, {name}", "skipped: nothing can be mounted")
                    continue
                place = self.place(root)
                try:
                    place = self.place(root, OLD)
                    place.spec(NEW)
                except OSError:
                    self.table.count(f"full disk, {name}", "no room for the old folder")
                    continue
                before = tree(root)
                ended = run(place, self._commands[name][0](place), environment={"CELLC_NO_CACHE": str(turn % 2)})
                row = f"full disk, {name}"
                self.table.count(row, f"exit {ended.code}")
                self._hold_refused(row, ended, ("no space left on device",))
                after = {path: text for path, text in tree(root).items() if not path.startswith("cache/")}
                if ended.code == 0 and name == "build":
                    self.table.hold(row, tree(place.output / "minimal") == self._with_mine(NEW), "exit 0, not built")
                elif ended.code:
                    changed = sorted(
                        path for path in before.keys() | after.keys() if before.get(path) != after.get(path)
                    )
                    self.table.hold(row, not changed, f"changed although it failed: {changed[:4]}")

    def _hold_refused(self, row: str, ended: Ended, reasons: tuple[str, ...]) -> None:
        self.table.hold(row, "Traceback" not in ended.said, f"traceback: {ended.said[-600:]}")
        self.table.hold(row, ended.code in (0, 1, 2), f"exit code {ended.code}: {ended.said[-300:]}")
        if ended.code in (1, 2):
            named = any(reason in ended.said.lower() for reason in reasons)
            errors = [line for line in ended.said.splitlines() if line.startswith("error")]
            self.table.hold(row, named, f"the reason is not named: {errors or ended.said[-300:]}")

    def forbidden(self, number: int) -> None:
        """Run as another user who may not write one of the places."""
        places = ("generated", "generated/minimal", "generated/minimal/config", ".", "cache")
        for turn in range(number):
            name = ("build", "mock --records", "mock --evidence")[turn % 3]
            forbidden = places[turn // 3 % len(places)]
            place = self.place(version=OLD)
            (place.root / "cache").mkdir()
            place.spec(NEW)
            for path in (place.root, *place.root.rglob("*")):
                os.chown(path, NOBODY, NOBODY)
            mode = (0o555, 0o500)[turn % 2]
            (place.root / forbidden).chmod(mode)
            before = tree(place.root)
            ended = run(place, self._commands[name][0](place), user=NOBODY)
            row = f"read-only {forbidden}, {name}"
            self.table.count(row, f"exit {ended.code}")
            self._hold_refused(row, ended, ("permission denied",))
            if ended.code:
                after = {path: text for path, text in tree(place.root).items() if not path.startswith("cache/")}
                self.table.hold(row, after == before, "something changed although it failed")
            shutil.rmtree(place.root)

    def writers(self, rounds: int) -> None:
        """Let sixteen builds of two versions write one folder with one cache at once."""
        for turn in range(rounds):
            place = self.place(version=OLD) if turn % 2 else self.place()
            versions = [self.random.choice((OLD, NEW)) for _ in range(16)]
            commands = [place.build(version) for version in versions]
            children = [start(place, command, f"said.{index}") for index, command in enumerate(commands)]
            ended = [finish(place, child, f"said.{index}") for index, child in enumerate(children)]
            for one in ended:
                self.table.count("16 writers", f"exit {one.code}")
                self._hold_refused("16 writers", one, ("another build is writing",))
            left = {
                name: text for name, text in tree(place.output / "minimal").items() if f"minimal/{name}" not in _MINE
            }
            good = {version for version, one in zip(versions, ended, strict=True) if one.code == 0}
            self.table.count("16 writers", f"rounds where {sum(one.code == 0 for one in ended)} built")
            wholes = [self.fresh[version] for version in good] or [self.fresh[OLD], {}]
            self.table.hold("16 writers", left in wholes, "the folder is a mixture")
            _expect(run(place, place.build(NEW)))
            left = {
                name: text for name, text in tree(place.output / "minimal").items() if f"minimal/{name}" not in _MINE
            }
            self.table.hold("16 writers", left == self.fresh[NEW], "the next build is wrong")
            temporary = [name for name in tree(place.root) if ".tmp-" in name and "tmp-mine" not in name]
            self.table.hold("16 writers", not temporary, f"left: {temporary[:3]}")
            shutil.rmtree(place.root)

    def cache(self, number: int) -> None:
        """Damage what the cache keeps; every answer is the one of a run that keeps nothing."""
        place = self.place(version=OLD)
        arguments = ("check", place.spec(OLD), "--format", "json")
        expected = run(place, arguments, environment={"CELLC_NO_CACHE": "1"})
        damages = (*DAMAGES,)
        for turn in range(number):
            shutil.rmtree(place.root / "cache", ignore_errors=True)
            _expect(run(place, arguments))
            entries = sorted(path for path in (place.root / "cache").rglob("*.json"))
            if not entries:
                self.table.hold("damaged cache", False, "nothing was kept")
                return
            damage = damages[turn % len(damages)]
            DAMAGES[damage](self.random.choice(entries), self.random)
            ended = run(place, arguments)
            self.table.count("damaged cache", damage)
            self.table.hold("damaged cache", ended == expected, f"{damage}: another answer: {ended.said[-300:]}")
            again = run(place, arguments)
            self.table.hold("damaged cache", again == expected, f"{damage}: another answer the next time")


def _generated(place: Place) -> Tree:
    return {name: text for name, text in tree(place.output / "minimal").items() if f"minimal/{name}" not in _MINE}


def _expect(ended: Ended) -> None:
    if ended.code:
        raise RuntimeError(f"ended with {ended.code}: {ended.said}")
