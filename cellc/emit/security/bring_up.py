"""The rights of the bring-up: to see what it waits for, to configure, observe and claim; never to ask for motion."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.deploy.processes import described_by
from cellc.emit.security.profile import Profile
from cellc.emit.security.rights import common_profile
from cellc.link.derived_joint_states import JOINT_STATE_TYPE

# What `ros2 lifecycle get|set`, `ros2 control list_controllers|switch_controllers` and `ros2 param get` call.
_OF_MANAGED = ("change_state", "get_available_transitions", "get_state")
_OF_MANAGER = ("list_controllers", "switch_controller")
_TYPE_DESCRIPTION = (
    "/_ros2cli_*/get_type_description"  # of each tool's own node, named after its process; Iron and later
)


def bring_up_profiles(cell: Cell) -> tuple[Profile, Profile]:
    """Return the rights of the command-line tools and of ``tf2_echo``."""
    common = common_profile(cell)
    managed = (f"{node.full_name}/{one}" for node in cell.nodes if node.lifecycle for one in _OF_MANAGED)
    described = (f"{node}/get_parameters" for node in described_by(cell))
    managers = (f"{one.namespace}/controller_manager/{name}" for one in cell.managers for name in _OF_MANAGER)
    seen = (interface.name for interface in cell.interfaces if interface.type == JOINT_STATE_TYPE)
    tools = Profile(
        namespace="",
        node="bring_up",
        publish=common.publish,
        subscribe=(*common.subscribe, *seen),
        reply=() if cell.distro == "humble" else (_TYPE_DESCRIPTION,),
        request=(*managed, *managers, *described),
    )
    listener = Profile(
        namespace="",
        node="tf2_echo",
        publish=common.publish,
        subscribe=(*common.subscribe, "/tf", "/tf_static"),
        reply=common.reply,
    )
    return tools, listener
