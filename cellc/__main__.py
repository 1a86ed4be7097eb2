"""``python -m cellc``, which is the command ``cellc`` too."""

from __future__ import annotations

import sys

if __name__ == "__main__" and not (sys.flags.isolated or getattr(sys.flags, "safe_path", False)):
    # `-m` looks first in the current folder, which may be an untrusted checkout: import nothing from it.
    sys.path.pop(0)

import gc
import os
import warnings

from cellc.contract.signals import run_program


def main() -> None:
    """Run the command; what is imported is inside, so that a signal while it loads ends without a traceback too."""
    if sys.flags.optimize > 1:
        from cellc.contract.printing import refuse

        refuse("`python -OO` drops the docstrings, in which rules and commands keep their help")
        sys.exit(2)
    # Garbage collection took a tenth of a short command. A check makes 80 000 objects, and keeps them.
    gc.set_threshold(200_000, 20, 20)
    # What a spec means is no matter of plugins; looking for some takes longer than reading the spec.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    os.environ["PYTHONSAFEPATH"] = "1"  # of its own processes: `-c` looks in the current folder first too
    if not sys.warnoptions:  # what libraries say to programmers is no word of this program, and quotes what it reads
        warnings.simplefilter("ignore")
        os.environ["PYTHONWARNINGS"] = "ignore"
    sys.exit(run_program(_run))


def _run() -> int:
    from cellc.tools.cli.main import run

    return run()


if __name__ == "__main__":
    main()
