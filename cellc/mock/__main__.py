"""``python -m cellc.mock FOLDER``: runs the rehearsals of a generated folder without the compiler."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys

from cellc.mock.command.options import contradiction


def main() -> int:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(
        prog="python -m cellc.mock", description="Run the rehearsals of a generated folder."
    )
    parser.add_argument("folder", help="folder that `cellc build` wrote")
    parser.add_argument("--campaign", action="store_true", help="run every fault at every step, and print the matrix")
    parser.add_argument("--pairs", type=int, default=0, metavar="N", help="with --campaign: runs with two faults each")
    parser.add_argument("--jobs", type=int, metavar="N", help="with --campaign: processes, as many as cores by default")
    parser.add_argument("--list", action="store_true", help="print the runs of the campaign, and run none")
    parser.add_argument(
        "--replay", action="append", default=[], metavar="RUN", help="run this run of the campaign alone; repeatable"
    )
    parser.add_argument("--gates", action="store_true", help="run rehearsals and campaign, and judge gates L6, G1, G2")
    parser.add_argument("--json", action="store_true", help="print a JSON summary")
    parser.add_argument(
        "--rehearsal", action="append", default=[], metavar="NAME", help="run this one only; repeatable"
    )
    parser.add_argument("--records", metavar="FILE", help="write the attempt records as JSON lines")
    parser.add_argument("--evidence", metavar="FOLDER", help="write bags, records, key figures and a report")
    parser.add_argument("--seed", type=int, default=0, help="seed of everything drawn (default 0)")
    options = parser.parse_args()
    modes = {
        "--campaign": options.campaign,
        "--list": options.list,
        "--replay": bool(options.replay),
        "--gates": options.gates,
    }
    problem = contradiction(
        rehearsals=bool(options.rehearsal),
        modes=modes,
        pairs=options.pairs != 0,
        jobs=options.jobs is not None,
        paths={"--evidence": options.evidence, "--records": options.records},
    )
    if problem:
        parser.error(problem)
    # Imported by these, so that Ctrl-C while the planning libraries load ends without a traceback too.
    return _run_campaign(options) if any(modes.values()) else _run_rehearsals(options)


def _run_rehearsals(options: argparse.Namespace) -> int:
    from cellc.mock.command.rehearsals import run_command

    return run_command(
        options.folder,
        names=options.rehearsal,
        as_json=options.json,
        records=options.records,
        evidence=options.evidence,
        seed=options.seed,
    )


def _run_campaign(options: argparse.Namespace) -> int:
    from cellc.mock.command.campaign import CampaignOptions, list_runs, replay_runs, run_campaign

    asked = CampaignOptions(
        program="python -m cellc.mock",
        seed=options.seed,
        jobs=options.jobs,
        pairs=options.pairs,
        as_json=options.json,
        records=options.records,
        evidence=options.evidence,
    )
    if options.gates:
        from cellc.mock.command.gates import run_gates

        return run_gates(options.folder, asked)
    if options.list:
        return list_runs(options.folder, asked)
    if options.replay:
        return replay_runs(options.folder, options.replay, asked)
    return run_campaign(options.folder, asked)


def _discard_output() -> None:
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    try:
        code = main()
        if sys.stdout is not None:  # closed by who called
            sys.stdout.flush()
    except BrokenPipeError:  # who read the output has seen enough, as `head` does
        _discard_output()
        code = 1
    except OSError as problem:
        _discard_output()
        print(f"error: {(problem.strerror or 'unknown reason').lower()}", file=sys.stderr)
        code = 1
    except KeyboardInterrupt:
        print("error: interrupted; no records were written", file=sys.stderr)
        code = 2
    sys.exit(code)
