"""What each command of the mock is asked for."""

from __future__ import annotations

import shlex
from collections.abc import Iterator

from cellc.contract.compute.fan import USUAL, Fan
from cellc.contract.extras import CLUSTER, EVIDENCE, FILM, LIVE, PHYSICS, Extra
from cellc.contract.frozen import dataclass
from cellc.mock.ros.asked import AmongNodes


@dataclass(frozen=True, slots=True)
class FolderOptions:
    """What every command is asked for.

    Attributes:
        folder: that is executed.
        seed: of everything that is drawn.
        edited: run a folder that differs from its manifest too.
        as_json: write the results for programs.
        evidence: folder that bags, records, figures and a report are written to.
        fan: who executes runs.
        stage: of commissioning that motion is planned in, in percent; the last where it is empty.
        physics: give joints and parts their masses.
    """

    folder: str
    seed: int = 0
    edited: bool = False
    as_json: bool = False
    evidence: str | None = None
    fan: Fan = USUAL
    stage: str = ""
    physics: bool = False

    def extras(self) -> Iterator[Extra]:
        """Yield what it needs beyond what cellc is installed with."""
        if self.evidence is not None:
            yield EVIDENCE
        if self.fan.cluster is not None:
            yield CLUSTER
        if self.physics:
            yield PHYSICS

    def replayed_by(self, run: str, rehearsal: str | None = None) -> str:
        """Return the command that makes one run again.

        Args:
            rehearsal: that the run of a sweep is of.
        """
        words = ["cellc", "replay", self.folder, run]
        words += [] if rehearsal is None else ["--rehearsal", rehearsal]
        words += ["--seed", str(self.seed)] if self.seed else []
        words += [option for option, given in (("--edited", self.edited), ("--physics", self.physics)) if given]
        return shlex.join([*words, *self.others()])

    def others(self) -> tuple[str, ...]:
        """Return the options that a run must have to be made again, beside those that every command has."""
        return ()


@dataclass(frozen=True, slots=True)
class Live:
    """How rehearsals are shown in Foxglove.

    Attributes:
        address: host and port where it connects.
        speed: how much faster than real time.
    """

    address: str
    speed: float


@dataclass(frozen=True, slots=True)
class RehearsalOptions(FolderOptions):
    """What `cellc mock` is asked for.

    Attributes:
        rehearsals: to run; all of the folder without one.
        records: file that attempt records are written to, as JSON lines.
        live: how they are shown; None for not at all.
        images: draw what cameras see into the bags.
        among: nodes on a ROS graph that are run for real; None where all are played.
        against: run each rehearsal without masses too, and say where the two part.
        film: file that a film of the one rehearsal is written to.
    """

    rehearsals: tuple[str, ...] = ()
    records: str | None = None
    live: Live | None = None
    images: bool = False
    among: AmongNodes | None = None
    against: bool = False
    film: str | None = None

    def extras(self) -> Iterator[Extra]:
        """Yield what it needs beyond what cellc is installed with."""
        yield from FolderOptions.extras(self)
        if self.live is not None:
            yield LIVE
        if self.film is not None:
            yield FILM


@dataclass(frozen=True, slots=True)
class CampaignOptions(FolderOptions):
    """What `cellc campaign` is asked for.

    Attributes:
        pairs: number of runs with two faults.
        records: file that attempt records are written to, as JSON lines.
        among: nodes on a ROS graph that are run for real; only faults that they can see are injected.
    """

    pairs: int = 0
    records: str | None = None
    among: AmongNodes | None = None

    def others(self) -> tuple[str, ...]:
        """Return the options that a run must have to be made again."""
        return () if self.among is None else self.among.words()


@dataclass(frozen=True, slots=True)
class SweepOptions(FolderOptions):
    """What `cellc sweep` is asked for.

    Attributes:
        runs: most of them for each rehearsal.
        rehearsals: to sweep; without one those of which a rate is expected, or the first.
        journal: file that the runs are kept in, and taken from.
    """

    runs: int = 1000
    rehearsals: tuple[str, ...] = ()
    journal: str | None = None


@dataclass(frozen=True, slots=True)
class GatesOptions(CampaignOptions):
    """What `cellc gates` is asked for.

    Attributes:
        runs: of each sweep, at most; None for no sweep.
        journal: as for a sweep.
    """

    runs: int | None = None
    journal: str | None = None

    @property
    def sweep(self) -> SweepOptions | None:
        """The sweeps that rates of success are judged by."""
        if self.runs is None:
            return None
        return SweepOptions(self.folder, self.seed, self.edited, fan=self.fan, runs=self.runs, journal=self.journal)


@dataclass(frozen=True, slots=True)
class ReplayOptions(FolderOptions):
    """What `cellc replay` is asked for.

    Attributes:
        runs: names of runs of the campaign, or of a sweep.
        rehearsal: that the runs of a sweep are of; None for the one that `cellc sweep` takes.
        journal: of the sweep, which must be the same one.
        records: file that attempt records are written to, as JSON lines.
        among: nodes on a ROS graph that are run for real.
    """

    runs: tuple[str, ...] = ()
    rehearsal: str | None = None
    journal: str | None = None
    records: str | None = None
    among: AmongNodes | None = None

    def others(self) -> tuple[str, ...]:
        """Return the options that a run must have to be made again."""
        return () if self.among is None else self.among.words()
