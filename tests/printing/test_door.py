"""What passes the door to the terminal and to CI: text alone, whoever wrote it."""

from __future__ import annotations

import io
import json
from contextlib import redirect_stderr, redirect_stdout
from itertools import count

import pytest

from cellc.contract.diagnostics.unsafe_text import escaped, harmless_json, hidden, hidden_in_json
from cellc.contract.printing import Line, Style, Styled, WorkflowCommand, as_text, progress, run_to_end, show_document
from tests.printing.payloads import PAYLOADS, harm, without_colour

payloads = pytest.mark.parametrize("text", PAYLOADS.values(), ids=PAYLOADS.keys())


@payloads
def test_text_stays_on_its_line_and_is_obeyed_by_nobody(text: str) -> None:
    lines: tuple[Line, ...] = (text, (text, Styled("ours", Style.BOLD)), (Styled(text, Style.RED), text), ("a", text))
    plain = as_text(lines, color=False)
    assert plain.count("\n") == len(lines)
    assert harm(plain) == []
    assert without_colour(as_text(lines, color=True)) == plain


def test_mark_that_two_texts_make_together_is_broken_too() -> None:
    assert harm(as_text([("#", "#[error]a"), (":", ":error::a")], color=False)) == []
    assert harm(without_colour(as_text([("#", Styled("#[error]a", Style.RED))], color=True))) == []


def test_text_that_steers_nothing_is_shown_as_it_is() -> None:
    plain = "Größe 5 µm – 漢字 \u26a0\ufe0f 1\ufe0f\u20e3, a::b, # 1, ## 2, C:\\x [a]"
    assert as_text([plain], color=False) == f"{plain}\n"


@payloads
def test_document_keeps_its_lines_and_nothing_else(text: str) -> None:
    out = io.StringIO()
    with redirect_stdout(out):
        show_document(f"# ours\n\n- {text}\n{text}\n")
    assert harm(out.getvalue()) == []
    assert out.getvalue().startswith("# ours\n\n- ")


@payloads
def test_workflow_command_is_one_and_names_the_file_as_it_is(text: str) -> None:
    line = WorkflowCommand("error", {"file": f"{text}.yaml", "line": 1}, (text, text)).text()
    assert harm(line, frozenset({"error"})) == []
    # As the runner takes it apart: at the first `::` behind the beginning, then at commas, then at the first `=`.
    told, _, message = line.removeprefix("::").partition("::")
    properties = dict(pair.split("=", 1) for pair in told.removeprefix("error ").split(","))
    file = properties["file"]
    for written, meant in (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%")):
        file = file.replace(written, meant)
    assert list(properties) == ["file", "line"]
    assert file == "".join(one if one in "\r\n" else escaped(one) for one in f"{text}.yaml")
    assert message.count("%0A") == 1


@payloads
def test_json_means_the_same_and_is_obeyed_by_nobody(text: str) -> None:
    for written in (json.dumps({text: [text]}, ensure_ascii=False, indent=2), json.dumps({text: [text]})):
        shown = harmless_json(written)
        assert json.loads(shown) == {text: [text]}
        assert harm(shown) == []


@payloads
def test_progress_draws_text_alone(text: str) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    terminal, times = Terminal(), count(0.0, 2.0)
    with progress("", terminal, lambda: next(times)) as update:
        update(text)
        drawn = terminal.getvalue()
    assert harm(drawn.removeprefix("\r\r")) == []


@payloads
def test_bug_quotes_text_on_its_line(text: str) -> None:
    def fail() -> int:
        raise ValueError(text)

    err = io.StringIO()
    with redirect_stderr(err):
        assert run_to_end(fail) == 70
    assert harm(err.getvalue().replace("    ", "")) == []
    assert err.getvalue().endswith("error: this is a bug of cellc\n")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("a\u202eb", 0x202E),
        ("a\u009bb", 0x9B),
        ("a\u200bb", 0x200B),
        ("a\u200db", 0x200D),  # joins nothing
        ("a\ufe0fb", 0xFE0F),  # chooses the form of nothing
        ("a\u2060b", 0x2060),
        ("a\u00adb", 0xAD),
        ("a\u3164b", 0x3164),
        ("a\U000e0041b", 0xE0041),
    ],
)
def test_character_that_hides_is_named_raw_and_as_an_escape_of_json(text: str, code: int) -> None:
    assert hidden(text) == f"the text holds the character U+{code:04X}"
    for written in (json.dumps({"b": text}, ensure_ascii=False, indent=1), json.dumps({"b": text}, indent=1)):
        assert hidden_in_json(written) == (2, hidden(text))


# Persian "I want" with its joiner, an emoji of several, an emoji with its form, a keycap.
@pytest.mark.parametrize(
    "text", ["می\u200cخواهم", "👨\u200d🔧", "\u26a0\ufe0f", "1\ufe0f\u20e3", "é漢字", "a\\u202e", "tab\tline\n"]
)
def test_character_that_a_script_needs_is_no_finding(text: str) -> None:
    assert hidden(text) is None
    for written in (json.dumps(text, ensure_ascii=False), json.dumps(text)):
        assert hidden_in_json(written) is None
