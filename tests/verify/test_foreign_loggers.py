"""What a foreign parser logs while it reads is not printed: a finding says it."""

from __future__ import annotations

import subprocess
import sys

MIMICS_NOTHING = """\
<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/><mimic joint="nothing"/></joint></robot>
"""


def test_yourdfpy_prints_nothing() -> None:
    # In a process of its own: pytest listens to loggers, and then Python prints none of them.
    program = f"from cellc.compiler.verify.parsers import read_by_yourdfpy; read_by_yourdfpy({MIMICS_NOTHING!r})"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "", "")
