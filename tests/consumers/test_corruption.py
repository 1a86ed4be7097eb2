"""How much of what an emitter could get wrong is seen without a golden record, and that no emitter can be left out.

The golden record in ``generated/`` sees every changed byte. What is counted here is what foreign parsers, schemas and
declared rules see on their own: a fault that was there before the record was made.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory, mkdtemp

import pytest

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.deployment import Deployment, plan_deployment
from cellc.compiler.emit.emit_all import EMITTERS
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.output.compare import compare
from cellc.compiler.output.write import write
from cellc.compiler.verify import verify
from tests.consumers import (
    starting,
    test_agreement,
    test_bring_up,
    test_claim_watch,
    test_drawings,
    test_environment,
    test_first_goal,
    test_installed_versions,
    test_launch,
    test_moveit,
    test_observe,
    test_observe_host,
    test_pages,
    test_parameters,
    test_pictures,
    test_refusals,
    test_scene,
    test_security,
    test_walk,
    test_xsd,
)
from tests.consumers.corruption import corruptions
from tests.consumers.matrix import Build, build, in_place
from tests.consumers.stand_in_graph import StandIn
from tests.oracles import needs_upstream

_SEED = 20260822
_SAMPLE = 50
# Measured: 42 of this sample, 44 and 49 of those before the package got other files: every change of the package draws
# other lines. Not seen: prose (descriptions, rows and places of pages and pictures), the time limit of a command, a
# parameter whose default is the same, a display of RViz.
_FLOOR = 42

_CELL, _DISTRO = "ur5e_pick", "jazzy"
_CHECKS: tuple[Callable[[str, str], None], ...] = (
    test_launch.test_nothing_on_the_mock_is_told_of_a_real_address_or_plugin,
    test_launch.test_real_target_is_refused_without_its_confirmation,
    test_launch.test_real_target_has_no_mock_hardware_and_the_mock_has_no_driver,
    test_launch.test_other_address_than_that_of_the_description_is_refused,
    test_launch.test_static_transforms_have_one_authority,
    test_launch.test_each_manager_hears_the_description_of_its_own_hardware,
    test_launch.test_node_names_differ_and_nothing_that_commands_is_started_again,
    test_launch.test_every_parameter_file_is_read_by_a_process,
    test_launch.test_what_is_launched_or_found_is_a_dependency_and_is_installed,
    test_security.test_processes_start_in_enclaves_of_the_policy,
    test_security.test_controllers_serve_their_own_actions_alone_and_their_clients_alone_may_call,
    test_security.test_what_one_node_hears_another_may_say,
    test_security.test_descriptions_and_joint_states_pass,
    test_security.test_managers_serve_what_they_have_and_spawners_may_call_what_they_need_and_no_more,
    test_security.test_what_one_node_calls_another_serves,
    test_security.test_bring_up_may_call_what_its_steps_ask,
    test_security.test_who_serves_parameters_serves_them_all,
    test_parameters.test_controllers_declare_what_they_are_told_and_are_told_what_they_need,
    test_parameters.test_manager_declares_what_it_is_told,
    test_parameters.test_every_section_belongs_to_a_node_that_runs,
    test_moveit.test_move_group_is_told_all_that_it_needs_and_nothing_that_it_does_not_know,
    test_moveit.test_pipelines_name_plugins_and_adapters_that_exist,
    test_moveit.test_controllers_of_moveit_have_the_joints_of_their_controllers,
    test_moveit.test_limits_of_moveit_are_those_of_the_description,
    test_moveit.test_stages_are_shares_of_the_last_one_for_every_joint,
    test_moveit.test_semantic_description_names_what_exists,
    test_moveit.test_named_states_state_every_joint_of_their_group,
    test_moveit.test_links_that_a_joint_connects_are_never_checked_against_each_other,
    test_agreement.test_attempts_are_logged_with_what_the_chapter_asks_for,
    test_agreement.test_frames_are_where_the_description_has_them,
    test_agreement.test_contract_has_the_limits_of_the_description,
    test_agreement.test_contract_has_the_controllers_of_the_parameter_files,
    test_agreement.test_tolerances_are_those_of_the_spec_for_every_joint,
    test_agreement.test_qos_overrides_are_those_of_the_contract,
    test_agreement.test_recording_has_a_complete_profile_for_each_topic_that_it_records,
    test_agreement.test_drivers_are_told_what_they_declare_and_the_address_of_the_spec,
    test_environment.test_environment_is_the_spec_and_leads_to_files_of_the_package,
    test_environment.test_rviz_knows_every_property_of_its_displays,
    test_environment.test_programs_use_no_name_that_nothing_defines,
    test_environment.test_everything_that_is_read_at_run_time_is_installed,
    test_agreement.test_manifest_names_every_file,
    test_agreement.test_package_has_every_part,
    test_agreement.test_targets_differ_in_their_hardware_alone,
    test_agreement.test_contract_has_limits_calibrations_and_pairs_of_the_other_files,
    test_agreement.test_clocks_and_draws_name_what_the_contract_has,
    test_agreement.test_named_states_are_the_poses_of_the_spec,
    test_environment.test_sources_are_fetched_as_vcs_import_reads_them,
    test_environment.test_usage_of_a_program_has_the_options_that_it_reads_and_files_of_the_package,
    test_environment.test_profiles_reach_the_cards_for_ros_and_no_other,
    test_environment.test_fast_dds_uses_the_transports_that_it_describes,
    test_agreement.test_mock_reads_the_collision_pairs_of_the_semantic_description,
    test_moveit.test_move_group_gets_both_descriptions,
    test_moveit.test_values_are_within_what_their_readers_can_use,
    test_launch.test_plugins_are_of_packages_that_the_manifest_names,
    test_xsd.test_xml_is_what_its_readers_declare,
    test_xsd.test_launch_files_follow_their_grammar,
    test_launch.test_nothing_asks_for_motion_before_a_person_releases_it,
    test_bring_up.test_conditions_name_what_the_cell_has,
    test_bring_up.test_everything_is_activated_once_and_alternates_never,
    test_bring_up.test_launching_takes_every_phase_of_its_target,
    test_bring_up.test_real_target_is_claimed_by_a_person_alone,
    test_bring_up.test_program_takes_the_arguments_that_it_is_launched_with,
    test_walk.test_pages_and_table_have_every_gate_once_and_in_order,
    test_walk.test_table_says_what_the_sections_say_and_leads_to_them,
    test_walk.test_every_gate_leaves_evidence_of_its_own,
    test_walk.test_every_interface_of_the_real_target_has_the_ends_of_the_contract,
    test_walk.test_what_is_read_is_kept_and_what_is_started_is_not,
    test_walk.test_a_gate_stands_once,
    test_walk.test_blocks_are_what_a_shell_takes,
    test_walk.test_commands_name_what_the_cell_has,
    test_walk.test_files_that_commands_read_are_in_the_package,
    test_walk.test_gate_of_enabling_holds_no_command,
    test_walk.test_real_target_is_started_only_after_the_mock_gate_and_motion_last,
    test_walk.test_file_list_of_the_page_is_the_folder,
    test_agreement.test_steps_of_rehearsals_name_what_the_contract_has,
    test_agreement.test_what_a_person_states_is_asked_for_by_a_gate,
    test_scene.scene_follows_the_description,
    test_scene.names_of_a_scene_are_in_it,
    test_drawings.test_pictures_have_the_attributes_and_words_of_svg,
    test_drawings.test_bodies_stand_where_a_frame_is_marked,
    test_drawings.test_every_end_and_every_device_is_one_box,
    test_drawings.test_boxes_stand_apart_within_the_sheet,
    test_drawings.test_the_list_has_every_interface_with_two_ends_and_every_number_is_at_an_arrow,
    test_pictures.test_every_arrow_is_labelled_and_its_text_stays_inside,
    test_pictures.test_boxes_hold_their_names_and_arrows_lie_level,
    test_pictures.test_vendor_control_and_physical_safety_are_bold_and_apart,
    test_pictures.test_arrows_say_what_the_contract_promises,
    test_pages.test_manifest_has_the_version_tuple_of_the_spec,
    test_pages.test_audit_asks_for_every_unknown_and_judges_every_pin,
    test_pages.test_audit_expects_the_interfaces_of_the_contract,
    test_pages.test_audit_names_one_owner_for_each_command_interface,
    test_pages.test_audit_has_the_way_back_that_the_catalogue_knows,
    test_pages.test_audit_says_whose_shapes_each_device_has,
    test_pages.test_confirmations_say_what_a_person_states_by_them,
    test_pages.test_every_way_after_a_loss_leads_back_to_a_gate,
    test_pages.test_gates_have_what_people_do_at_each_device,
    test_pages.test_people_of_the_spec_answer_for_what_it_says,
    test_pages.test_audit_expects_the_nodes_that_are_launched_with_what_they_are_told,
)
_BRING_UP = ("scripts/bring_up", "config/bring_up.json")
_RUNS: tuple[Callable[[StandIn, Path], None], ...] = (
    test_bring_up.test_steps_are_taken_in_the_order_of_their_proofs,
    test_bring_up.test_starting_the_real_target_claims_nothing,
    test_bring_up.test_processes_that_come_up_late_are_waited_for,
    test_bring_up.test_lost_answer_of_a_request_that_was_done_is_no_failure,
    test_bring_up.test_exit_status_of_the_mover_is_passed_on,
)
_observes_computer = test_observe_host.test_emitted_program_compares_this_computer_without_a_graph
_observes_graph = test_observe.test_the_emitted_program_passes_its_package_and_names_a_second_commander
_accepts_versions = test_installed_versions.test_person_accepts_each_part_by_name_and_the_record_has_both
_RUNS_OF_PROGRAMS: dict[str, Callable[[Path], None]] = {
    "scripts/installed_versions.py": _accepts_versions,
    "scripts/first_goal": test_first_goal.test_evidence_holds_command_state_and_error_of_every_joint_and_a_plot,
    "scripts/observe": _observes_graph,
    "scripts/observe_checks.py": _observes_graph,
    "scripts/observe_listener.py": _observes_graph,
    "scripts/observe_reports.py": _observes_graph,
    "scripts/observe_host.py": _observes_computer,
    "config/observe.json": _observes_graph,
    "scripts/claim_watch": lambda _: test_claim_watch.test_a_topic_that_nobody_publishes_any_more_proves_nothing(
        test_claim_watch.FakeRos()
    ),
}
_CHECKS_OF_TARGETS: tuple[Callable[[str, str, str], None], ...] = (
    test_launch.test_spawners_follow_the_spec_and_activate_nothing,
    test_refusals.test_no_emitted_description_is_refused_or_dangerous,
    test_refusals.test_no_emitted_parameter_file_is_refused_or_dangerous,
)


def caught_by(built: Build) -> str:
    """Return the first check that fails on a build, empty where all of them pass."""
    _forget()
    try:
        with in_place(built):
            for check in _CHECKS:
                if _fails(partial(check, _CELL, _DISTRO)):
                    return check.__name__
            for check_of in _CHECKS_OF_TARGETS:
                for target in ("mock", "real"):
                    if _fails(partial(check_of, _CELL, _DISTRO, target)):
                        return check_of.__name__
    finally:
        _forget()
    original = build(_CELL, _DISTRO).texts
    if any(built.texts.get(file) != original[file] for file in _BRING_UP) and _fails(partial(_brought_up, built)):
        return _brought_up.__name__
    for file, run in _RUNS_OF_PROGRAMS.items():
        if built.texts.get(file) != original[file] and _fails(partial(_ran, built, run)):
            return file
    found = verify(built.artifacts, built.graph)
    return found[0].code if found else ""


def _forget() -> None:
    """Forget what was launched from another build of the same cell."""
    starting.processes.cache_clear()
    starting.plan.cache_clear()


def _brought_up(built: Build) -> None:
    """Run the steps of the bring-up, where they are not those that were emitted."""
    with TemporaryDirectory() as folder, in_place(built):
        for check in _RUNS:
            check(test_bring_up.started(), Path(mkdtemp(dir=folder)))


def _ran(built: Build, run: Callable[[Path], None]) -> None:
    """Run a program that is not the one that was emitted."""
    with TemporaryDirectory() as folder, in_place(built):
        run(Path(folder))


def _fails(check: Callable[[], None]) -> bool:
    try:
        check()
    except (Exception, SystemExit, pytest.fail.Exception):  # any way in which a reader stops is a fault that was seen
        return True
    return False


@needs_upstream
def test_build_itself_is_found_without_fault() -> None:
    assert caught_by(build(_CELL, _DISTRO)) == ""


def test_golden_record_sees_every_fault_and_where_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # As `cellc build --check` compares generated/ with what the cells make.
    built = build(_CELL, _DISTRO)
    write(built.artifacts, tmp_path / _CELL)
    sample = list(corruptions(built, _SEED, _SAMPLE))
    seen = [compare(one.of(built).artifacts, tmp_path / _CELL) for one in sample]
    with capsys.disabled():
        print(f"\n{sum(map(bool, seen))} of {len(sample)} single-line faults are seen by the golden record")
    assert [[(found.path, found.line) for found in one] for one in seen] == [[(one.path, one.line)] for one in sample]


@needs_upstream
def test_most_faults_in_single_lines_are_seen_without_a_golden_record(capsys: pytest.CaptureFixture[str]) -> None:
    built = build(_CELL, _DISTRO)
    sample = list(corruptions(built, _SEED, _SAMPLE))
    survivors = [one for one in sample if not caught_by(one.of(built))]
    seen = len(sample) - len(survivors)
    with capsys.disabled():
        print(f"\n{seen} of {len(sample)} single-line faults are seen by parsers, schemas and rules; not seen:")
        for one in survivors:
            new = "missing" if one.new is None else repr(one.new.strip())
            print(f"  {one.path}:{one.line}: {one.old.strip()!r} -> {new}")
    assert seen >= _FLOOR


@pytest.mark.parametrize("emitter", EMITTERS, ids=lambda emitter: emitter.__module__.rpartition(".")[2])
def test_emitter_that_is_left_out_is_missed(emitter: Callable[[CellGraph, Deployment], Iterator[Artifact]]) -> None:
    built = build(_CELL, _DISTRO)
    gone = {artifact.path for artifact in emitter(built.graph, plan_deployment(built.graph))}
    assert gone
    assert gone <= set(built.texts)
    kept = tuple(_without(artifact, gone) for artifact in built.artifacts if artifact.path not in gone)
    assert caught_by(replace(built, artifacts=kept))


def _without(artifact: Artifact, gone: set[str]) -> Artifact:
    """Return an artifact as it were without others: the manifest would not name them."""
    if artifact.path != "manifest.json":
        return artifact
    manifest = json.loads(artifact.text)
    manifest["files"] = {path: digest for path, digest in manifest["files"].items() if path not in gone}
    return replace(artifact, text=json.dumps(manifest, indent=2) + "\n")
