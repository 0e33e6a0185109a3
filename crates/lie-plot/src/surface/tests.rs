//! Surfaces, their borders and curves on them.

use super::*;

fn sphere(point: &Point) -> (f64, Point) {
    (dot(point, point) - 4.0, point.map(|x| 2.0 * x))
}

/// `x y + z`.
fn saddle(&[x, y, z]: &Point) -> (f64, Point) {
    (x * y + z, [y, x, 1.0])
}

#[test]
fn a_sphere_is_closed_and_its_points_lie_on_it() {
    let surface = Surface::new(&sphere, &[-2.3, -2.4, -2.5], &[2.6, 2.5, 2.4], 20);
    // Euler's number of a sphere, where every edge has two triangles
    let edges = surface.triangles.len() * 3 / 2;
    assert_eq!(surface.points.len() + surface.triangles.len() - edges, 2);
    let off = surface.points.iter().map(|p| sphere(p).0.abs());
    assert!(off.fold(0.0, f64::max) < 1e-12);
    let area: f64 = surface.triangles.iter().map(|t| area(&surface, t)).sum();
    assert!(
        (area / (16.0 * std::f64::consts::PI) - 1.0).abs() < 0.02,
        "{area}"
    );
}

fn area(surface: &Surface, triangle: &[usize; 3]) -> f64 {
    let [a, b, c] = triangle.map(|at| surface.points[at]);
    let (u, v) = (
        [0, 1, 2].map(|i| b[i] - a[i]),
        [0, 1, 2].map(|i| c[i] - a[i]),
    );
    (dot(&u, &u) * dot(&v, &v) - dot(&u, &v).powi(2))
        .max(0.0)
        .sqrt()
        / 2.0
}

#[test]
fn of_two_sheets_one_is_taken() {
    // z^2 - x^2 - y^2 = 1
    let sheets = |&[x, y, z]: &Point| (z * z - x * x - y * y - 1.0, [-2.0 * x, -2.0 * y, 2.0 * z]);
    let both = Surface::new(&sheets, &[-3.0; 3], &[3.1; 3], 24);
    let upper = both.part_at(&[0.0, 0.0, 1.0]);
    assert!(both.points.iter().any(|p| p[2] < 0.0));
    assert!(upper.points.iter().all(|p| p[2] > 0.0));
    assert!(!upper.points.is_empty() && upper.points.len() < both.points.len());
    // it ends at the sides of the box and at its top, in a closed line; a sphere ends nowhere
    let border = upper.border();
    assert_eq!(border.len(), 1);
    assert_eq!(border[0].first(), border[0].last());
    let at_side = |p: &Point| p[2] > 3.0 || p.iter().any(|x| *x < -2.9 || *x > 3.0);
    assert!(border[0].len() > 20 && border[0].iter().all(at_side));
    let closed = Surface::new(&sphere, &[-2.5; 3], &[2.6; 3], 24);
    assert!(closed.border().is_empty());
    // a net has a circle for each value of each coordinate
    let net = closed.net(5);
    assert!(net.len() >= 15);
    let round =
        |line: &Vec<Point>| (0..3).any(|i| line.iter().all(|p| (p[i] - line[0][i]).abs() < 1e-12));
    assert!(net.iter().all(round));
}

#[test]
fn curves_hang_together_and_are_brought_onto_both_levels() {
    let surface = Surface::new(&sphere, &[-2.5; 3], &[2.6; 3], 24);
    let values: Vec<f64> = surface.points.iter().map(|p| saddle(p).0).collect();
    let curves = surface.curves(&values, 0.5);
    assert!(!curves.is_empty() && curves.len() < 8, "{}", curves.len());
    for curve in &curves {
        // closed on a closed surface
        assert_eq!(curve.first(), curve.last());
        for point in curve {
            let mut on = *point;
            let before = (saddle(&on).0 - 0.5).abs() + sphere(&on).0.abs();
            for _ in 0..4 {
                on = onto(&on, &[(&sphere, 0.0), (&saddle, 0.5)]);
            }
            let after = (saddle(&on).0 - 0.5).abs() + sphere(&on).0.abs();
            assert!(after < 1e-12 && before < 0.2, "{before} {after}");
        }
    }
}
