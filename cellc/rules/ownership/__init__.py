"""Rules on who commands and who answers."""

from __future__ import annotations

from cellc.rules.ownership import (
    controller_without_client,
    direct_sdk_without_adapter,
    direct_sdk_without_bounded_command,
    double_claim,
    double_claim_after_switch,
    group_joints_without_controller,
    group_without_controller,
    idle_controller,
    impossible_switch,
    missing_approval,
    missing_responsibility,
    node_without_owner,
    scripted_servo_loop,
    second_action_server,
    second_command_publisher,
    second_commander,
    unprovided_command_interface,
)

RULES = (
    controller_without_client.RULE,
    direct_sdk_without_adapter.RULE,
    direct_sdk_without_bounded_command.RULE,
    double_claim.RULE,
    double_claim_after_switch.RULE,
    group_joints_without_controller.RULE,
    group_without_controller.RULE,
    idle_controller.RULE,
    impossible_switch.RULE,
    missing_approval.RULE,
    missing_responsibility.RULE,
    node_without_owner.RULE,
    scripted_servo_loop.RULE,
    second_action_server.RULE,
    second_command_publisher.RULE,
    second_commander.RULE,
    unprovided_command_interface.RULE,
)
