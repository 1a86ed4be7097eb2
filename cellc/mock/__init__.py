"""The mock backend: executes a generated folder, and knows nothing of the compiler that wrote it."""

from cellc.mock.cell import MockCell, load, run_all
from cellc.mock.errors import MockError
from cellc.mock.record import AttemptRecord, to_json_lines
from cellc.mock.result import RehearsalResult

__all__ = ["AttemptRecord", "MockCell", "MockError", "RehearsalResult", "load", "run_all", "to_json_lines"]
