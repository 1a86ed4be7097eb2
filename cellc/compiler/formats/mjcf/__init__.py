"""The cell as MJCF, for a simulator of contacts and torques: bodies, joints, actuators, parts, cameras and poses."""
