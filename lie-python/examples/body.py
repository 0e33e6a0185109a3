"""What all workers compute: a share of 4,000 rigid bodies. Systems and shares are pickled; each share is the same wherever it runs."""

import os
import signal

import liepoisson as lp
import numpy as np

BODY = lp.System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
STARTS = np.random.default_rng(2018).normal(size=(4000, 3))
SHARES = [(k, k + 500) for k in range(0, 4000, 500)]


def ends(share):
    """The ends of a share. A worker that finds the file LIE_KILL removes it and kills itself: the others go on."""
    flag = os.environ.get("LIE_KILL", "")
    if share[0] == 1000 and flag and os.path.exists(flag):
        os.remove(flag)
        os.kill(os.getpid(), signal.SIGKILL)
    return BODY.ensemble(STARTS[slice(*share)], "gauss4", h=0.1, t=10, threads=1).mu
