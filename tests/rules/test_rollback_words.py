"""What is missing of a rollback is named, and asked for, in words that fit one part and both."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rules.examples import Example, diagnose_example

IMAGE = "the digest of the last image that ran"
CONFIGURATION = "the id of the last configuration that ran, such as `cfg-0123456789ab`"


@pytest.mark.parametrize(
    ("rollback", "message", "help_"),
    [
        ("image: UNKNOWN, configuration: cfg-1", "the rollback `image` is UNKNOWN", f"write {IMAGE}"),
        (
            "image: sha256-1, configuration: UNKNOWN",
            "the rollback `configuration` is UNKNOWN",
            f"write {CONFIGURATION}",
        ),
        (
            "image: UNKNOWN, configuration: UNKNOWN",
            "the rollback `image` and `configuration` are UNKNOWN",
            f"write {IMAGE} and {CONFIGURATION}",
        ),
    ],
)
def test_words_fit_what_is_missing(rollback: str, message: str, help_: str, tmp_path: Path) -> None:
    example = Example("yaml", f"versions: {{rollback: {{{rollback}}}}}")
    (found,) = [one for one in diagnose_example(example, tmp_path) if one.code == "missing-rollback"]
    assert (found.message, found.help) == (message, help_)
