"""Topics in one process, with the offer and request rules of ROS 2 QoS executed."""
