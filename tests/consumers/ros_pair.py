"""The perception node and the task node of ROS, each a process: ``ros_pair.py FOLDER REHEARSAL``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.consumers import ros_perception, ros_task


def main() -> None:
    """Run both until the end of the task node; whoever started this ends its group."""
    subprocess.Popen([sys.executable, str(Path(ros_perception.__file__))])
    ros_task.main()


if __name__ == "__main__":
    main()
