"""The types of the package, as a user's program meets them under mypy --strict."""

from __future__ import annotations

import pathlib
import subprocess
import sys

import pytest

PROGRAM = """
import liepoisson as lp
import numpy as np
import numpy.typing as npt

body = lp.System(
    algebra="so(3)",
    state=["x", "y", "z"],
    parameters={"I1": 2},
    hamiltonian="x^2/(2*I1) + y^2/4 + z^2/6",
    initial=[0.8, 0.1, 0.6],
)
run: lp.Solution = body.run("gauss4", h=0.1, t=1, I1=3)
column: npt.NDArray[np.float64] = run["x"]
drift: dict[str, float] = run.drift
f: lp.Function = body.function("vector_field")
slope: npt.NDArray[np.float64] = f(run.mu)


def tell(done: int, total: int, what: str) -> None:
    print(f"{what}: {done} of {total}")


found = body.ensemble(np.ones((10, 3)), "rk4", h=0.1, t=1, progress=tell, I1=np.linspace(1, 2, 10))
times: list[float] = [time for _, time, _ in found.failures]
try:
    limits = body.stress("rk4", steps=1000, progress=tell)
except lp.Interrupted as stopped:
    limits = stopped.partial
names: list[str] = [cell.method for cell in limits.cells if cell.outcome != "kept"]
kernels: dict[str, float] | None = body.verify("rk4").kernels
seconds: float = body.bench("rk4", t=1, budget=0.01).fastest(1e-6)[0].seconds
reason: str | None = body.methods()["rk4"].reason
rank: int = body.check().generic_rank
divergence: float = body.exponents("rk4", h=0.1, t=10).sum
diffusion: float = body.run("rk4", h=0.1, t=10).frequencies("x").lines[0].drift
"""


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("", None),
        ("step: str = run.step\n", "Incompatible types in assignment"),
        ("body.verify(1)\n", "incompatible type"),
        ("body.stress('rk4', progress=3)\n", "incompatible type"),
        ("body.run('rk4', every='2')\n", "incompatible type"),
    ],
)
def test_a_program_of_a_user(tmp_path: pathlib.Path, wrong: str, message: str | None) -> None:
    pytest.importorskip("mypy")
    file = tmp_path / "program.py"
    file.write_text(f"from __future__ import annotations\n{PROGRAM}{wrong}")
    call = [sys.executable, "-m", "mypy", "--strict", f"--cache-dir={tmp_path.parent}", str(file)]
    found = subprocess.run(call, capture_output=True, text=True, check=False)
    if message is None:
        assert found.returncode == 0, found.stdout
    else:
        assert found.returncode == 1 and message in found.stdout, found.stdout
