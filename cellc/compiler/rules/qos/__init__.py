"""Rules on quality of service."""
