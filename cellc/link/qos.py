"""Quality of service: the profile of each kind of endpoint, and what the spec changes in it."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.catalog.device_interfaces import QosFacts, QosUse
from cellc.catalog.tables import QosTable, Rmw, SystemDefault
from cellc.cell.interface import Qos
from cellc.spec.interfaces import QosSpec
from cellc.spec.quantity import Quantity

# rmw/qos_profiles.h: default and services_default are alike in every policy that is matched.
DEFAULT = Qos(reliability="reliable", durability="volatile", history="keep_last", depth=10)
SENSOR_DATA = Qos(reliability="best_effort", durability="volatile", history="keep_last", depth=5)
# robot_state_publisher and controller_manager, robot_description: latched.
LATCHED = Qos(reliability="reliable", durability="transient_local", history="keep_last", depth=1)
# tf2_ros/qos.hpp: dynamic broadcaster and listener, static broadcaster and listener.
TF = Qos(reliability="reliable", durability="volatile", history="keep_last", depth=100)
TF_STATIC_LISTENER = Qos(reliability="reliable", durability="transient_local", history="keep_last", depth=100)


def with_changes(profile: Qos, written: QosSpec) -> Qos:
    """Return the profile with the policies that the user wrote in place of its own."""
    return Qos(
        reliability=written.reliability or profile.reliability,
        durability=written.durability or profile.durability,
        history=written.history or profile.history,
        depth=profile.depth if written.depth is None else written.depth,
        deadline_s=_seconds(written.deadline, profile.deadline_s),
        lifespan_s=_seconds(written.lifespan, profile.lifespan_s),
        liveliness=written.liveliness or profile.liveliness,
        lease_duration_s=_seconds(written.lease_duration, profile.lease_duration_s),
    )


def _seconds(written: Quantity | None, default: float | None) -> float | None:
    return default if written is None else written.si


@dataclass(frozen=True, slots=True)
class QosResolver:
    """Turns a catalogue profile into what an endpoint really offers on the cell's middleware."""

    table: QosTable
    rmw: Rmw

    def writer(self, use: QosUse) -> Qos:
        """Return the profile of a publisher; what is left to the system is what the RMW makes of it."""
        return self._resolve(use, self.table.system_default[self.rmw].writer)

    def reader(self, use: QosUse) -> Qos:
        """Return the profile of a subscription; Fast DDS reads best effort where it writes reliably."""
        return self._resolve(use, self.table.system_default[self.rmw].reader)

    def _resolve(self, use: QosUse, system: SystemDefault) -> Qos:
        if isinstance(use, QosFacts):
            return Qos(reliability=use.reliability, durability=use.durability, history=use.history, depth=use.depth)
        profile = self.table.profiles[use]
        open_history = profile.history == "system_default"
        return Qos(
            reliability=_decided(profile.reliability, system.reliability),
            durability=_decided(profile.durability, system.durability),
            history="keep_last" if open_history else profile.history,
            depth=system.depth if open_history else max(1, profile.depth),
            lifespan_s=None if profile.lifespan is None else profile.lifespan.si,
        )


def _decided(setting: str, system: str) -> str:
    """Return the setting, or what the middleware makes of one that is left open."""
    return system if setting in ("system_default", "best_available") else setting
