"""The pages of the codes of this stage: every finding of it is an error, and has a title, a reason and a fix."""

from __future__ import annotations

import pytest

from cellc.compiler.link.codes import CODES
from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import CodePage


@pytest.mark.parametrize("page", CODES, ids=lambda page: page.code)
def test_page_of_a_code(page: CodePage) -> None:
    assert page.code.replace("-", "").isalnum()
    assert page.severity is Severity.ERROR
    assert len({page.title, page.why, page.fix}) == 3
    assert min(map(len, (page.title, page.why, page.fix))) > 10
