"""``python -m cellc``, which is the command ``cellc`` too."""

from __future__ import annotations

import _thread
import gc
import sys
import time
from collections.abc import Callable


def _interrupt_soon() -> None:
    time.sleep(0.01)  # not inside the callback, where it would be lost again
    _thread.interrupt_main()


def _raise_lost_interrupts() -> None:
    """Raise Ctrl-C again where a callback of the interpreter swallowed it: importing has such moments."""
    before: Callable[[sys.UnraisableHookArgs], object] = sys.unraisablehook

    def hook(unraisable: sys.UnraisableHookArgs, /) -> None:
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            _thread.start_new_thread(_interrupt_soon, ())
        else:
            before(unraisable)

    sys.unraisablehook = hook


def main() -> None:
    """Run the command; the import stands inside, so that Ctrl-C while it loads ends without a traceback too."""
    # A tenth of a short command went into collecting garbage while models are built: collect far less often.
    gc.set_threshold(70_000, 20, 20)
    _raise_lost_interrupts()
    try:
        from cellc.cli.main import main as run

        run()
    except KeyboardInterrupt:
        print("error: interrupted; nothing was left half-written", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
