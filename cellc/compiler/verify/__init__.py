"""Read our artifacts back with parsers that we did not write."""
