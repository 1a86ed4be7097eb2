"""Rules on addresses, traffic and discovery."""

from __future__ import annotations

from cellc.rules.network import (
    address_in_parameters,
    camera_on_control_card,
    cards_in_one_subnet,
    device_outside_subnet,
    discovery_off,
    discovery_unknown_to_rmw,
    domain_id_out_of_range,
    domain_in_ephemeral_ports,
    duplicate_address,
    localhost_with_several_hosts,
    malformed_address,
    no_route_to_device,
    public_address,
    real_hardware_in_mock,
    robot_off_control_card,
    traffic_on_control_card,
    unicast_without_peers,
    unsuited_kernel,
    unusable_address,
)

RULES = (
    address_in_parameters.RULE,
    camera_on_control_card.RULE,
    cards_in_one_subnet.RULE,
    device_outside_subnet.RULE,
    discovery_off.RULE,
    discovery_unknown_to_rmw.RULE,
    domain_id_out_of_range.RULE,
    domain_in_ephemeral_ports.RULE,
    duplicate_address.RULE,
    localhost_with_several_hosts.RULE,
    malformed_address.RULE,
    no_route_to_device.RULE,
    public_address.RULE,
    real_hardware_in_mock.RULE,
    robot_off_control_card.RULE,
    traffic_on_control_card.RULE,
    unicast_without_peers.RULE,
    unsuited_kernel.RULE,
    unusable_address.RULE,
)
