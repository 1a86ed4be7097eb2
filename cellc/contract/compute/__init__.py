"""Many equal units of work, done by processes here or by a cluster: one interface over ``concurrent.futures``."""
