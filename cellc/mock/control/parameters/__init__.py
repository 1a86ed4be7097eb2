"""ROS parameter files: reading, matching to nodes, declaration with types."""

from cellc.mock.control.parameters.declaration import (
    Parameter,
    ParameterError,
    ParameterSet,
    ParameterValue,
    Requirement,
    type_name,
)
from cellc.mock.control.parameters.file import ParameterFile, ParameterFileError

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
