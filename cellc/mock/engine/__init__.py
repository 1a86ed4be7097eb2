"""One simulated clock: an event queue, processes that wait with a bound, and the control stack in blocks between."""
