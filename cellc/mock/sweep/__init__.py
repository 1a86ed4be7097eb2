"""How often a rehearsal succeeds where not everything is known exactly."""
