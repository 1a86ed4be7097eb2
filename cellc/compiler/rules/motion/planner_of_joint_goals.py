"""The default pipeline takes goals of joints alone, and the cell has Cartesian ones.

CHOMP optimizes between two configurations: asked for a pose it answers with a failure, and a log line that only
joint-space goals are supported. The sender of the goals gets that from the pipeline that is used where a
request names none.

Example that is reported:

```yaml
motion:
  pipelines: [chomp, ompl]  # expect at 0
```

Example that is accepted:

```yaml
motion:
  pipelines: [ompl, chomp]
```

Fix: let another pipeline come first.

Source:
https://github.com/moveit/moveit2/blob/2.12.4/moveit_planners/chomp/chomp_motion_planner/src/chomp_planner.cpp#L100
(2.12.4): only joint-space goals are supported
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the default pipeline of a cell with Cartesian goals that it cannot plan to."""
    pipelines = graph.cell.pipelines
    if pipelines and pipelines[0].joint_goals and graph.cell.goals:
        message = f"`{pipelines[0].name}` takes goals of joints alone, and `{graph.cell.goals[0].name}` is a pose"
        yield found(graph, ("motion", "pipelines", 0), message)
