"""``python -m cellc``, which is the command ``cellc`` too."""

from __future__ import annotations

import gc
import sys


def main() -> None:
    """Run the command; the import stands inside, so that Ctrl-C while it loads ends without a traceback too."""
    # A tenth of a short command went into collecting garbage while models are built: collect far less often.
    gc.set_threshold(70_000, 20, 20)
    try:
        from cellc.cache.program import program_mark

        program = program_mark()
        from cellc.cli.main import main as run

        run(program=program)
    except KeyboardInterrupt:
        print("error: interrupted; nothing was left half-written", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
