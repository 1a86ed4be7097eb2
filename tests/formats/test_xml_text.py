"""XML that another reader takes with the same values."""

from __future__ import annotations

from xml.etree import ElementTree

from cellc.compiler.formats.xml_text import comment, element, render
from tests.properties import given, st

_TEXT = st.text(st.characters(min_codepoint=32, blacklist_categories=("Cs", "Cc", "Cn")), min_size=1)


@given(_TEXT, _TEXT)
def test_texts_and_attributes_read_back(attribute: str, text: str) -> None:
    read = ElementTree.fromstring(render(element("a", {"b": attribute}, text=text)))
    assert read.attrib == {"b": attribute}
    assert read.text == text


@given(st.text(alphabet="-> a"))
def test_comments_never_end_early(text: str) -> None:
    rendered = render(element("a", children=[comment(text), element("b")]), header=text or "x")
    assert [child.tag for child in ElementTree.fromstring(rendered)] == ["b"]


def test_document_is_laid_out_for_review() -> None:
    tree = element("a", {"x": "1"}, [element("b", text="t"), comment("next"), element("c", children=[element("d")])])
    assert render(tree, header="Made\nso") == (
        '<?xml version="1.0"?>\n<!--\n  Made\n  so\n-->\n'
        '<a x="1">\n  <b>t</b>\n\n  <!-- next -->\n  <c><d/></c>\n</a>\n'
    )


def test_an_element_with_nothing_but_one_other_shares_its_line_where_both_fit() -> None:
    def rendered(length: int) -> list[str]:
        inner = element("b", {"x": "1"}, [element("c", text="t" * length)])
        return render(element("a", children=[inner, element("d")])).splitlines()[2:-1]

    room = 120 - len('  <b x="1"><c></c></b>')
    assert rendered(room) == [f'  <b x="1"><c>{"t" * room}</c></b>', "  <d/>"]
    assert rendered(room + 1) == ['  <b x="1">', f"    <c>{'t' * (room + 1)}</c>", "  </b>", "  <d/>"]
