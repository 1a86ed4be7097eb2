"""``contract.json``, part by part."""
