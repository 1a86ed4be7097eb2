"""``python -m cellc``, which is the command ``cellc`` too."""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command; the import stands inside, so that Ctrl-C while it loads ends without a traceback too."""
    try:
        from cellc.cli.main import main as run

        run()
    except KeyboardInterrupt:
        print("error: interrupted; nothing was left half-written", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
