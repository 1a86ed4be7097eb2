"""What rules compute of tensors and cameras, worked out by hand."""

from __future__ import annotations

import math

import pytest

from cellc.compiler.cell.device import CameraStream, FieldOfView
from cellc.compiler.feasibility import ViewAnswer
from cellc.compiler.rules.frames.cameras import _aside, _out_of_view, _sees
from cellc.compiler.rules.model.links import _impossible
from cellc.contract.transforms import Pose, Vector3, identity
from cellc.robot.description.model import Inertial

NEGATIVE, UNEQUAL = "a principal moment is negative", "one principal moment exceeds the sum of the other two"


@pytest.mark.parametrize(
    ("moments", "products", "reason"),
    [
        # ixx, iyy, izz; ixy, ixz, iyz. Of [[a, p], [p, a]] the principal moments are a - p and a + p.
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), ""),
        ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), "ixx is 0"),
        ((1.0, -2.0, 1.0), (0.0, 0.0, 0.0), "iyy is -2"),
        ((1.0, 1.0, 2.0), (0.0, 0.0, 0.0), ""),  # a flat disk: 2 = 1 + 1
        ((1.0, 1.0, 2.1), (0.0, 0.0, 0.0), UNEQUAL),
        ((2.1, 1.0, 1.0), (0.0, 0.0, 0.0), UNEQUAL),
        ((1.0, 2.1, 1.0), (0.0, 0.0, 0.0), UNEQUAL),
        ((2.0, 2.0, 2.0), (1.0, 0.0, 0.0), ""),  # 1, 3 and 2: 3 = 1 + 2
        ((2.0, 2.0, 2.0), (0.0, 1.1, 0.0), UNEQUAL),  # 0.9, 3.1 and 2
        ((2.0, 2.0, 2.0), (0.0, 0.0, -1.1), UNEQUAL),
        ((2.0, 2.0, 4.0), (2.1, 0.0, 0.0), NEGATIVE),  # -0.1 and 4.1
        ((2.0, 4.0, 2.0), (0.0, 2.1, 0.0), NEGATIVE),
        ((4.0, 2.0, 2.0), (0.0, 0.0, -2.1), NEGATIVE),
        # All off the diagonal p: a + 2p, a - p, a - p. Of 1 and -0.6, -0.2 is negative though no minor of two rows is;
        # of 1 and -0.4, 0.2 and twice 1.4; of 1 and 0.4, 1.8 and twice 0.6, which are 1.2 together.
        ((1.0, 1.0, 1.0), (-0.6, -0.6, -0.6), NEGATIVE),
        ((1.0, 1.0, 1.0), (-0.4, -0.4, -0.4), ""),
        ((1.0, 1.0, 1.0), (0.4, 0.4, 0.4), UNEQUAL),
        ((1.0, 1.0, 1.0), (0.2, 0.2, 0.2), ""),  # 1.4 and twice 0.8
        # Two signs turned around mirror the axes, and one sign does not: the same moments as of -0.6.
        ((1.0, 1.0, 1.0), (0.6, 0.6, -0.6), NEGATIVE),
        ((1.0, 1.0, 1.0), (0.4, 0.4, -0.4), ""),
        # The principal moments 1.5, 4.5 and 2 of products in one plane; then 1.5 + 2 < 4.5.
        ((3.0, 3.0, 2.0), (1.5, 0.0, 0.0), UNEQUAL),
        # Small and large bodies are rounded alike: 0.25 and 2.5 millionths of half of the sum are in excess.
        ((1e-4, 1e-4, 2.000001e-4), (0.0, 0.0, 0.0), ""),
        ((1e-4, 1e-4, 2.00001e-4), (0.0, 0.0, 0.0), UNEQUAL),
        ((100.0, 100.0, 200.0001), (0.0, 0.0, 0.0), ""),
        ((100.0, 100.0, 200.001), (0.0, 0.0, 0.0), UNEQUAL),
        # 1.6, 1.6 and -0.2 of a heavy and of a light body, as above.
        ((1e-4, 1e-4, 1e-4), (-6e-5, -6e-5, -6e-5), NEGATIVE),
        ((1e7, 1e7, 1e7), (-6e6, -6e6, -6e6), NEGATIVE),
    ],
)
def test_inertia_tensor_is_that_of_a_body(
    moments: tuple[float, float, float], products: tuple[float, float, float], reason: str
) -> None:
    (xx, yy, zz), (xy, xz, yz) = moments, products
    assert _impossible(Inertial(identity(), 1.0, xx, xy, xz, yy, yz, zz)) == reason


# 60 by 40 deg, and 15 deg more: seen up to 45 deg to the side and 35 deg above, from 0.5 m to 2 m.
VIEW = FieldOfView(horizontal=math.radians(60), vertical=math.radians(40), nearest_m=0.5, farthest_m=2.0)
ABOVE = math.tan(math.radians(35))


@pytest.mark.parametrize(
    ("place", "wrong"),
    [
        ((0.0, 0.0, 1.0), ""),
        ((0.0, 0.0, -0.25), "0.25 m behind the camera"),
        ((0.1, 0.0, 0.0), "0 m behind the camera"),
        ((0.99, 0.0, 1.0), ""),
        ((-0.99, 0.0, 1.0), ""),
        ((1.01, 0.0, 1.0), "45 deg to the side and 0 deg above or below the axis of a view of 60 by 40 deg"),
        ((0.0, ABOVE - 0.01, 1.0), ""),
        ((0.0, -ABOVE - 0.01, 1.0), "0 deg to the side and 35 deg above or below the axis of a view of 60 by 40 deg"),
        ((0.0, 0.0, 0.5), ""),
        ((0.0, 0.0, 2.0), ""),
        ((0.0, 0.0, 0.4), "0.4 m away, which is not between 0.5 m and 2 m"),
        ((0.9, 1.2, 2.0), "2.5 m away, which is not between 0.5 m and 2 m"),  # 1.5 aside of 2: 3, 4, 5
        ((0.36, 0.48, 0.8), ""),  # 1 m
    ],
)
def test_place_of_an_object_in_the_view_of_a_camera(place: Vector3, wrong: str) -> None:
    assert _out_of_view(ViewAnswer("object", "optical", "home", place), VIEW) == wrong


def test_without_a_field_an_object_must_be_before_the_camera() -> None:
    assert _out_of_view(ViewAnswer("object", "optical", "", (9.0, 0.0, 0.1)), None) == ""
    assert _out_of_view(ViewAnswer("object", "optical", "", (9.0, 0.0, -0.1)), None) == "0.1 m behind the camera"


# At (1, 2, 3), turned by half a turn about x: it looks down, and its y points back.
DOWN = Pose((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("thing", "seen", "seen_without_view"),
    [
        ((1.0, 2.0, 2.0), True, True),
        ((1.0, 2.0, 4.0), False, False),
        ((2.0, 2.0, 3.0), False, False),  # beside it
        ((1.99, 2.0, 2.0), True, True),
        ((2.01, 2.0, 2.0), False, True),
        ((1.0, 2.0 + ABOVE - 0.01, 2.0), True, True),
        ((1.0, 2.0 - ABOVE - 0.01, 2.0), False, True),
        ((1.0, 2.0, 1.0), True, True),
        ((1.0, 2.0, 0.9), False, True),
        ((1.0, 2.0, 2.9), True, True),  # nearer than it sees: that is another rule's
    ],
)
def test_a_camera_sees(thing: Vector3, seen: bool, seen_without_view: bool) -> None:
    for view, expected in ((VIEW, seen), (None, seen_without_view)):
        stream = CameraStream(topic="t", type="i", info_topic="c", frame="f", rate_hz=30.0, view=view)
        assert _sees(stream, DOWN.inverse().apply(thing)) is expected


@pytest.mark.parametrize(
    ("thing", "aside_deg"), [((1.0, 2.0, 1.0), 0.0), ((2.0, 2.0, 2.0), 45.0), ((1.0, 1.0, 3.0), 90.0)]
)
def test_angle_between_the_axis_of_a_camera_and_a_place(thing: Vector3, aside_deg: float) -> None:
    assert math.degrees(_aside(DOWN.inverse().apply(thing))) == pytest.approx(aside_deg)
