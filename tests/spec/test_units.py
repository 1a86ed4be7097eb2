"""Every unit of every dimension, and the bounds of every quantity and text, both by hand."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from pydantic_core import PydanticCustomError

from cellc.compiler.output.write import write
from cellc.compiler.pipeline import check, emit_cell
from cellc.compiler.spec import quantity
from cellc.compiler.spec.quantity import Dimension, Quantity, QuantityType
from cellc.mock.cell import read_to_run
from tests.cells import spec_text, written
from tests.spec.reading import ARM, HEAD, parsed

_TURN = math.pi / 180.0
SI: dict[str, tuple[dict[str, float], float]] = {
    "LENGTH": ({"mm": 1e-3, "cm": 1e-2, "m": 1.0, "um": 1e-6}, 1e5),
    "ANGLE": ({"deg": _TURN, "rad": 1.0}, 1e5),
    "DURATION": ({"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}, 4e9),
    "FREQUENCY": ({"Hz": 1.0, "kHz": 1e3, "MHz": 1e6}, 1e6),
    "DATA_RATE": ({"bit/s": 1.0, "kbit/s": 1e3, "Mbit/s": 1e6, "Gbit/s": 1e9}, 1e13),
    "MASS": ({"kg": 1.0, "g": 1e-3}, 1e5),
    "RATIO": ({"%": 1e-2}, 100.0),
    "DRIFT": ({"ppm": 1e-6}, 1.0),
    "FORCE": ({"N": 1.0, "kN": 1e3}, 1e6),
    "TORQUE": ({"N m": 1.0}, 1e5),
    "INERTIA": ({"kg m^2": 1.0, "g m^2": 1e-3}, 1e5),
    "VOLTAGE": ({"V": 1.0}, 1e4),
    "STIFFNESS": ({"N/m": 1.0, "N/mm": 1e3}, 1e8),
    "ANGULAR_STIFFNESS": ({"N m/rad": 1.0}, 1e8),
    "ANGULAR_DAMPING": ({"N m s/rad": 1.0}, 1e8),
    "VELOCITY": ({"m/s": 1.0, "mm/s": 1e-3}, 1e4),
    "ACCELERATION": ({"m/s^2": 1.0, "mm/s^2": 1e-3}, 1e6),
    "JERK": ({"m/s^3": 1.0, "mm/s^3": 1e-3}, 1e8),
    "ANGULAR_VELOCITY": ({"deg/s": _TURN, "rad/s": 1.0}, 1e5),
    "ANGULAR_ACCELERATION": ({"deg/s^2": _TURN, "rad/s^2": 1.0}, 1e7),
    "ANGULAR_JERK": ({"deg/s^3": _TURN, "rad/s^3": 1.0}, 1e9),
}
_LINEAR = {"LENGTH", "VELOCITY", "ACCELERATION", "JERK", "FORCE"}


def _dimension(name: str) -> Dimension:
    found = getattr(quantity, name)
    assert isinstance(found, Dimension)
    return found


def _read(name: str, text: str) -> Quantity:
    read = QuantityType((_dimension(name),), "an example").read(text)
    assert isinstance(read, Quantity)
    return read


def test_every_dimension_is_in_the_table() -> None:
    assert {name for name, one in vars(quantity).items() if isinstance(one, Dimension)} == set(SI)


@pytest.mark.parametrize("name", SI)
def test_one_of_each_unit_in_si_and_the_largest_that_is_read(name: str) -> None:
    units, largest = SI[name]
    assert {unit: _read(name, f"1 {unit}").si for unit, _ in _dimension(name).units} == pytest.approx(units, rel=1e-15)
    for unit, factor in units.items():
        read = _read(name, f"-0.25 {unit}")
        assert read.si == pytest.approx(-0.25 * factor)
        assert (read.unit, read.linear) == (unit, name in _LINEAR)
    one = next(unit for unit, factor in units.items() if factor == max(units.values()))
    count = largest / units[one]
    for sign in (1.0, -1.0):
        assert _read(name, f"{sign * count * (1.0 - 1e-9):.12g} {one}").si == pytest.approx(sign * largest, rel=1e-8)
        with pytest.raises(PydanticCustomError, match="must be between"):
            _read(name, f"{sign * count * (1.0 + 1e-9):.12g} {one}")


def test_decimal_values_are_the_nearest_to_what_was_written() -> None:
    assert (_read("LENGTH", "162 mm").si, _read("LENGTH", "0.1 cm").si) == (0.162, 0.001)


CONTROL = "control: {{update_rate: {}, controllers: {{states: {{type: joint_state_broadcaster}}}}}}\n"
ACTION = "interfaces: {{/move: {{action: a/action/B, server: x, client: y, timeout: {}}}}}\n"
TOPIC = "interfaces: {{/pose: {{topic: a/msg/B, from: x, to: y, rate: {}}}}}\n"
FRAME = "frames: {{part: {{parent: world, xyz: {}}}}}\n"
PAYLOAD = "devices: {{arm: {{model: ur5e, payload: {{mass: {}, center_of_mass: 0 0 0 m}}}}}}\n"
QUEUE = "interfaces: {{/pose: {{topic: a/msg/B, from: {{x: {{depth: {}}}}}, to: y}}}}\n"
FAULT = "rehearsals: {{late: {{inject: {{jump_clock: ros, by: {}, at: 1 s}}}}}}\n"
RATE = "rehearsals: {{pick: {{steps: [{{wait: 1 s}}], success: {}}}}}\n"
SURE = "rehearsals: {{pick: {{steps: [{{wait: 1 s}}], success: 99 %, confidence: {}}}}}\n"
TOLERANCE = "uncertainty: {{tolerances: {{pick: {}}}}}\n"
REGION = "regions: {{part: {{box: {}}}}}\n"
KPI = "kpis: {{stale_state_rejection: {}}}\n"
SCALE = "rehearsals: {{slow: {{inject: {{scale_speed: arm, to: {}, at: 1 s}}}}}}\n"
SLOW = "rehearsals: {{slow: {{inject: {{slow: arm/elbow_joint, to: {}, at: 1 s}}}}}}\n"
WITHIN = "devices: {{door: {{model: digital_io, switching: {{within: {}}}}}}}\n"
TIMEOUT = "rehearsals: {{slow: {{timeout: {}}}}}\n"
_MOTION = "{{joint: a/j, direction: -, max_delta: %s, velocity: %s, timeout: 1 s, stop_if: [a]}}"
_FIRST = f"bringup: {{{{first_motion: {_MOTION}}}}}\n"
FIRST_WAY, FIRST_SPEED = _FIRST % ("{}", "5 deg/s"), _FIRST % ("5 deg", "{}")
PARAMETER = "nodes: {{task: {{run: a/b, parameters: {{p: {}}}}}}}\n"


def _found(text: str, folder: Path) -> list[tuple[str, str]]:
    head = HEAD if text.startswith("devices") else HEAD + ARM
    return [(diagnostic.code, diagnostic.message) for diagnostic in parsed(head + text, folder).diagnostics]


@pytest.mark.parametrize(
    ("section", "written", "bounds"),
    [
        # ros2_control's update_rate is an integer in Hz, so that less than one is none at all.
        (CONTROL, "0 Hz", "between 1 and 1000000 Hz"),
        (CONTROL, "0.3 Hz", "between 1 and 1000000 Hz"),
        (CONTROL, "-1 Hz", "between 1 and 1000000 Hz"),
        (CONTROL, "1e9 Hz", "between 1 and 1000000 Hz"),
        (CONTROL, "0 kHz", "between 0.001 and 1000 kHz"),
        (TOPIC, "0 Hz", "between 0.0001 and 1000000 Hz"),
        (TOPIC, "1e-99 Hz", "between 0.0001 and 1000000 Hz"),
        (ACTION, "-1 s", "between 0 and 1000000 s"),
        (ACTION, "1e99 h", "between 0 and 278 h"),
        (FRAME, "0 0 1e9 m", "between -100000 and 100000 m"),
        (FRAME, "0 1e99 0 mm", "between -100000000 and 100000000 mm"),
        (PAYLOAD, "-1 kg", "between 0 and 100000 kg"),
        (PAYLOAD, "1e99 g", "between 0 and 100000000 g"),
        (FAULT, "1e10 s", "between -4000000000 and 4000000000 s"),
        # The lower end of an interval never reaches 1, however many runs succeed.
        (RATE, "100 %", "between 0 and 99.9999 %"),
        (SURE, "100 %", "between 50 and 99.99 %"),
        (TOLERANCE, "0 mm", "between 0.001 and 100000000 mm"),
        (TOLERANCE, "0.0000004 mm", "between 0.001 and 100000000 mm"),
        (REGION, "-80 80 0 mm", "between 0 and 100000000 mm"),
        # A share is of a whole, and what goes with no speed takes time without end.
        (KPI, "101 %", "between 0 and 100 %"),
        (KPI, "-1 %", "between 0 and 100 %"),
        (SCALE, "101 %", "between 0 and 100 %"),
        (SLOW, "0 rad/s", "between 1e-06 and 100000 rad/s"),
        (SLOW, "-2 rad/s", "between 1e-06 and 100000 rad/s"),
        (FIRST_SPEED, "0 rad/s", "between 1e-06 and 100000 rad/s"),
        (FIRST_SPEED, "-1 rad/s", "between 1e-06 and 100000 rad/s"),
        (FIRST_WAY, "0 rad", "between 1e-06 and 100000 rad"),
        (FIRST_WAY, "-1 rad", "between 1e-06 and 100000 rad"),
        (WITHIN, "0 s", "between 1e-06 and 1000000 s"),
        (TIMEOUT, "0 s", "between 1e-06 and 1000000 s"),
    ],
)
def test_quantity_out_of_the_bounds_of_its_kind_is_refused(
    section: str, written: str, bounds: str, tmp_path: Path
) -> None:
    ((code, message),) = _found(section.format(written), tmp_path)
    assert code == "out-of-range"
    assert message.endswith(f" must be {bounds}, got `{written}`")


@pytest.mark.parametrize(
    ("section", "written"),
    [(CONTROL, "1 Hz"), (TOPIC, "0.1 Hz"), (ACTION, "0 s"), (FRAME, "0 0 -99 m"), (FAULT, "-1 s")],
)
def test_quantity_within_the_bounds_of_its_kind_is_taken(section: str, written: str, tmp_path: Path) -> None:
    assert _found(section.format(written), tmp_path) == []


@pytest.mark.parametrize(
    ("before", "extreme"),
    [
        ("missed_cycles: 0", "missed_cycles: 2147483647"),
        ("protective_stops: 0", "protective_stops: 2147483647"),
        ("hand_eye: {revision: 4", "hand_eye: {revision: 2147483647"),
        ("{task: {reliability: reliable, depth: 1}}", "{task: {reliability: reliable, depth: 2147483647}}"),
        ("    rate: 10 Hz\n    buffer", "    rate: 0.0001 Hz\n    buffer"),
        ("place: 3 mm}", "place: 0.001 mm}"),
    ],
)
def test_what_a_check_takes_at_its_bound_the_mock_reads(before: str, extreme: str, tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert text.count(before) == 1
    emitted = emit_cell(check(written(tmp_path, text.replace(before, extreme))))
    assert emitted.value is not None, extreme
    write(emitted.value, tmp_path / "package")
    assert read_to_run(tmp_path / "package").contract.cell == "ur5e_pick"


def test_count_that_no_system_can_hold_is_refused(tmp_path: Path) -> None:
    assert _found(QUEUE.format(2**31 - 1), tmp_path) == []
    ((code, message),) = _found(QUEUE.format(2**31), tmp_path)
    assert (code, message.endswith("must be at most 2147483647, got `2147483648`")) == ("out-of-range", True)


@pytest.mark.parametrize(
    "written", ["[1, -2]", "[1.0, .inf]", "[true, false]", "[a, b]", "[]", ".inf", "9223372036854775807"]
)
def test_parameter_is_a_scalar_or_a_list_of_one_type(written: str, tmp_path: Path) -> None:
    assert _found(PARAMETER.format(written), tmp_path) == []


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        # rcl_yaml_param_parser: "Sequence should be of same type".
        ("[1, 2.5]", "expected a whole number for `nodes.task.parameters.p[1]`, got the number `2.5`"),
        ("[true, 1]", "expected `true` or `false` for `nodes.task.parameters.p[1]`, got the number `1`"),
        ("[a, 1]", "expected text for `nodes.task.parameters.p[1]`, got the number `1`"),
        ("[[1]]", "expected text for `nodes.task.parameters.p[0]`, got a list"),
        ("[.nan]", "expected a number other than `.nan` for `nodes.task.parameters.p[0]`, got the number `.nan`"),
        (".nan", "expected a number other than `.nan` for `nodes.task.parameters.p`, got the number `.nan`"),
    ],
)
def test_list_of_several_types_and_no_number_are_refused(written: str, expected: str, tmp_path: Path) -> None:
    assert _found(PARAMETER.format(written), tmp_path) == [("wrong-type", expected)]
