"""What a camera sees in a rehearsal, drawn from the shapes of the description."""
