"""The version of cellc; a module of its own, so that no stage imports the package, which imports every stage."""

__version__ = "0.1.0"


def installed(distribution: str) -> str:
    """Return the version of an installed distribution; UNKNOWN where it is not installed."""
    from importlib.metadata import PackageNotFoundError, version  # loads for longer than `cellc --help` needs

    try:
        return version(distribution)
    except PackageNotFoundError:
        return "UNKNOWN"
