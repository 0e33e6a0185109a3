//! A discrete Lagrangian whose action does not go with the step, beside a method for Lagrangians.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    velocity u, v, w;
    discrete_lagrangian = (I1*u^2 + I2*v^2 + I3*w^2)/(2*h^2);
    methods = [discrete-euler-poincare];
}

// Whoever uses the type hears of nothing else.
fn main() {
    let mut body = Body::new();
    body.I1 = 3.0;
    let system = body.system().expect("finite constants");
    let mut slope = system.zero_state();
    system.discrete_slope(0.1, &system.zero_state(), &mut slope);
    system.momentum(&system.zero_state(), &mut slope);
    println!("{}", system.lagrangian(&slope));
    let problem = Problem::new(system, [1.0, 0.0, 0.5], (0.0, 1.0));
    let options = Options::new(0.1);
    let solution = solve(&problem, DiscreteEulerPoincare::exp(), &options).expect("a solution");
    let other = solve(&problem, Variational4::exp(), &options).expect("a solution");
    println!("{:?} {:?}", solution.last(), other.last());
}
