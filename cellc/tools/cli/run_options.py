"""The options that commands of the mock share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any

import click

from cellc.mock.command.options import FolderOptions, Live
from cellc.mock.ros.asked import OWN_DOMAIN, AmongNodes, Timing, usual_interpreter
from cellc.tools.cli.words import complete_rehearsal

Command = Callable[..., None]


def _refuse_empty(_context: click.Context, parameter: click.Parameter, path: str | None) -> str | None:
    if path == "":
        raise click.UsageError(f"{parameter.opts[0]} cannot be written: its path is empty.")
    return path


FOLDER = click.argument("folder", type=click.Path(path_type=str))
FOLDERS = click.argument("folders", nargs=-1, required=True, metavar="FOLDER...", type=click.Path(path_type=str))
REHEARSALS = click.option(
    "--rehearsal",
    "rehearsals",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_rehearsal,
    help="Run only this rehearsal; repeatable.",
)
PAIRS = click.option("--pairs", default=0, metavar="N", help="Add N runs with two faults each.")
JOURNAL = click.option(
    "--journal", type=click.Path(path_type=str, dir_okay=False), help="Store each run in FILE, and resume from it."
)
JSON = click.option("--json", "as_json", is_flag=True, help="Write the results as JSON.")
RECORDS = click.option(
    "--records",
    type=click.Path(path_type=str, dir_okay=False),
    callback=_refuse_empty,
    help="Write attempt records as JSON lines.",
)
EVIDENCE = click.option(
    "--evidence",
    type=click.Path(path_type=str, file_okay=False),
    callback=_refuse_empty,
    help="Write bags, records, key figures and a report.",
)
IMAGES = click.option("--images", is_flag=True, help="With --evidence: draw what cameras see into the bags.")
SEED = click.option("--seed", default=0, show_default=True, help="Seed of all random draws.")
PHYSICS = click.option("--physics", is_flag=True, help="Give joints and parts mass, drives, contacts and friction.")
AGAINST = click.option(
    "--against", is_flag=True, help="With --physics: run without masses too, and say where the two part."
)
FILM = click.option(
    "--film",
    type=click.Path(path_type=str, dir_okay=False),
    callback=_refuse_empty,
    help="Write a film of one rehearsal to FILE: .gif, or .mp4 with ffmpeg.",
)
STAGE = click.option("--stage", default="", metavar="PERCENT", help="Plan in this stage of commissioning.")
EDITED = click.option(
    "--edited", is_flag=True, help="Run an edited folder; every result is marked, and no gate is signed."
)


def options_as(kind: type[FolderOptions]) -> Callable[[Command], Command]:
    """Give what fields of ``kind`` are named after as one argument, ``options``.

    Of a command that takes several folders it names none: the command finds those that are meant.
    """
    names = {each.name for each in fields(kind)}

    def decorate(command: Command) -> Command:
        @wraps(command)
        def within(**given: Any) -> None:
            own = {"folder": ""} | {name: value for name, value in given.items() if name in names}
            command(options=kind(**own), **{name: value for name, value in given.items() if name not in names})

        return within

    return decorate


def live_options(command: Command) -> Command:
    """Add the options that show rehearsals in Foxglove; they come as one argument, ``live``."""

    @click.option("--live", is_flag=True, help="Show the rehearsals in Foxglove in real time.")
    @click.option("--listen", metavar="HOST:PORT", help="With --live: address for Foxglove; 127.0.0.1:8765 by default.")
    @click.option("--speed", type=float, metavar="X", help="With --live: play back at X times real time.")
    @wraps(command)
    def within(live: bool, listen: str | None, speed: float | None, **others: Any) -> None:
        needless = [option for option, value in (("--listen", listen), ("--speed", speed)) if value is not None]
        if needless and not live:
            raise click.UsageError(f"{needless[0]} needs --live.")
        if others["images"] and others["evidence"] is None:
            raise click.UsageError("--images needs --evidence; with --live they are drawn where Foxglove shows them.")
        if live and others["evidence"] is not None:
            raise click.UsageError("--live cannot be combined with --evidence.")
        if speed is not None and not speed > 0.0:
            raise click.UsageError(f"--speed must be greater than 0, got {speed}.")
        command(live=Live(listen or "127.0.0.1:8765", speed or 1.0) if live else None, **others)

    return within


def ros_options(command: Command) -> Command:
    """Add the options of a run among real nodes; they come as one argument, ``among``."""

    @click.option("--ros", is_flag=True, help="Play the cell on a ROS 2 graph, around the nodes of --without.")
    @click.option("--without", metavar="NODES", help="With --ros: nodes that run for real, such as perception.")
    @click.option("--launch", metavar="COMMAND", help="With --ros: start them with COMMAND for each rehearsal.")
    @click.option("--lockstep", is_flag=True, help="With --ros: time waits for the answers that the contract expects.")
    @click.option("--pace", type=float, metavar="X", help="With --ros: run at X times real time; 1 by default.")
    @click.option(
        "--patience", type=float, metavar="S", help="With --lockstep: wait S seconds for an answer; 5 by default."
    )
    @click.option(
        "--domain", type=click.IntRange(0, 232), metavar="N", help=f"With --ros: domain; {OWN_DOMAIN} by default."
    )
    @click.option("--ros-python", metavar="FILE", help="With --ros: Python with rclpy; /usr/bin/python3 by default.")
    @wraps(command)
    def within(
        ros: bool,
        without: str | None,
        launch: str | None,
        lockstep: bool,
        pace: float | None,
        patience: float | None,
        domain: int | None,
        ros_python: str | None,
        **others: Any,
    ) -> None:
        named = ("without", without), ("launch", launch), ("pace", pace), ("patience", patience), ("domain", domain)
        given = [f"--{name}" for name, value in (*named, ("ros-python", ros_python)) if value is not None]
        given += ["--lockstep"] if lockstep else []
        if not ros:
            if given:
                raise click.UsageError(f"{given[0]} needs --ros.")
            command(among=None, **others)
            return
        if not without:
            raise click.UsageError("--ros needs --without NODES, such as --without perception.")
        if others.get("live") is not None or others["evidence"] is not None:
            raise click.UsageError(
                "--ros cannot be combined with --live or --evidence; record the graph with ros2 bag."
            )
        if pace is not None and (lockstep or not pace > 0.0):
            raise click.UsageError("--pace must be greater than 0, and is for runs without --lockstep.")
        if patience is not None and (not lockstep or not patience > 0.0):
            raise click.UsageError("--patience must be greater than 0, and is for runs with --lockstep.")
        nodes = tuple(name for name in without.replace(",", " ").split())
        timing = Timing(None if lockstep else pace or 1.0, patience or 5.0)
        asked = AmongNodes(
            nodes, ros_python or usual_interpreter(), timing, OWN_DOMAIN if domain is None else domain, launch or ""
        )
        command(among=asked, **others)

    return within
