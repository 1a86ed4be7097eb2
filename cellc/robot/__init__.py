"""What a robot is and how it can move: descriptions, collision, planning."""
