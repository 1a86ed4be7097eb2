"""Records of attempts, read from bags of the mock and from bags that a library of others wrote."""
