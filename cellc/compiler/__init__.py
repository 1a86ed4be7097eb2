"""From a ``cell.yaml`` to the files of its ROS 2 package; ``pipeline`` says how."""
