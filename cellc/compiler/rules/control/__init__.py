"""Rules on controllers and hardware."""
