"""The version of cellc; a module of its own, so that no stage imports the package, which imports every stage."""

__version__ = "0.1.0"
