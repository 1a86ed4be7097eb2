"""Rules on the contract of topics, services and actions."""
