"""Rules on addresses, traffic and discovery."""
