//! A path of the runtime that is none.

use lie_runtime::prelude::*;

lie_poisson! {
    crate = my-crate::lie_runtime;
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    hamiltonian = x^2 + z^2/2;
}

// Whoever uses the type hears of nothing else.
fn main() {
    let system = Body::new().system().expect("finite constants");
    let problem = Problem::new(system, [1.0, 0.0, 0.5], (0.0, 1.0));
    let solution = solve(&problem, LieMidpoint::exp(), &Options::new(0.1)).expect("a solution");
    println!("{:?}", solution.last());
}
