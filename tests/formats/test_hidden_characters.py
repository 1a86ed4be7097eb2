"""No file that is written holds a character that hides text, whatever came past the readers that refuse it."""

from __future__ import annotations

import json
from xml.etree.ElementTree import fromstring

import pytest
import yaml
from pydantic import BaseModel

from cellc.compiler.formats import json_text, xml_text, yaml_text
from cellc.compiler.formats.escape import markdown, shell_quoted, shell_word
from cellc.mock.report_page.html import tag, to_page
from tests.printing.payloads import PAYLOADS, hides

each = pytest.mark.parametrize("text", PAYLOADS.values(), ids=PAYLOADS.keys())


class _Model(BaseModel):
    names: dict[str, str]


@each
def test_json_shows_it_and_means_it(text: str) -> None:
    written = json_text.render(_Model(names={text: text}))
    assert not hides(written)
    assert json.loads(written) == {"names": {text: text}}


@each
def test_yaml_shows_it_and_means_it(text: str) -> None:
    written = yaml_text.render({text: {"one": text, "all": (text,)}})
    assert not hides(written)
    assert yaml.safe_load(written) == {text: {"one": text, "all": [text]}}


@each
def test_xml_shows_it_and_means_it_where_xml_can(text: str) -> None:
    written = xml_text.render(xml_text.element("a", {"b": text}, [xml_text.comment(text)]), text)
    assert not hides(written)
    # XML 1.0, production Char: no reference to a control character of ASCII either, but tab and ends of lines.
    assert fromstring(written).attrib["b"] == "".join(
        "\ufffd" if character < " " and character not in "\t\n\r" else character for character in text
    )


@each
def test_text_for_people_shows_it_as_an_escape(text: str) -> None:
    for write in (markdown, shell_quoted, shell_word):
        assert not hides(write(f"a {text} b").replace("\n", ""))
    assert not hides(to_page(text, "", tag("p", text, tag("b", text), text, title=text)))
    assert "\\u202e" in to_page("", "", tag("p", "a\u202eb"))
