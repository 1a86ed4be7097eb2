"""Bags: MCAP files with ROS 2 messages, as rosbag2 would have recorded them, and the same bytes in every run."""
