//! Where the third axis of the group element points to.

use lie_plot::surface::Point;
use lie_runtime::driver::Chart;

/// The third column of a rotation by its entries in a chart.
pub fn tip(chart: Option<Chart>, element: &[f64]) -> Point {
    let of_quaternion = |[w, x, y, z]: [f64; 4]| {
        [
            2.0 * (x * z + w * y),
            2.0 * (y * z - w * x),
            1.0 - 2.0 * (x * x + y * y),
        ]
    };
    match (chart, element) {
        (Some(Chart::Euler(sequence)), &[phi, theta, psi]) => {
            of_quaternion(sequence.quaternion([phi, theta, psi]))
        }
        (Some(Chart::Quaternion), &[w, x, y, z]) => of_quaternion([w, x, y, z]),
        _ => {
            let size = element.len().isqrt();
            [0, 1, 2].map(|row| element.get(row * size + 2).copied().unwrap_or(f64::NAN))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_runtime::driver::EulerSequence;

    #[test]
    fn all_charts_point_the_same_way() {
        // turned by 2 a about (1, 2, 2)/3
        let (s, c) = 0.4_f64.sin_cos();
        let [x, y, z] = [1.0, 2.0, 2.0].map(|u| s * u / 3.0);
        let matrix = [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - c * z),
            2.0 * (x * z + c * y),
            2.0 * (x * y + c * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - c * x),
            2.0 * (x * z - c * y),
            2.0 * (y * z + c * x),
            1.0 - 2.0 * (x * x + y * y),
        ];
        let a = tip(Some(Chart::Matrix), &matrix);
        let sequences = EulerSequence::ALL.into_iter();
        let angles = sequences.map(|s| tip(Some(Chart::Euler(s)), &s.angles([c, x, y, z])));
        let quaternion = tip(Some(Chart::Quaternion), &[c, x, y, z]);
        for b in angles.chain([quaternion]) {
            for (a, b) in a.iter().zip(b) {
                assert!((a - b).abs() < 1e-15);
            }
        }
        assert!((a[0] * a[0] + a[1] * a[1] + a[2] * a[2] - 1.0).abs() < 1e-15);
        assert!((a[2] - 1.0).abs() > 0.1);
    }
}
