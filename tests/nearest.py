"""Which tests are nearest to a module: ``python -m tests.nearest cellc/compiler/spec/units.py`` prints them for pytest.

``pytest $(python -m tests.nearest cellc/compiler/spec/units.py)`` runs them. ``benchmarks/mutants.py`` asks the same
table which tests ought to notice a change.
"""

from __future__ import annotations

import argparse
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_PROGRAMS = "consumers/test_bring_up.py consumers/test_first_goal.py consumers/test_installed_versions.py"
FOLDERS = {
    "__main__.py": "cli",
    "adapter": "mock/adapter",
    "artifact.py": "output",
    "cell": "cell link",
    "cli/attempt.py": "attempt",
    "cli/campaign.py": "mock/campaign cli",
    "cli/catalog.py": "browse cli",
    "cli/compare.py": "report/test_comparison.py cli",
    "cli/diagnose.py": "cli/test_diagnose.py diagnose",
    "cli/diff.py": "review",
    "cli/evidence.py": "evidence",
    "cli/gates.py": "mock/gates cli",
    "cli/import_.py": "foreign cli",
    "cli/init.py": "catalog/test_starter.py cli",
    "cli/sweep.py": "mock/sweep cli",
    "cli/upgrade.py": "review",
    "cli/view.py": "view",
    "compiler": "report",
    "compute": "compute",
    "contract": "spec mock",
    "deploy": "deploy consumers",
    "diagnostics": "report",
    "edit": "cli",
    "emit": "emit consumers",
    "emit/launch/bring_up_program.py": _PROGRAMS,
    "emit/launch/first_goal_program.py": _PROGRAMS,
    "emit/launch/installed_versions.py": _PROGRAMS,
    "frozen": "cell",
    "importing": "foreign cli",
    "limits.py": "description source",
    "link": "link corpus",
    "physics": "mock/physics",
    "pins.py": "link",
    "pipeline.py": "cli project/test_package.py",
    "printing.py": "printing",
    "robot": "description",
    "report/fleet.py": "cli/test_fleet.py report",
    "report/text_report.py": "report output cli/test_diagnose.py",
    "rules": "rules corpus",
    "signals.py": "cli",
    "store": "store",
    "tools": "cli",
    "transforms.py": "mock/tf formats graph",
    "version.py": "cli",
    "vocabulary.py": "mock",
}
"""The nearest tests of a stage, or of one of its files, where they are others than the folder of its name.

A command is tested where its subject is, by the command line: `cellc diff` among the reviews. What is emitted is
tested where it is read, too: by the schemas and readers of those that consume it.
"""


def stage_of(file: str) -> str:
    """Return the room of a wing that a source belongs to, or its own name where `FOLDERS` has it, or the wing."""
    wing, *within = file.split("/")[1:]
    if wing == "mock" or not within:
        return wing
    return within[0] if within[0] in FOLDERS or not within[0].endswith(".py") else wing


def nearest(file: str) -> list[str]:
    """Return the nearest tests of a source, as folders and files."""
    wing, _, within = file.removeprefix("cellc/").partition("/")
    room = f"{wing}/{within.partition('/')[0]}"
    stage = room if wing == "mock" and (ROOT / "tests" / room).is_dir() else stage_of(file)
    named = FOLDERS.get(within) or FOLDERS.get(stage, stage)
    return [f"tests/{name}" for name in named.split()]


def main() -> None:
    """Print the nearest tests of modules."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("module", nargs="+", type=Path)
    modules: list[Path] = parser.parse_args().module
    files = [file.resolve().relative_to(ROOT).as_posix() for file in modules]
    print(*dict.fromkeys(name for file in files for name in nearest(file)))


if __name__ == "__main__":
    main()
