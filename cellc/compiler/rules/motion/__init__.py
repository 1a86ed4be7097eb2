"""Rules on geometry and motion."""
