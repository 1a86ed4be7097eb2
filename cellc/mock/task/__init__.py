"""The task node: runs the steps of a rehearsal, each an attempt with a bound and a named outcome."""
