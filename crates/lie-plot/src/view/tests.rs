//! What is drawn of curves that leave their surface.

use super::*;

#[test]
fn a_curve_that_diverges_leaves_the_surface_as_large_as_it_is() {
    let square = |p: &Point| (dot(p, p), p.map(|x| 2.0 * x));
    let picture = |growth: f64| {
        let mut curve = OnSurface::new("a run");
        for k in 0..60 {
            let (s, c) = (0.1 * f64::from(k)).sin_cos();
            let point = [c, s, 0.0].map(|x| x * growth.powi(k));
            curve.push(&point, &point);
        }
        let axes = ["x", "y", "z"].map(str::to_owned);
        let mut view = View::new("", "", axes, vec![curve]);
        let energy = |p: &Point| (p[2], [0.0, 0.0, 1.0]);
        assert!(view.orbit(&square, Some(&energy), "sphere"));
        let outline = bounding_box(view.outline.all().copied()).unwrap();
        (view.to_svg(), outline.1.0 - outline.0.0, view.note)
    };
    for growth in [1.0, 1.1, 10.0] {
        let (svg, size, note) = picture(growth);
        assert!((size - 2.0).abs() < 0.1, "{size}");
        assert_eq!(note.contains("the curve has left it"), growth > 1.0);
        // the sphere has half of the width at least, and no line is outside of the picture
        let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
        let places: Vec<Place> = lines
            .flat_map(|line| {
                let points = line.split("points=\"").nth(1).unwrap().split('"').next();
                points.unwrap().split(' ').map(|point| {
                    let (x, y) = point.split_once(',').unwrap();
                    (x.parse().unwrap(), y.parse().unwrap())
                })
            })
            .collect();
        let ((a, b), (c, d)) = bounding_box(places.into_iter()).unwrap();
        assert!(
            a >= LEFT && c <= LEFT + SIDE && b >= HEAD && d <= HEAD + SIDE,
            "{growth}"
        );
    }
    // the control: what is drawn around the sphere makes it smaller, but not to nothing
    let longest = |growth: f64| {
        let (svg, ..) = picture(growth);
        let outline = svg.lines().filter(|line| line.contains("#777"));
        outline.map(str::len).sum::<usize>()
    };
    assert!(longest(1.0) > longest(10.0) && 4 * longest(10.0) > longest(1.0));
}

#[test]
fn curves_on_larger_surfaces_are_not_cut_off() {
    let square = |p: &Point| (dot(p, p), p.map(|x| 2.0 * x));
    let note = |sizes: [f64; 2]| {
        let curves = sizes.map(|size| {
            let mut curve = OnSurface::new("a run");
            for k in 0..60 {
                let (s, c) = (0.1 * f64::from(k)).sin_cos();
                let point = [c, s, 0.0].map(|x| x * size);
                curve.push(&point, &point);
            }
            curve
        });
        let axes = ["x", "y", "z"].map(str::to_owned);
        let mut view = View::new("", "", axes, curves.to_vec());
        assert!(view.orbit(&square, None, "sphere"));
        (view.frame, view.note)
    };
    assert_eq!(note([1.0, 3.0]), (None, "sphere".to_owned()));
    let (frame, said) = note([1.0, 1e30]);
    assert!(said.ends_with("; a curve has left it"));
    assert!(frame.unwrap().1.0 < 3.0);
}
