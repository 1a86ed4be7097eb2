"""A loaded cell: rehearsals by name."""

from __future__ import annotations

from pathlib import Path

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.errors import MockError
from cellc.mock.folder import GeneratedFolder, read_folder
from cellc.mock.nodes.motion_model import build_motion_model
from cellc.mock.nodes.motion_planner import PlanMemory
from cellc.mock.rehearse import Watch, rehearse
from cellc.mock.result import RehearsalResult
from cellc.mock.world.links import read_links


class MockCell:
    """A generated folder ready to be executed; every run starts from a cell that is off."""

    def __init__(self, folder: GeneratedFolder, memory: PlanMemory) -> None:
        """Bind what ``load`` has read."""
        self._folder = folder
        self._memory = memory

    @property
    def folder(self) -> GeneratedFolder:
        """What was read of the generated folder."""
        return self._folder

    @property
    def contract(self) -> Contract:
        """The contract of the cell."""
        return self._folder.contract

    @property
    def rehearsals(self) -> tuple[str, ...]:
        """Names of the rehearsals in the order of the folder."""
        return tuple(entry.name for entry in self.entries)

    @property
    def entries(self) -> tuple[RehearsalEntry, ...]:
        """The rehearsals themselves."""
        return self._folder.rehearsals

    @property
    def notes(self) -> tuple[str, ...]:
        """What is odd about the folder but no reason to stop, such as files edited by hand."""
        return self._folder.notes

    def entry(self, rehearsal: str) -> RehearsalEntry:
        """Return a rehearsal of the folder.

        Raises:
            MockError: there is none of this name.
        """
        for entry in self.entries:
            if entry.name == rehearsal:
                return entry
        known = ", ".join(f"`{name}`" for name in self.rehearsals) or "none"
        raise MockError(self.contract.files.rehearsals, f"has no rehearsal `{rehearsal}`; it has {known}")

    def run(self, rehearsal: str, *, seed: int = 0) -> RehearsalResult:
        """Run one rehearsal; the same folder and seed give the same result to the last bit.

        Raises:
            MockError: there is no rehearsal of this name, or it names what the contract does not have.
        """
        return self.rehearse(self.entry(rehearsal), seed=seed)

    def rehearse(self, entry: RehearsalEntry, *, seed: int = 0, watch: Watch | None = None) -> RehearsalResult:
        """Run a rehearsal that need not stand in the folder; ``watch`` sees the plant before anything runs.

        Raises:
            MockError: it names what the contract does not have.
        """
        return rehearse(self._folder, self._memory, entry, seed, watch)


def load(folder: Path) -> MockCell:
    """Load a generated folder.

    Raises:
        MockError: the folder cannot be executed; names the file and the reason.
    """
    return cell_of(read_folder(folder))


def cell_of(folder: GeneratedFolder) -> MockCell:
    """Make a folder that was read ready to be executed.

    Raises:
        MockError: its parts do not fit together.
    """
    links = read_links(folder.urdf, folder.contract.files.urdf_mock)
    return MockCell(folder, PlanMemory(build_motion_model(folder.contract, folder.urdf, links)))


def run_all(cell: MockCell, *, seed: int = 0) -> tuple[RehearsalResult, ...]:
    """Run every rehearsal of a cell in the order of its folder."""
    return tuple(cell.run(name, seed=seed) for name in cell.rehearsals)
