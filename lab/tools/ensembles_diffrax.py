"""Many trajectories by diffrax, for `ensembles_at_errors.py`, in an environment of its own: pip install diffrax numpy.

Reads requests as lines of JSON, {"system", "starts": FILE.npy, "until", "solver", "tolerance", "ends": FILE.npy}, and answers with the seconds that
the processor took, the compilation left out.
"""

import json
import os
import sys
import time

# before JAX is loaded
os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1")
os.environ.setdefault("JAX_ENABLE_X64", "1")
os.environ.setdefault("JAX_PLATFORMS", "cpu")

import diffrax
import jax
import jax.numpy as jnp
import numpy as np

# members at a time: all of them make as many steps as the slowest
GROUP = 64


def body(_, y, coefficients):
    a, b, c = coefficients
    return jnp.stack([a * y[1] * y[2], b * y[2] * y[0], c * y[0] * y[1]])


def top(_, y, coefficients):
    inertia, pull = coefficients
    momentum, vertical = y[:3], y[3:]
    omega = momentum / inertia
    return jnp.concatenate([jnp.cross(momentum, omega) + jnp.cross(vertical, pull), jnp.cross(vertical, omega)])


FIELDS = {"body": body, "top": top}
_compiled = {}


def solver(request):
    key = (request["system"], request["solver"], request["tolerance"], request["until"], json.dumps(request["coefficients"]))
    if key in _compiled:
        return _compiled[key]
    coefficients = [jnp.asarray(c) for c in request["coefficients"]]
    term = diffrax.ODETerm(FIELDS[request["system"]])
    method = getattr(diffrax, request["solver"])()
    control = diffrax.PIDController(rtol=request["tolerance"], atol=request["tolerance"])

    def one(start):
        solution = diffrax.diffeqsolve(
            term, method, 0.0, request["until"], None, start, args=coefficients, stepsize_controller=control,
            saveat=diffrax.SaveAt(t1=True), max_steps=None, adjoint=diffrax.ForwardMode(),
        )  # fmt: skip
        return solution.ys[-1]

    many = jax.jit(lambda starts: jax.lax.map(jax.vmap(one), starts))
    _compiled[key] = many
    return many


def main():
    for line in sys.stdin:
        request = json.loads(line)
        starts = np.load(request["starts"])
        groups = jnp.asarray(starts.reshape(-1, GROUP, starts.shape[1]))
        run = solver(request).lower(groups).compile()
        begun = (time.process_time(), time.perf_counter())
        ends = np.asarray(run(groups))
        seconds = time.process_time() - begun[0], time.perf_counter() - begun[1]
        np.save(request["ends"], ends.reshape(starts.shape))
        print(json.dumps(seconds), flush=True)


if __name__ == "__main__":
    main()
