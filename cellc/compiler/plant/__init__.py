"""A plant: cells that are built, owned and reviewed apart, with what lies between them checked and bridged."""
