"""Devices with a direct SDK in the mock: a simulated adapter, and the action that it is commanded through."""
