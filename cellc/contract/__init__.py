"""The format between the compiler and the mock: contract.json, rehearsals.json and manifest.json."""
