"""What a report needs of a run, in bounded memory: envelopes over time, ages of messages, and claims."""
