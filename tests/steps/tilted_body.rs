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

lie_poisson! {
    /// A free body in four dimensions, in the axes of its moments 9/10, 7/10, 1/2 and 2/5.
    pub system UprightOfFour;
    algebra = so(4);
    state m12, m13, m14, m23, m24, m34;
    hamiltonian = m12^2/(16/5) + m13^2/(14/5) + m14^2/(13/5) + m23^2/(12/5) + m24^2/(11/5) + m34^2/(9/5);
    methods = [moser-veselov];
}

lie_poisson! {
    /// The same, turned in the plane of the second and the third axis, and then in those of the first two and of the last two.
    pub system TiltedOfFour;
    algebra = so(4);
    state m12, m13, m14, m23, m24, m34;
    let n13 = (3*(5*m13 + 12*m14) + 4*(5*m23 + 12*m24))/65;
    let n14 = (3*(5*m14 - 12*m13) + 4*(5*m24 - 12*m23))/65;
    let n23 = (3*(5*m23 + 12*m24) - 4*(5*m13 + 12*m14))/65;
    let n24 = (3*(5*m24 - 12*m23) - 4*(5*m14 - 12*m13))/65;
    hamiltonian = ((4*m12 + 3*n13)/5)^2/(16/5) + ((4*n13 - 3*m12)/5)^2/(14/5) + n14^2/(13/5) + n23^2/(12/5)
        + ((4*n24 + 3*m34)/5)^2/(11/5) + ((4*m34 - 3*n24)/5)^2/(9/5);
    methods = [moser-veselov];
}

lie_poisson! {
    /// A body that is flat along its first axis, in the axes of its moments 0, 7/10, 1/2 and 2/5.
    pub system FlatOfFour;
    algebra = so(4);
    state m12, m13, m14, m23, m24, m34;
    hamiltonian = m12^2/(7/5) + m13^2 + m14^2/(4/5) + m23^2/(12/5) + m24^2/(11/5) + m34^2/(9/5);
    methods = [moser-veselov];
}

lie_poisson! {
    /// The same, turned in the same planes as the other.
    pub system TiltedFlatOfFour;
    algebra = so(4);
    state m12, m13, m14, m23, m24, m34;
    let n13 = (3*(5*m13 + 12*m14) + 4*(5*m23 + 12*m24))/65;
    let n14 = (3*(5*m14 - 12*m13) + 4*(5*m24 - 12*m23))/65;
    let n23 = (3*(5*m23 + 12*m24) - 4*(5*m13 + 12*m14))/65;
    let n24 = (3*(5*m24 - 12*m23) - 4*(5*m14 - 12*m13))/65;
    hamiltonian = ((4*m12 + 3*n13)/5)^2/(7/5) + ((4*n13 - 3*m12)/5)^2 + n14^2/(4/5) + n23^2/(12/5)
        + ((4*n24 + 3*m34)/5)^2/(11/5) + ((4*m34 - 3*n24)/5)^2/(9/5);
    methods = [moser-veselov];
}

/// The planes of so(4) in their order.
const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// Entries of a momentum `Q M Q^T`, Q a turn in each of these planes, the last one first.
fn turned_in_four(entries: [f64; 6]) -> [f64; 6] {
    let mut matrix = [[0.0; 4]; 4];
    for ((i, j), entry) in PLANES.into_iter().zip(entries) {
        (matrix[i][j], matrix[j][i]) = (entry, -entry);
    }
    let turns = [
        ((1, 2), [0.8, 0.6]),
        ((0, 1), [0.6, 0.8]),
        ((2, 3), [5.0 / 13.0, 12.0 / 13.0]),
    ];
    for ((i, j), [cosine, sine]) in turns {
        for _ in 0..2 {
            // rows, and after the transpose columns
            let (a, b) = (matrix[i], matrix[j]);
            matrix[i] = std::array::from_fn(|column| cosine * a[column] - sine * b[column]);
            matrix[j] = std::array::from_fn(|column| sine * a[column] + cosine * b[column]);
            matrix = std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]));
        }
    }
    PLANES.map(|(i, j)| matrix[i][j])
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
fn after<P, const N: usize>(
    system: &P,
    method: &impl Method<f64, P>,
    start: [f64; N],
    (h, steps): (f64, usize),
) -> ([f64; N], f64)
where
    P: Poisson<f64>,
    P::State: From<[f64; N]>,
{
    let mut state = P::State::from(start);
    let (energy, mut change) = (system.energy(&state), 0.0_f64);
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut state, &mut ()).expect("a step");
        change = change.max((system.energy(&state) - energy).abs());
    }
    let entries = state.as_slice().try_into();
    (entries.expect("so many coordinates"), change)
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

/// The same in four dimensions, where the equation has the matrix of second moments with products of inertia.
#[test]
fn steps_in_four_dimensions_are_tilted_steps() {
    use lie_runtime::InertiaPoisson as _;
    let (upright, tilted) = (UprightOfFour::new().system(), TiltedOfFour::new().system());
    let (upright, tilted) = (upright.expect("constants"), tilted.expect("constants"));
    assert!(tilted.is_tilted() && !upright.is_tilted());
    let trace: f64 = (0..4).map(|axis| tilted.moment(axis)).sum();
    assert!((trace - 2.5).abs() < 1e-15, "{trace}");
    let start = [0.4, 0.2, -0.3, 0.5, 0.1, -0.2];
    for h in [0.1, 0.3] {
        let (end, _) = after(&upright, &MoserVeselov, start, (h, 200));
        let (other, change) = after(&tilted, &MoserVeselov, turned_in_four(start), (h, 200));
        let off = |end: [f64; 6]| {
            let pairs = turned_in_four(end).into_iter().zip(other);
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(off(end) < 1e-13, "{h}: {:e}", off(end));
        assert!(change < 1e-14, "{h}: {change:e}");
        let (control, _) = after(&upright, &LieMidpoint::exp(), start, (h, 200));
        assert!(off(control) > 1e-5, "{h}: {:e}", off(control));
    }
}

/// A flat body has a pivot that is zero, in axes that are turned to round-off, and its steps are good all the same.
#[test]
fn a_flat_body_has_its_steps_in_any_axes() {
    let (upright, tilted) = (FlatOfFour::new().system(), TiltedFlatOfFour::new().system());
    let (upright, tilted) = (upright.expect("constants"), tilted.expect("constants"));
    for start in [
        [0.4, 0.2, -0.3, 0.5, 0.1, -0.2],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.5],
    ] {
        let (end, _) = after(&upright, &MoserVeselov, start, (0.1, 100));
        let (other, _) = after(&tilted, &MoserVeselov, turned_in_four(start), (0.1, 100));
        for (a, b) in turned_in_four(end).into_iter().zip(other) {
            assert!((a - b).abs() < 1e-13, "{start:?}: {a} and {b}");
        }
    }
}
