"""What the command line asks of the mock, which options contradict each other, and files that a run writes."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from cellc.contract.extras import CLUSTER, EVIDENCE, LIVE, Extra, require
from cellc.contract.printing import refuse, remark
from cellc.contract.store.regular_file import open_regular
from cellc.contract.store.swap import open_stream, replace_whole
from cellc.mock.errors import MockError
from cellc.mock.result import AttemptRecord, to_json_lines

if TYPE_CHECKING:
    from cellc.contract.compute.work import ExecutorFactory

_LONGEST_RECORD = 1 << 20


@dataclass(frozen=True, slots=True)
class MockOptions:
    """What the command line asks for, the same for `cellc mock` and `python -m cellc.mock`.

    Attributes:
        program: how the command was called, for the commands that replay a run.
        rehearsals: to run; all of the folder without one.
        campaign: run every fault at every step.
        list_only: print the runs of a campaign, and run none.
        replay: runs of a campaign to run alone.
        gates: judge the gates by rehearsals and campaign.
        pairs: number of runs with two faults.
        sweep: most runs of a sweep.
        journal: file that the runs of a sweep are kept in, and taken from.
        jobs: processes; None for as many as there are cores.
        cluster: address of a scheduler of Dask whose workers do it instead.
        records: file that attempt records are written to, as JSON lines.
        evidence: folder that bags, records, figures and a report are written to.
        seed: of everything that is drawn.
        edited: run a folder that differs from its manifest too.
        live: show rehearsals in Foxglove.
        listen: host and port of that; None for this machine alone.
        speed: how much faster than real time it is shown; None for not at all.
        many: several folders are meant, of which ``folder`` is the first.
    """

    folder: str
    program: str = "cellc mock"
    rehearsals: tuple[str, ...] = ()
    campaign: bool = False
    list_only: bool = False
    replay: tuple[str, ...] = ()
    gates: bool = False
    pairs: int = 0
    sweep: int = 0
    journal: str | None = None
    jobs: int | None = None
    cluster: str | None = None
    as_json: bool = False
    records: str | None = None
    evidence: str | None = None
    seed: int = 0
    edited: bool = False
    live: bool = False
    listen: str | None = None
    speed: float | None = None
    many: bool = False

    def modes(self) -> list[str]:
        """Return the options that ask for something else than rehearsals."""
        given = {
            "--campaign": self.campaign,
            "--list": self.list_only,
            "--replay": bool(self.replay),
            "--gates": self.gates,
            "--sweep": bool(self.sweep),
        }
        return [option for option, asked in given.items() if asked]

    def contradiction(self) -> str:
        """Say which options do not go together; empty where all do."""
        modes = self.modes()
        both = ("--campaign", "--sweep") if self.gates else ("--campaign",)  # gates are judged by sweeps too
        alone = [option for option in modes if option not in both]
        if self.rehearsals and modes and (self.gates or not self.swept):
            return "--rehearsal does not go with the options of the campaign"
        if len(alone) > 1:
            return f"{alone[0]} does not go with {alone[1]}"
        if self.sweep and not self.gates and (self.campaign or self.pairs or self.records is not None):
            return "--sweep does not go with --campaign, --pairs or --records"
        if self.journal is not None and not self.swept:
            return "--journal needs --sweep, or --replay sweep:NUMBER"
        fanned = {"--pairs": self.pairs or None, "--jobs": self.jobs, "--cluster": self.cluster}
        given = [option for option, value in fanned.items() if value is not None]
        if given and not modes and (not self.many or self.pairs):
            return f"{given[0]} needs --campaign"
        if self.jobs is not None and self.cluster is not None:
            return "--jobs does not go with --cluster, whose workers are all taken"
        paths = {"--evidence": self.evidence, "--records": self.records}
        written = [option for option, path in paths.items() if path is not None]
        other = self._beyond_many(modes) or self._live_contradiction(modes)
        if other:
            return other
        if "--list" in alone and written:
            return f"{written[0]} does not go with --list, which runs nothing"
        empty = [option for option in written if paths[option] == ""]
        return f"{empty[0]} cannot be written: its path is empty" if empty else ""

    def _beyond_many(self, modes: Sequence[str]) -> str:
        """Say what is about one folder, where several are meant."""
        given = {
            "--rehearsal": bool(self.rehearsals),
            "--journal": self.journal is not None,
            "--evidence": self.evidence is not None,
            "--records": self.records is not None,
            "--live": self.live,
            **{mode: mode != "--sweep" for mode in modes},
        }
        return next((f"{option} is about one folder" for option, asked in given.items() if asked and self.many), "")

    def extras(self) -> Iterator[Extra]:
        """Yield what it needs beyond what cellc is installed with."""
        asked = {EVIDENCE: self.evidence is not None, LIVE: self.live, CLUSTER: self.cluster is not None}
        return (extra for extra, needed in asked.items() if needed)

    @property
    def swept(self) -> bool:
        """Whether it is about the runs of a sweep."""
        return bool(self.sweep) or any(run.startswith("sweep:") for run in self.replay)

    def _live_contradiction(self, modes: Sequence[str]) -> str:
        shown = {"--listen": self.listen, "--speed": self.speed}
        needless = [option for option, value in shown.items() if value is not None]
        if needless and not self.live:
            return f"{needless[0]} needs --live"
        if self.live and (modes or self.evidence is not None):
            return f"--live does not go with {modes[0] if modes else '--evidence'}"
        if self.speed is not None and not self.speed > 0.0:
            return f"--speed must be greater than 0, got {self.speed}"
        return ""

    def executor(self) -> tuple[ExecutorFactory | None, str]:
        """Return who executes runs, None for this process alone, and how many they are in words."""
        # A factory takes longer to load than a rehearsal to be read.
        from cellc.contract.compute.processes import processes, usable_cores

        if self.cluster is not None:
            from cellc.contract.compute.cluster import cluster

            return cluster(self.cluster, remark), f"workers of {self.cluster}"
        jobs = usable_cores() if self.jobs is None else self.jobs
        return (processes(jobs) if jobs > 1 else None), f"{jobs} processes"


def run_mock(options: MockOptions) -> int:
    """Do what the options ask for; they do not contradict each other.

    Returns:
        0 where all is as it must be, 1 where something is not, 2 where the folder or an option is unusable.
    """
    require(*options.extras())  # before the minutes that a run may take
    try:
        return _run(options)
    except MemoryError:
        refuse("the folder asks for more memory than there is; docs/limits.md has what bounds it")
        return 2


def _run(options: MockOptions) -> int:
    # Imported here: planning libraries load for as long as a rehearsal runs, and Ctrl-C meanwhile ends in one line.
    if not options.modes():
        from cellc.mock.command.rehearsals import run_rehearsals

        return run_rehearsals(options)
    if options.gates:
        from cellc.mock.command.gates import run_gates

        return run_gates(options)
    if options.swept:
        from cellc.mock.command.sweep import replay_swept, run_sweep

        return run_sweep(options) if options.sweep else replay_swept(options)
    from cellc.mock.command.campaign import list_runs, replay_runs, run_campaign

    if options.list_only:
        return list_runs(options)
    return replay_runs(options) if options.replay else run_campaign(options)


def write_records(path: Path, records: Iterable[AttemptRecord]) -> None:
    """Write a file of records whole or not at all; a pipe or a device such as ``/dev/stdout`` is written to.

    Raises:
        MockError: the file cannot be written, or what is there is a link or no file of records.
    """
    refuse_foreign(path)
    content = to_json_lines(records).encode()
    try:
        if _is_stream(path) or (path.exists() and not path.is_file()):
            with _opened(path) as stream:
                stream.write(content)
        else:
            replace_whole(path, content)
    except OSError as error:
        raise MockError(path.as_posix(), f"cannot be written: {(error.strerror or 'unknown reason').lower()}") from None


def refuse_foreign(path: Path) -> None:
    """Raise MockError where a link is at the path of the records, or a file that holds something else."""
    if _is_stream(path):
        return
    if path.is_symlink():
        raise MockError(path.as_posix(), "is a symbolic link; name the file itself")
    if path.is_file() and not _holds_records(path):
        raise MockError(path.as_posix(), "is no file of records; move it away, or name another file")


def _opened(path: Path) -> BinaryIO:
    """Open a stream by its path; one that is open already goes on where it is, though it be a file."""
    name = {"stdout": "1", "stderr": "2"}.get(path.name, path.name)
    return open_stream(int(name) if _is_stream(path) and name.isdigit() else path)


def _is_stream(path: Path) -> bool:
    """Whether the path is one that the system gives to an open stream, as a link in most cases."""
    return Path(os.path.abspath(path)).parent.as_posix() in ("/dev", "/dev/fd", "/proc/self/fd")


def _holds_records(path: Path) -> bool:
    """Whether the file is empty, or begins with an attempt."""
    try:
        with open_regular(path) as stream:
            line = stream.readline(_LONGEST_RECORD)
        return not line or (line.endswith(b"\n") and "attempt_id" in json.loads(line))
    except (OSError, ValueError, TypeError, RecursionError):
        return False
