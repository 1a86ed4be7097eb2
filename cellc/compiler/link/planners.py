"""Binds what MoveIt solves inverse kinematics with and plans with: names of the spec to plugins of the distribution."""

from __future__ import annotations

from cellc.compiler.catalog.load import load_planners
from cellc.compiler.catalog.tables import PlannerPlugin, PlannerTable
from cellc.compiler.cell.motion import Pipeline, Solver
from cellc.compiler.link.names import unknown_name
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.control import GroupSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.vocabulary import Distro

_TIMEOUT_S = 0.05
_RESOLUTION = 0.005


def link_pipelines(spec: CellSpec, document: SourceDocument, distro: Distro) -> Outcome[tuple[Pipeline, ...]]:
    """Bind the planning pipelines, the default one first."""
    known = _table().pipelines
    pipelines: list[Pipeline] = []
    problems: list[Diagnostic] = []
    for index, name in enumerate(spec.motion.pipelines):
        path: YamlPath = ("motion", "pipelines", index)
        if name not in known:
            problems.append(unknown_name("unknown-planner", name, "planning pipeline", known, document, path))
            continue
        facts = known[name]
        problems += _not_released(name, facts, distro, document, path)
        pipelines.append(
            Pipeline(
                name=name,
                plugin=facts.plugin,
                package=facts.package,
                parameters=dict(facts.parameters),
                timed=facts.timed,
                joint_goals=facts.joint_goals,
                avoids_nothing=facts.avoids_nothing,
                capabilities=facts.capabilities,
            )
        )
    return Outcome(tuple(pipelines), tuple(problems))


def link_solver(name: str, written: GroupSpec, document: SourceDocument, distro: Distro) -> Outcome[Solver]:
    """Bind what solves inverse kinematics for a group, and look up its planner."""
    table, path = _table(), ("motion", "groups", name)
    problems: list[Diagnostic] = []
    if written.planner not in table.planners:
        at = (*path, "planner")
        problems.append(unknown_name("unknown-planner", written.planner, "planner", table.planners, document, at))
    if written.ik not in table.solvers:
        solvers = table.solvers
        problems.append(unknown_name("unknown-planner", written.ik, "IK solver", solvers, document, (*path, "ik")))
        return Outcome(None, tuple(problems))
    facts = table.solvers[written.ik]
    problems += _not_released(written.ik, facts, distro, document, (*path, "ik"))
    solver = Solver(
        name=written.ik,
        plugin=facts.plugin,
        package=facts.package,
        parameters=dict(facts.parameters),
        search_resolution=_RESOLUTION,
        timeout_s=_TIMEOUT_S if written.ik_timeout is None else written.ik_timeout.si,
    )
    return Outcome(solver, tuple(problems))


def _table() -> PlannerTable:
    table = load_planners().value
    assert table is not None  # package data, held valid by the catalog's tests
    return table


def _not_released(
    name: str, facts: PlannerPlugin, distro: Distro, document: SourceDocument, path: YamlPath
) -> tuple[Diagnostic, ...]:
    if distro in facts.distros:
        return ()
    where = f"only {', '.join(facts.distros)}" if facts.distros else "no distribution does"
    problem = Diagnostic(
        code="planner-not-in-distro",
        severity=Severity.ERROR,
        message=f"{distro} does not release `{facts.package}`, which `{name}` needs, {where}",
        span=document.locate(path),
        yaml_path=path,
        help="choose one that the pinned distribution has",
    )
    return (problem,)
