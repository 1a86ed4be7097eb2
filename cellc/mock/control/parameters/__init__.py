"""ROS parameter files: reading, matching to nodes, declaration with types."""

from cellc.mock.control.parameters.declaration import (
    Parameter,
    ParameterError,
    ParameterSet,
    Requirement,
)
from cellc.mock.control.parameters.file import ParameterFile, ParameterFileError
from cellc.mock.control.parameters.values import ParameterValue, type_name

__all__ = [
    "Parameter",
    "ParameterError",
    "ParameterFile",
    "ParameterFileError",
    "ParameterSet",
    "ParameterValue",
    "Requirement",
    "type_name",
]
