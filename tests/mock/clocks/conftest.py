"""The folder of the real cell, as the tests of the engine build it."""

from tests.mock.engine.conftest import built_folder, cell

__all__ = ["built_folder", "cell"]
