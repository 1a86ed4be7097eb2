"""How every command of the mock ends that cannot be done: with one line and exit code 2."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

from cellc.contract.extras import require
from cellc.contract.printing import refuse
from cellc.mock.command.options import FolderOptions
from cellc.mock.errors import MockError

_Options = TypeVar("_Options", bound=FolderOptions)


def refusing(command: Callable[[_Options], int]) -> Callable[[_Options], int]:
    """Let a command end with 2 and the reason where the folder or an option is unusable.

    Raises:
        MissingExtraError: what it needs is not installed; found out before the minutes that a run may take.
    """

    @wraps(command)
    def within(options: _Options) -> int:
        require(*options.extras())
        try:
            return command(options)
        except MockError as problem:
            refuse(str(problem))
        except MemoryError:
            refuse("the folder asks for more memory than there is; docs/limits.md has what bounds it")
        return 2

    return within
