"""The stages in order; the first that fails ends the bring-up, and nothing moves."""

from __future__ import annotations

from cellc.mock.bringup.claim import claim
from cellc.mock.bringup.configure import configure
from cellc.mock.bringup.discover import discover
from cellc.mock.bringup.observe import observe
from cellc.mock.engine.process import Waiting
from cellc.mock.plant import Plant
from cellc.mock.result import StageEvidence


class Bringup:
    """Brings a plant up.

    Attributes:
        evidence: of each stage that was begun.
    """

    def __init__(self, plant: Plant) -> None:
        """Bind the bring-up to a plant whose nodes have started."""
        self.evidence: list[StageEvidence] = []
        self._plant = plant

    @property
    def passed(self) -> bool:
        """Tell whether every stage passed, so that motion may be asked for."""
        return all(stage.passed for stage in self.evidence)

    def run(self) -> Waiting[None]:
        """Run the stages up to the first that fails."""
        for stage in (discover, configure, observe, claim):
            evidence = yield from stage(self._plant)
            self.evidence.append(evidence)
            if not evidence.passed:
                return
