"""Suggestions for misspelt names: right among many, and bounded."""

from __future__ import annotations

import difflib
import sys

import pytest

from cellc.contract.diagnostics.nearest import nearest


def test_misspelt_name_is_found_among_thousands() -> None:
    names = [f"frame_{number:05}" for number in range(3000)] + ["fixture_plate"]
    assert nearest("fixture_plaet", names) == ("fixture_plate",)


def test_a_name_is_compared_with_a_bounded_number_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []
    real = difflib.get_close_matches

    def counting(word: str, names: list[str], n: int, cutoff: float) -> list[str]:
        seen.append(len(names))
        return real(word, names, n=n, cutoff=cutoff)

    monkeypatch.setattr(sys.modules["cellc.contract.diagnostics.nearest"], "get_close_matches", counting)
    nearest("frame_nomber", [f"frame_number_{number}" for number in range(5000)])
    assert seen == [128]
    assert nearest("a" * 100_000, ["a" * 100_000]) == ()
