"""What the cells of one call have against each other."""
