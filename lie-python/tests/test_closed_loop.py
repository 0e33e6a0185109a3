"""A closed loop in Rust and in Python: the same controllers, the same bits. `tests/steps/closed_loop.rs` has them in Rust."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import liepoisson as lp
import pytest

DATA = Path(__file__).parents[2] / "tests" / "data"


def controller(first: int, second: int, momentum: int) -> Any:
    """Proportional and differential: the skew part of the attitude, and the momenta."""

    def torque(t: float, mu: Any, g: Any) -> float:
        skew = float(g[second, first]) - float(g[first, second])
        return 0.3 * skew - 0.8 * float(mu[momentum]) + 0.01 * t

    return torque


@pytest.mark.parametrize(
    ("method", "h"), [("gauss6", 0.05), ("gauss16", 0.1), ("lie-midpoint", 0.025), ("rk4", 0.0625)]
)
def test_the_bits_are_those_of_rust(method: str, h: float) -> None:
    body = lp.load(DATA / "closed_loop.json")
    loops = {"a": controller(1, 2, 0), "b": controller(2, 0, 1), "c": controller(0, 1, 2)}
    run = body.run(method, h=h, t=20, group="matrix", inputs=loops)
    found = []
    for k in range(0, len(run.t), 10):
        numbers = [*run.mu[k], run["a"][k], run["b"][k], run["c"][k]]
        bits = [struct.pack(">d", x).hex() for x in numbers]
        found.append([method, *bits])
    lines = [line.split() for line in (DATA / "closed_loop.txt").read_text().splitlines()]
    expected = [[name, *bits] for name, _, *bits in lines if name == method]
    assert len(expected) > 10 and found == expected
    # they close the loop: the control has no torques
    free = body.run(method, h=h, t=20)
    assert abs(run.mu[-1] - free.mu[-1]).max() > 0.1
