//! Case D: a ring of classical spins with `H = -sum_i s_i . s_(i+1)`. lie-poisson generates it from the spec of a family of
//! so(3); for the other crates the right-hand side is written here.
//!
//! A state holds the first components of all spins, then the second and the third ones.

/// Spin after spin, as a state.
pub fn state(spins: &[f64]) -> Vec<f64> {
    let count = spins.len() / 3;
    (0..spins.len())
        .map(|place| spins[place % count * 3 + place / count])
        .collect()
}

/// The largest distance of a spin.
pub fn distance(one: &[f64], other: &[f64]) -> f64 {
    let spins = one.len() / 3;
    let square = |place: usize| (one[place] - other[place]).powi(2);
    let of = |spin: usize| (square(spin) + square(spins + spin) + square(2 * spins + spin)).sqrt();
    // not a number if any is not
    let largest = |most: f64, next: f64| {
        if most.is_nan() || next <= most {
            most
        } else {
            next
        }
    };
    (0..spins).map(of).fold(0.0, largest)
}

/// The right-hand side: each spin turns about the sum of its neighbours.
#[inline(always)]
pub fn field(state: &[f64], out: &mut [f64]) {
    let count = state.len() / 3;
    let [x, y, z] = std::array::from_fn(|k| &state[k * count..][..count]);
    let (ox, rest) = out.split_at_mut(count);
    let (oy, oz) = rest.split_at_mut(count);
    let oz = &mut oz[..count];
    let mut turn = |before: usize, i: usize, behind: usize| {
        let n = [x, y, z].map(|part| part[before] + part[behind]);
        ox[i] = n[1] * z[i] - n[2] * y[i];
        oy[i] = n[2] * x[i] - n[0] * z[i];
        oz[i] = n[0] * y[i] - n[1] * x[i];
    };
    turn(count - 1, 0, 1);
    for i in 1..count - 1 {
        turn(i - 1, i, i + 1);
    }
    turn(count - 2, count - 1, 0);
}
