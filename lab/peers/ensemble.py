"""Case C: many free rigid bodies; their reference by heyoka in long double."""

import heyoka as hy
import numpy as np


def equations():
    x, y, z = hy.make_vars("x", "y", "z")
    return [(x, 0.5 * y * z), (y, -z * x), (z, 0.5 * x * y)]


def reference(start, until):
    """The state of each body at the end."""
    wide = np.longdouble
    integrator = hy.taylor_adaptive(equations(), start[0].astype(wide), fp_type=wide, tol=wide(1e-20))
    ends = np.empty_like(start)
    for body, end in zip(start, ends):
        integrator.time = wide(0)
        integrator.state[:] = body.astype(wide)
        integrator.propagate_until(wide(until))
        end[:] = integrator.state.astype(float)
    return ends
