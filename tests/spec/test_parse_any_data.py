"""No data that YAML can say makes the spec stage raise, hang or talk like a library."""

from __future__ import annotations

import re
import tempfile
import unicodedata
from pathlib import Path

from cellc.compiler.source import Plain
from cellc.compiler.spec.cell_spec import CellSpec
from tests.properties import given, st
from tests.spec.mutations import mutated
from tests.spec.reading import CELLS, as_yaml, parsed

_KEYS = st.sampled_from([*CellSpec.model_fields, "from", "to", "topic", "[key]", "mapping", "text", "a", "é", "a\n"])
_SCALARS = st.none() | st.booleans() | st.integers(-(2**62), 2**62) | st.floats(allow_nan=False, allow_infinity=False)
# What nobody sees is refused before a spec is read: controls, and marks that choose the form of the character before;
# and the sign of what launch files replace.
_SEEN = st.characters(
    codec="utf-8", exclude_categories=["Cc", "Cf", "Zl", "Zp", "Cn", "Co"], exclude_characters="$"
).filter(lambda character: not unicodedata.name(character, "").startswith("VARIATION SELECTOR"))
_DATA = st.recursive(
    _SCALARS | st.text(_SEEN, max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(_KEYS, inner, max_size=4),
    max_leaves=12,
)
_LIBRARY_TALK = re.compile(r"pydantic|https?://|[a-z]Spec\b|validat|(?<!version )tuple|dict\b|NoneType|\bstr\b|\bint\b")


def _assert_speaks(data: Plain) -> None:
    with tempfile.TemporaryDirectory() as folder:
        outcome = parsed(as_yaml(data), Path(folder))
    assert (outcome.value is None) == bool(outcome.diagnostics)
    for found in outcome.diagnostics:
        assert len(found.message.splitlines()) == 1
        assert found.help
        assert not _LIBRARY_TALK.search(re.sub("`[^`]*`", "", found.message + found.help))


@given(st.dictionaries(_KEYS, _DATA, max_size=6))
def test_any_mapping_gives_a_spec_or_diagnostics(data: dict[str, Plain]) -> None:
    _assert_speaks({"format": 1, **data})


@given(st.sampled_from(CELLS), st.data())
def test_any_mutation_of_a_cell_gives_a_spec_or_diagnostics(path: Path, data: st.DataObject) -> None:
    _assert_speaks(mutated(path, data, _DATA))
