//! Pictures of ordinary and of hostile rows.

use super::*;

fn drawn(columns: usize, states: usize, rows: impl Iterator<Item = Vec<f64>>) -> String {
    let names: Vec<String> = (0..columns).map(|k| format!("c{k}")).collect();
    let mut plot =
        Plot::new("Title <&>", &names, states, (0.0, 10.0)).subtitle("midpoint, h = 0.1");
    rows.for_each(|row| plot.push(&row));
    let svg = plot.to_svg();
    assert!(
        svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"),
        "not an SVG"
    );
    assert!(
        !svg.contains("NaN") && !svg.contains("inf"),
        "a coordinate is not a number"
    );
    svg
}

#[test]
fn titles_axes_legend() {
    let rows = (0..=100).map(|k| {
        let t = 0.1 * f64::from(k);
        vec![t, t.cos(), t.sin(), 1.0 + 1e-14 * t, 2.0]
    });
    let svg = drawn(5, 2, rows);
    let title = "Title &lt;&amp;&gt;";
    for text in [
        title,
        "midpoint, h = 0.1",
        ">t<",
        "components of μ",
        "|I − I₀| / |I₀|",
        "c1",
        "c4",
    ] {
        assert!(svg.contains(text), "{text:?} is missing");
    }
    assert!(svg.contains("10⁻¹⁶") && svg.contains(">−0.5<"));
}

#[test]
fn a_long_run_stays_small() {
    let rows = (0..=300_000).map(|k| {
        let t = f64::from(k) / 30_000.0;
        (0..14)
            .map(|i| {
                if i == 0 {
                    t
                } else {
                    (t * f64::from(100 + i)).sin()
                }
            })
            .collect()
    });
    let svg = drawn(14, 12, rows);
    assert!(svg.len() < 500_000, "{} bytes", svg.len());
    assert!(svg.len() > 100_000, "something is drawn");
}

#[test]
fn hostile_rows() {
    drawn(1, 0, std::iter::empty());
    drawn(4, 2, std::iter::empty());
    drawn(4, 2, [vec![0.0, 1.0, 2.0, 3.0]].into_iter());
    drawn(4, 2, [vec![0.0], vec![]].into_iter());
    let bad = [
        f64::NAN,
        f64::INFINITY,
        -f64::INFINITY,
        1e308,
        -1e308,
        5e-324,
        0.0,
    ];
    for a in bad {
        for b in bad {
            drawn(
                4,
                2,
                [
                    vec![0.0, a, b, a],
                    vec![5.0, b, a, b],
                    vec![10.0, 1.0, a, a],
                ]
                .into_iter(),
            );
        }
    }
}

#[test]
fn an_invariant_that_is_zero_is_drawn_absolutely() {
    let rows = || (0..=10).map(|k| vec![f64::from(k), 1.0, 1e-17 * f64::from(k), 5.0]);
    let svg = drawn(4, 1, rows());
    assert!(svg.contains("c2 (absolute)") && !svg.contains("c3 (absolute)"));
}
