//! A body in five dimensions and where it starts.

use lie_runtime::prelude::lie_poisson;

lie_poisson! {
    /// A free rigid body in five dimensions, the basis in no order and with other signs.
    pub system FiveBody;
    algebra {
        basis p, q, r, s, o, u, v, w, y, z;
        [p, o] = -u; [p, u] = o; [p, v] = w; [p, w] = -v; [p, y] = z; [p, z] = -y;
        [q, r] = s; [q, s] = -r; [q, o] = -v; [q, u] = w; [q, v] = o; [q, w] = -u;
        [r, s] = q; [r, v] = -y; [r, w] = -z; [r, y] = v; [r, z] = w; [s, o] = -y;
        [s, u] = z; [s, y] = o; [s, z] = -u; [o, u] = -p; [o, v] = -q; [o, y] = -s;
        [u, w] = q; [u, z] = s; [v, w] = p; [v, y] = -r; [w, z] = -r; [y, z] = p;
    }
    state mp, mq, mr, ms, mt, mu, mv, mw, my, mz;
    parameters { J1 = 0.9; J2 = 0.7; J3 = 0.5; J4 = 0.4; J5 = 0.6; }
    hamiltonian = mp^2/(2*(J4 + J5)) + mq^2/(2*(J1 + J2)) + mr^2/(2*(J2 + J3)) + ms^2/(2*(J1 + J3))
        + mt^2/(2*(J1 + J4)) + mu^2/(2*(J1 + J5)) + mv^2/(2*(J2 + J4)) + mw^2/(2*(J2 + J5))
        + my^2/(2*(J3 + J4)) + mz^2/(2*(J3 + J5));
    casimir norm2 = mp^2 + mq^2 + mr^2 + ms^2 + mt^2 + mu^2 + mv^2 + mw^2 + my^2 + mz^2;
}

pub const FIVE: [f64; 10] = [0.3, -0.2, 0.4, 0.1, 0.5, -0.3, 0.2, 0.6, -0.1, 0.35];
