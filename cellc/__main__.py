"""``python -m cellc``, which is the command ``cellc`` too."""

from __future__ import annotations

import gc
import os
import signal
import sys


def raise_lost_interrupts() -> None:
    """Have Ctrl-C raised again, by an alarm, where a callback of the interpreter swallowed it.

    Importing has such callbacks: one Ctrl-C in a hundred was lost while a check loaded.
    """
    others = sys.unraisablehook

    def again(swallowed: sys.UnraisableHookArgs) -> None:
        if issubclass(swallowed.exc_type, KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, 0.01)
        else:
            others(swallowed)

    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, signal.default_int_handler)
        sys.unraisablehook = again


def main() -> None:
    """Run the command; the import stands inside, so that Ctrl-C while it loads ends without a traceback too."""
    if sys.flags.optimize > 1:
        print("error: `python -OO` drops the docstrings, in which rules and commands keep their help", file=sys.stderr)
        sys.exit(2)
    # A tenth of a short command went into collecting garbage. What a check makes are 80 000 objects, and they stay.
    gc.set_threshold(200_000, 20, 20)
    # What a spec means is no matter of plugins; looking for some takes longer than reading the spec.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    raise_lost_interrupts()
    try:
        from cellc.cli.main import main as run

        run()
    except KeyboardInterrupt:
        print("error: interrupted; nothing was left half-written", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
