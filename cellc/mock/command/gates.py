"""The command behind `--gates`: rehearsals and a campaign, and what they say of the gates."""

from __future__ import annotations

import json

from cellc.mock.command.campaign import conduct_all, keep_evidence_of, load_checked, stopped
from cellc.mock.command.options import MockOptions
from cellc.mock.errors import MockError
from cellc.mock.gates.gate import GateResult, Verdict, gate_lines, gates_as_data
from cellc.mock.gates.runs import judged_campaign, judged_rehearsals
from cellc.mock.gates.sign import sign_gates


def run_gates(options: MockOptions) -> int:
    """Run everything that is evidence, and print each gate with its lines.

    Returns:
        0 where no line failed, UNKNOWN ones among them; 1 where one did; 2 where the folder or an option is unusable.
    """
    try:
        cell = load_checked(options)
        results = [cell.run(name, seed=options.seed) for name in cell.rehearsals]
        campaign = conduct_all(cell, options)
        keep_evidence_of(cell, campaign, options)
    except (MockError, KeyboardInterrupt) as stop:
        return stopped(stop)
    runs = (*judged_rehearsals(cell.entries, results), *judged_campaign(campaign))
    gates = sign_gates(cell.folder, runs, options.seed)
    if options.as_json:
        print(json.dumps({"gates": gates_as_data(gates), "notes": list(cell.notes)}, ensure_ascii=False, indent=2))
    else:
        print("\n".join(gate_lines(gates)).rstrip())
    return 1 if any(_failed(gate) for gate in gates) else 0


def _failed(gate: GateResult) -> bool:
    return gate.verdict is Verdict.FAILED
