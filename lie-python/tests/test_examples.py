"""The examples for many processes: the same bits with 1, 2 and 4 workers, and where one of them is killed."""

from __future__ import annotations

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig

import numpy as np
import pytest

EXAMPLES = pathlib.Path(__file__).parents[1] / "examples"
#: Each engine: the modules that it needs.
ENGINES = {"futures": [], "dask": ["dask", "distributed"], "ray": ["ray"], "mpi": ["mpi4py"]}


def launcher() -> str | None:
    beside = pathlib.Path(sysconfig.get_path("scripts")) / "mpirun"
    return str(beside) if beside.exists() else shutil.which("mpirun")


def call(engine: str, workers: int, out: pathlib.Path, flag: str = "") -> int:
    script = [sys.executable, str(EXAMPLES / f"with_{engine}.py")]
    if engine == "mpi":
        command = [str(launcher()), "-n", str(workers), *script, str(out)]
    else:
        command = [*script, str(workers), str(out)]
    environment = {**os.environ, "LIE_KILL": flag, "PYTHONPATH": str(EXAMPLES)}
    return subprocess.run(
        command, check=False, env=environment, timeout=240, capture_output=True
    ).returncode


@pytest.mark.parametrize("engine", ENGINES)
def test_the_same_bits_on_any_number_of_workers(engine: str, tmp_path: pathlib.Path) -> None:
    missing = [name for name in ENGINES[engine] if importlib.util.find_spec(name) is None]
    if missing or (engine == "mpi" and launcher() is None):
        pytest.skip(f"{engine} is not installed: {', '.join(missing) or 'mpirun'}")
    sys.path.insert(0, str(EXAMPLES))
    import body

    expected = body.BODY.ensemble(body.STARTS, "gauss4", h=0.1, t=10, threads=1).mu
    for workers in (1, 2, 4):
        out = tmp_path / f"{workers}.npy"
        assert call(engine, workers, out) == 0
        assert np.array_equal(np.load(out), expected), workers
    # a worker kills itself in the middle of a share
    flag, out = tmp_path / "kill", tmp_path / "killed.npy"
    flag.touch()
    code = call(engine, 2, out, str(flag))
    assert not flag.exists(), "nobody was killed"
    if engine == "mpi":
        assert code != 0 and not out.exists()
        code = call(engine, 2, out)
    assert code == 0
    assert np.array_equal(np.load(out), expected)
