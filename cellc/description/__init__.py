"""From URDF or xacro to one typed robot model: links, joints, shapes, and the hardware of ``<ros2_control>``."""
