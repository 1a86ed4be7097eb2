"""A URDF is read by `cellc.robot.description` alone; the check of our own output is the only other reader of XML."""

from __future__ import annotations

import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "cellc"
READING = re.compile(r"\b(fromstring|parseString|iterparse|XMLParser|ParserCreate)\(|\b(minidom|ElementTree)\.parse\(")
READERS = {
    "robot/description/meshes.py",  # takes meshes out of a text that the reader has accepted
    "robot/description/xacro_confinement.py",
    "robot/description/xml_tree.py",
    "compiler/verify/read_back.py",
}


def test_xml_is_read_in_one_place() -> None:
    reading = {
        file.relative_to(PACKAGE).as_posix()
        for file in PACKAGE.rglob("*.py")
        if READING.search(file.read_text(encoding="utf-8"))
    }
    assert reading == READERS
