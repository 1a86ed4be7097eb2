"""``python -m tests.emit.taint``: every place of every folder with every payload; ``--all`` for all of it."""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

from tests.emit.taint.cells import variants
from tests.emit.taint.payloads import PAYLOADS
from tests.emit.taint.places import Place
from tests.emit.taint.rounds import KINDS, behind_the_readers, run


def main() -> int:
    """Run the rounds, print what each found, and return 1 where a text was more than text."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--all", action="store_true", help="every payload in every place, not one of each")
    arguments.add_argument("--only", default="", help="folders whose name holds this")
    arguments.add_argument("--turns", default="", help="FIRST:LAST, in place of all")
    arguments.add_argument("--alone", action="store_true", help="each place alone, and through the readers")
    given = arguments.parse_args()
    first, _, last = given.turns.partition(":")
    turns = range(int(first), int(last)) if last else range(len(PAYLOADS) if given.all else 1)
    begin = time.perf_counter()
    count: Counter[str] = Counter()
    for name, files in variants().items():
        if given.only in name:
            suspects: dict[Place, str] = {}
            for turn in turns:
                for kind in KINDS[:1] if given.alone else KINDS:
                    count += _round(name, files, kind, turn, suspects)
                if given.alone:
                    continue
                with behind_the_readers():
                    # Names of a description are read back as they stand, so that no escape of one passes verify.
                    count += _round(f"{name} behind the readers", files, KINDS[0], turn, suspects, (".yaml",))
    print(f"{dict(count)} in {time.perf_counter() - begin:.0f} s")
    return 1 if count["faults"] else 0


def _round(
    name: str,
    files: Mapping[str, str],
    kind: str,
    turn: int,
    suspects: dict[Place, str],
    endings: tuple[str, ...] = (".yaml", ".urdf"),
) -> Counter[str]:
    """Run one round, print what it found, and add the culprits of errors on another line to the suspects."""
    with tempfile.TemporaryDirectory() as folder:
        done = run(Path(folder), files, kind, turn, endings, suspects)
    trial = done.trial
    suspects |= {place: error.code for place, error in trial.elsewhere.items()}
    for place, error in trial.elsewhere.items():
        at = f"{error.span.file.removeprefix(folder)}:{error.span.line}"
        print(f"{name} {turn}: {place} is refused at {at} {error.code}")
    for fault in done.faults:
        print(f"{name} {turn} {kind}: {fault}")
    sizes = {"taken": len(trial.taken), "refused": len(trial.refused), "elsewhere": len(trial.elsewhere)}
    return Counter({"rounds": 1, **sizes, "faults": len(done.faults)})


if __name__ == "__main__":
    raise SystemExit(main())
