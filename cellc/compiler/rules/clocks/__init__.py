"""Rules on clocks, stamps and ages."""
