"""Thousands of inputs in isolated processes: what was done is kept, so that an ended campaign goes on."""

from __future__ import annotations

import json
import os
import re
import select
import subprocess
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.robustness.fuzz.oracle import WRONGS

CHUNK = 250
SILENCE_S = 90.0
"""A process that is silent for so long hangs where no alarm reaches it."""


@dataclass
class _Figures:
    """What is counted for one kind."""

    inputs: int = 0
    seconds: float = 0.0
    slowest_s: float = 0.0
    peak_mb: float = 0.0
    wrongs: dict[str, int] = field(default_factory=lambda: dict.fromkeys(WRONGS, 0))


class Campaign:
    """Judges inputs ``first`` and on of each kind, ``count`` of all kinds together."""

    def __init__(self, kinds: tuple[str, ...], first: int, count: int, jobs: int, state: str | None) -> None:
        each = -(-count // len(kinds))
        self._chunks = [
            (kind, begin, min(begin + CHUNK, first + each))
            for begin in range(first, first + each, CHUNK)
            for kind in kinds
        ]
        self._jobs, self._count = jobs, each * len(kinds)
        self._state = None if state is None else Path(state)
        self._lock = threading.Lock()
        self._figures: dict[str, _Figures] = defaultdict(_Figures)
        self._finds: list[tuple[str, int, str, str]] = []
        self._started = time.perf_counter()

    def run(self) -> int:
        """Run to the end, print the table and return 1 where something was found."""
        self._resume()
        threads = [threading.Thread(target=self._work, daemon=True) for _ in range(self._jobs)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            time.sleep(5.0)
            self._progress()
        self._print_table()
        return 1 if self._finds else 0

    def _resume(self) -> None:
        if self._state is None:
            return
        self._state.mkdir(parents=True, exist_ok=True)
        for file in sorted(self._state.glob("*.jsonl")):
            kind, first, last = file.stem.split("-")
            chunk = (kind, int(first), int(last))
            if chunk in self._chunks:
                self._chunks.remove(chunk)
                for line in file.read_text().splitlines():
                    self._count_one(json.loads(line))

    def _work(self) -> None:
        worker = _Worker()
        while True:
            with self._lock:
                if not self._chunks:
                    break
                chunk = self._chunks.pop(0)
            kind, first, last = chunk
            lines = []
            while first < last:
                for answer in worker.judge(kind, first, last):
                    lines.append(answer)
                    first = answer["end"][1] + 1
                    with self._lock:
                        self._count_one(answer)
                if first < last:
                    worker = _Worker()  # the last one died or was ended
            self._keep(chunk, lines)
        worker.end()

    def _keep(self, chunk: tuple[str, int, int], lines: list[dict[str, Any]]) -> None:
        if self._state is not None:
            file = self._state / f"{chunk[0]}-{chunk[1]}-{chunk[2]}.jsonl"
            part = file.with_suffix(".part")
            part.write_text("".join(json.dumps(line) + "\n" for line in lines))
            part.replace(file)

    def _count_one(self, answer: dict[str, Any]) -> None:
        kind, number = answer["end"]
        figures = self._figures[kind]
        figures.inputs += 1
        figures.seconds += answer["s"]
        figures.slowest_s = max(figures.slowest_s, answer["s"])
        figures.peak_mb = max(figures.peak_mb, answer["mb"])
        for wrong, text in answer["found"]:
            figures.wrongs[wrong] += 1
            self._finds.append((kind, number, wrong, text))

    def _progress(self) -> None:
        with self._lock:
            done = sum(figures.inputs for figures in self._figures.values())
            found = len(self._finds)
        print(
            f"{done} of {self._count}, {found} finds, {time.perf_counter() - self._started:.0f} s",
            file=sys.stderr,
            flush=True,
        )

    def _print_table(self) -> None:
        groups: dict[tuple[str, str], list[tuple[str, int, str]]] = defaultdict(list)
        for kind, number, wrong, text in self._finds:
            groups[wrong, _signature(text)].append((kind, number, text))
        for (wrong, signature), found in sorted(groups.items(), key=lambda group: -len(group[1])):
            named = ", ".join(f"{kind} {number}" for kind, number, _ in found[:6])
            print(f"{len(found)} x {wrong}: {signature}\n    {named}")
        print("\n| kind | inputs | finds |", " | ".join(WRONGS), "| slowest s | peak MB | inputs/s |")
        print("|---" * (6 + len(WRONGS)) + "|")
        for kind, figures in self._figures.items():
            wrongs = [figures.wrongs[wrong] for wrong in WRONGS]
            speed = figures.inputs / figures.seconds if figures.seconds else 0.0
            row = (
                kind,
                figures.inputs,
                sum(wrongs),
                *wrongs,
                f"{figures.slowest_s:.1f}",
                f"{figures.peak_mb:.0f}",
                f"{speed:.0f}",
            )
            print(f"| {' | '.join(map(str, row))} |")


def _signature(text: str) -> str:
    """Return what finds of one cause have in common."""
    frames = re.findall(r'File "[^"]*?((?:cellc|tests)/[^"]+)", line (\d+)', text)
    last = text.strip().splitlines()[-1] if text.strip() else ""
    place = f"{frames[-1][0]}:{frames[-1][1]} " if frames else ""
    return place + re.sub(r"[`'\"].*?[`'\"]|\d+", "…", last)[:160]


class _Worker:
    """One process that judges."""

    def __init__(self) -> None:
        command = [sys.executable, "-m", "tests.robustness.fuzz.worker"]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )

    def judge(self, kind: str, first: int, last: int) -> Iterator[dict[str, Any]]:
        """Yield the answers up to the end, or up to the input that ended the process."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{json.dumps([kind, first, last])}\n".encode())
        self._process.stdin.flush()
        begun = first
        while (line := self._line()) is not None:
            answer = json.loads(line)
            if "done" in answer:
                return
            if "begin" in answer:
                begun = answer["begin"][1]
            else:
                yield answer
        code = self.end()
        reason = f"silent for {SILENCE_S:g} s" if code is None else f"the process ended with {code}"
        found = [["hang" if code is None else "died", reason]]
        yield {"end": [kind, begun], "found": found, "s": SILENCE_S if code is None else 0.0, "mb": 0.0}

    def _line(self) -> bytes | None:
        """Return the next answer, None where the process ended or is silent."""
        stream = self._process.stdout
        assert stream is not None
        while b"\n" not in self._buffer:
            ready, _, _ = select.select([stream], [], [], SILENCE_S)
            piece = os.read(stream.fileno(), 65536) if ready else b""
            if not piece:
                return None
            self._buffer += piece
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line

    _buffer = b""

    def end(self) -> int | None:
        """End the process and return its code, None where it had to be killed."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.close()
            return self._process.wait(timeout=1.0)
        except (subprocess.TimeoutExpired, BrokenPipeError):
            self._process.kill()
            self._process.wait()
            return None
