//! Values of the elementary functions that are programs, for `lab/tools/function_errors.py`: a line has the name, the argument and
//! the value, these by their bits.

use lie_core::Elementary;
use std::fmt::Write as _;

/// Numbers between 0 and 1, by lot.
fn by_lot() -> impl FnMut() -> f64 {
    let mut word = 0x2545_f491_4f6c_dd1d_u64;
    move || {
        word ^= word << 13;
        word ^= word >> 7;
        word ^= word << 17;
        (word >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Arguments of the sizes that matter to a function, and its hard places.
fn arguments(function: Elementary, count: usize) -> Vec<f64> {
    let mut lot = by_lot();
    let mut within = |least: f64, most: f64, count: usize| -> Vec<f64> {
        (0..count).map(|_| least + (most - least) * lot()).collect()
    };
    let sizes = |exponents: Vec<f64>, parts: Vec<f64>| -> Vec<f64> {
        let both = exponents.into_iter().zip(parts);
        both.map(|(exponent, part)| (1.0 + part) * exponent.floor().exp2())
            .collect()
    };
    let third = count / 3;
    let mut all = match function {
        Elementary::Exp => [
            within(-1.0, 1.0, third),
            within(-708.0, 708.0, third),
            within(-745.2, -707.0, third),
        ]
        .concat(),
        Elementary::Log => [
            within(0.5, 2.0, third),
            within(1.0 - 1e-3, 1.0 + 1e-3, third),
            sizes(within(-1074.0, 1024.0, third), within(0.0, 1.0, third)),
        ]
        .concat(),
        Elementary::Tan => within(-0.785, 0.785, count),
        _ => {
            // next to multiples of pi/2: the numbers beside the products
            let quarter = core::f64::consts::FRAC_PI_2;
            let beside = (0..third as u64).map(|k| {
                let product = (1 + k * 254_000 / third as u64) as f64 * quarter;
                f64::from_bits(product.to_bits() - 2 + k % 5)
            });
            let beside: Vec<f64> = beside.collect();
            [within(-7.0, 7.0, third), within(-4e5, 4e5, third), beside].concat()
        }
    };
    all.extend(sizes(within(-1074.0, 0.0, 300), within(0.0, 1.0, 300)));
    all.retain(|x| *x != 0.0);
    all
}

fn main() {
    let count = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let mut text = String::new();
    for &function in Elementary::ALL {
        if function.program(0.5).is_none() {
            continue;
        }
        for x in arguments(function, count.unwrap_or(30_000)) {
            let (at, value) = (x.to_bits(), function.apply(x).to_bits());
            let _ = writeln!(text, "{} {at:016x} {value:016x}", function.name());
        }
    }
    print!("{text}");
}
