"""From bags of a real or rehearsed attempt to its record, the layer it failed in, and one page."""
