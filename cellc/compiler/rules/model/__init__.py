"""Rules on what a robot description can get wrong."""
