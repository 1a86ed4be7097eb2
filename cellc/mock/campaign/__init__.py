"""All faults over all steps: which outcome each run ends in, whether its bound and the limits were held."""
