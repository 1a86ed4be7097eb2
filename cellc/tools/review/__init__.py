"""What a change of a cell means to who reviews it: two packages compared fact by fact."""
