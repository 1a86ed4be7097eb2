"""The nodes of the cell that are not controllers: cameras, perception, robot_state_publisher, motion planning."""
