//! A pair of coordinates that disagrees with itself, and a coordinate that does not exist.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    poisson { {x, y} = z^2; {x, v} = z; {y, x} = z^2; {w, w} = x; }
    state x, y, z, w;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    methods = [midpoint];
}

// Whoever uses the type hears of nothing else.
fn main() {
    let mut body = Body::new();
    body.I1 = 3.0;
    let system = body.system().expect("finite constants");
    let problem = Problem::new(system, [1.0, 0.0, 0.5, 0.0], (0.0, 1.0));
    let solution = solve(&problem, ImplicitMidpoint, &Options::new(0.1)).expect("a solution");
    let single = Body::<f32>::default().system().expect("finite constants");
    let mut velocity = single.zero_state();
    single.vector_field(&single.zero_state(), &mut velocity);
    println!("{} {:?} {:?}", body.I2, solution.last(), solution.drift());
}
