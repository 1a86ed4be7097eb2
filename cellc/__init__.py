"""cellc: a declarative compiler for robot cells."""

__version__ = "0.1.0"
