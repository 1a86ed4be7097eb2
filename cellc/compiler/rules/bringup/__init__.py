"""Rules on start-up, promotion and recovery."""
