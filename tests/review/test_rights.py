"""Rights of an access policy, read with what it includes and without."""

from __future__ import annotations

from cellc.robot.description.xml_tree import XmlElement, read_xml
from cellc.tools.review.leaves import Leaf, Path
from cellc.tools.review.rights import rights

_NODE = """
<services reply="ALLOW"><service>~/get_parameters</service></services>
<topics publish="ALLOW" subscribe="ALLOW"><topic>/parameter_events</topic></topics>
"""
_OWN = '<topics publish="ALLOW"><topic>poses</topic></topics>'
_INCLUDE = '<xi:include href="common.xml" xpointer="xpointer(/common/node/*)"/>'


def _tree(text: str) -> XmlElement:
    read = read_xml(text, "policy.xml").value
    assert read is not None
    return read


def _rights(content: str, common: str | None = None) -> dict[Path, Leaf]:
    profile = f'<profile ns="/left" node="camera">{content}</profile>'
    enclave = f'<enclave path="/cell/left/camera"><profiles>{profile}</profiles></enclave>'
    policy = _tree(f'<policy xmlns:xi="http://www.w3.org/2001/XInclude"><enclaves>{enclave}</enclaves></policy>')
    return dict(rights(policy, None if common is None else _tree(common), "cell"))


def test_what_is_included_grants_what_it_would_where_it_is_included() -> None:
    expected = {
        ("right", "/left/camera", "reply"): ("/left/camera/get_parameters",),
        ("right", "/left/camera", "publish"): ("/left/poses", "/parameter_events"),
        ("right", "/left/camera", "subscribe"): ("/parameter_events",),
    }
    assert _rights(_NODE + _OWN) == expected
    assert _rights(_INCLUDE + _OWN, f"<common><node>{_NODE}</node></common>") == expected


def test_what_is_denied_or_not_understood_is_reported_too() -> None:
    denied = _OWN.replace("ALLOW", "DENY")
    foreign = _INCLUDE.replace("common.xml", "other.xml")
    found = _rights(denied + foreign + _INCLUDE + "<metadata/>", "<common/>")
    assert found == {
        ("right", "/left/camera", "DENY publish"): ("/left/poses",),
        ("right", "/left/camera", "other"): (
            "metadata",
            "xi:include common.xml xpointer(/common/node/*)",
            "xi:include other.xml xpointer(/common/node/*)",
        ),
    }
