"""What becomes of a moment whose need does not hold: by distribution, and UNKNOWN where nobody has read it."""

from __future__ import annotations

from typing import Any

import pytest

from cellc.compiler.catalog.effects import EffectFacts
from cellc.contract.vocabulary import Distro, Need, Unmet


@pytest.mark.parametrize(
    ("told", "distro", "becomes"),
    [
        ("refused", "humble", Unmet.REFUSED),
        ({"humble": "refused", "jazzy": "ends_program"}, "humble", Unmet.REFUSED),
        ({"humble": "refused", "jazzy": "ends_program"}, "jazzy", Unmet.ENDS_PROGRAM),
        ({"humble": "refused"}, "kilted", Unmet.UNKNOWN),
    ],
)
def test_unmet_need(told: Any, distro: str, becomes: Unmet) -> None:
    facts = {"motion": "none", "does": "nothing", "source": "made up", "needs": {"program_stopped": told}}
    assert EffectFacts.model_validate(facts).unmet(Need.PROGRAM_STOPPED, Distro(distro)) is becomes
