"""A run that begins with a copy of a cell that stands ends bit by bit as one that comes up by itself."""

from __future__ import annotations

from dataclasses import asdict

import pytest

from cellc.contract.transforms import Pose
from cellc.mock import MockCell
from cellc.mock.bringup import Bringup
from cellc.mock.campaign.campaign import execute
from cellc.mock.campaign.plan import CampaignRun
from cellc.mock.cell import cell_of
from cellc.mock.plant import Plant
from cellc.mock.reality import AS_STATED, Displacement, Reality
from cellc.mock.snapshot import SnapshotMemory

_STRAIGHT = (0.0, 0.0, 0.0, 1.0)
_ASIDE = Reality(
    links={"camera_bottom_screw_frame": Pose((0.002, 0.0, 0.001), _STRAIGHT)},
    objects={"object": Displacement((0.03, -0.02, 0.0), Pose((0.0, 0.0, 0.0), _STRAIGHT))},
    offsets_s={"control_pc": -0.003, "camera": 0.002},
    noise=7,
)
_FAR_CLOCK = Reality(offsets_s={"control_pc": 0.15, "camera": 0.15})


@pytest.fixture
def brought_up(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """One word for each bring-up that is executed."""
    found: list[str] = []
    bring_up = SnapshotMemory.bring_up

    def counted(memory: SnapshotMemory, plant: Plant, bringup: Bringup) -> None:
        found.append("brought up")
        bring_up(memory, plant, bringup)

    monkeypatch.setattr(SnapshotMemory, "bring_up", counted)
    return found


@pytest.mark.parametrize(("drawn", "times"), [(_ASIDE, 1), (_FAR_CLOCK, 2)])
def test_whatever_is_drawn_a_copy_ends_as_a_cell_that_comes_up(
    cell: MockCell, brought_up: list[str], drawn: Reality, times: int
) -> None:
    entry, copied, fresh = cell.entry("pick_and_place"), cell_of(cell.folder), cell_of(cell.folder)
    copied.rehearse(entry, reality=AS_STATED)
    second = copied.rehearse(entry, reality=drawn)
    assert len(brought_up) == times
    assert repr(asdict(second)) == repr(asdict(fresh.rehearse(entry, reality=drawn)))


def test_what_was_commanded_in_the_bring_up_is_in_the_journal_of_a_copy(cell: MockCell, brought_up: list[str]) -> None:
    known, run = cell_of(cell.folder), CampaignRun.undisturbed(cell.entry("pick_and_place"))
    known.rehearse(run.entry)
    assert execute(known, run, 0) == execute(cell_of(cell.folder), run, 0)
    assert len(brought_up) == 2
