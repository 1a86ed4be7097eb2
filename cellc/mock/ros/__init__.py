"""Plays a cell on a real ROS 2 graph, around nodes that are run unmodified: the nodes under test."""
