//! The discrete rigid body of Moser and Veselov in axes that are not those of the moments: the same steps, turned.

use lie_runtime::methods::Method;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

lie_poisson! {
    /// A free body in the axes of its moments.
    pub system Upright;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4;
    methods = [moser-veselov];
}

lie_poisson! {
    /// The same, turned by the rows (2, -2, 1), (1, 2, 2) and (-2, -1, 2) of length 3.
    pub system Tilted;
    algebra = so(3);
    state x, y, z;
    hamiltonian = (2*x + y - 2*z)^2/36 + (2*y - 2*x - z)^2/18 + (x + 2*y + 2*z)^2/12;
    methods = [moser-veselov];
}

fn turned([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        2.0 * x - 2.0 * y + z,
        x + 2.0 * y + 2.0 * z,
        2.0 * z - 2.0 * x - y,
    ]
    .map(|entry| entry / 3.0)
}

/// The state after so many steps, and the largest change of the energy.
fn after<P>(
    system: &P,
    method: &impl Method<f64, P>,
    start: [f64; 3],
    (h, steps): (f64, usize),
) -> ([f64; 3], f64)
where
    P: Poisson<f64>,
    P::State: From<[f64; 3]>,
{
    let mut state = P::State::from(start);
    let (energy, mut change) = (system.energy(&state), 0.0_f64);
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut state, &mut ()).expect("a step");
        change = change.max((system.energy(&state) - energy).abs());
    }
    let entries = state.as_slice();
    ([entries[0], entries[1], entries[2]], change)
}

#[test]
fn steps_in_tilted_axes_are_tilted_steps() {
    let (upright, tilted) = (Upright::new().system(), Tilted::new().system());
    let (upright, tilted) = (upright.expect("constants"), tilted.expect("constants"));
    let start = [0.4, 0.9, -0.3];
    for h in [0.1, 0.3, 0.5] {
        let (end, _) = after(&upright, &MoserVeselov, start, (h, 200));
        let (other, change) = after(&tilted, &MoserVeselov, turned(start), (h, 200));
        let off = |end: [f64; 3]| {
            let pairs = turned(end).into_iter().zip(other);
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(off(end) < 1e-13, "{h}: {:e}", off(end));
        assert!(change < 1e-14, "{h}: {change:e}");
        let (control, _) = after(&upright, &LieMidpoint::exp(), start, (h, 200));
        assert!(off(control) > 1e-5, "{h}: {:e}", off(control));
    }
}
