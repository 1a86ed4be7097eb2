"""`cellc gates`: everything that is evidence is run, and each gate is judged by it."""

from __future__ import annotations

from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.printing import show, show_document
from cellc.mock.cell import in_turn
from cellc.mock.command.campaign import conduct_all, load_for_campaign
from cellc.mock.command.ending import refusing
from cellc.mock.command.options import GatesOptions
from cellc.mock.command.rehearsals import keep_evidence
from cellc.mock.command.sweep import entries_to_sweep, sweep_entry
from cellc.mock.gates.gate import Verdict, gate_lines, gates_as_data
from cellc.mock.gates.runs import judged_campaign, judged_rehearsals
from cellc.mock.gates.sign import sign_gates


@refusing
def run_gates(options: GatesOptions) -> int:
    """Run everything that is evidence, and print each gate with its lines.

    Returns:
        0 where no line failed, UNKNOWN ones among them; 1 where one did; 2 where the folder or an option is unusable.
    """
    cell, wanted = load_for_campaign(options), options.sweep
    entries = () if wanted is None else entries_to_sweep(cell, wanted)  # or it refuses, before the minutes of the rest
    results = [cell.run(name, seed=options.seed) for name in in_turn(cell, cell.rehearsals)]
    campaign = conduct_all(cell, options)
    sweeps = () if wanted is None else tuple(sweep_entry(cell, entry, wanted) for entry in entries)
    keep_evidence(cell, dict.fromkeys(cell.rehearsals), options, campaign, sweeps)
    runs = (*judged_rehearsals(cell.entries, results), *judged_campaign(campaign))
    gates = sign_gates(cell.folder, runs, options.seed, sweeps)
    if options.as_json:
        judged = {"gates": gates_as_data(gates), "notes": list(cell.notes)}
        show_document(json_document(judged))
    else:
        show(*(f"note: {note}" for note in cell.notes), *list(gate_lines(gates))[:-1])
    return 1 if any(gate.verdict is Verdict.FAILED for gate in gates) else 0
