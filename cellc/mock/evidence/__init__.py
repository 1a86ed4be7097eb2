"""Evidence of a call of the mock: a bag, records and indicators of each rehearsal, and one report over all."""
