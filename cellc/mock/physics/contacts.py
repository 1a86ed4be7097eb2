"""Bodies that pressed on each other and are not to touch, as lines for people."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.contract.frozen import dataclass
from cellc.mock.physics.dynamics import Seen


@dataclass(frozen=True, slots=True)
class Pressed:
    """Two bodies that are not to touch, with the largest force between them."""

    one: str
    other: str
    first_ns: int
    most_n: float

    def __str__(self) -> str:
        names = f"{self.one} and {self.other} press on each other"
        return f"{names} from {self.first_ns / 1e9:.3f} s on, with up to {self.most_n:.3g} N"


def pressed(seen: Iterable[Seen], since_ns: int) -> Iterator[Pressed]:
    """Yield what pressed on what since an instant, in the order of time."""
    found: dict[tuple[str, str], Pressed] = {}
    for each in seen:
        if each.stamp_ns > since_ns:
            one, other = sorted((each.touch.one, each.touch.other))
            before = found.get((one, other))
            first_ns = each.stamp_ns if before is None else before.first_ns
            most_n = max(each.touch.force_n, 0.0 if before is None else before.most_n)
            found[one, other] = Pressed(one, other, first_ns, most_n)
    yield from found.values()
