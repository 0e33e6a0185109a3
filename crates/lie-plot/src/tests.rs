//! Pictures of ordinary and of hostile rows.

use super::*;

mod benches;

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

/// The `x`, `y` and words of texts of a size.
fn texts(svg: &str, size: &str) -> Vec<(f64, f64, String)> {
    let lines = svg
        .lines()
        .filter(|line| line.contains(&format!("font-size=\"{size}\"")));
    let number = |line: &str, key: &str| -> f64 {
        let rest = line.split(key).nth(1).expect("a place");
        rest.split('"')
            .next()
            .expect("a number")
            .parse()
            .expect("a number")
    };
    let words = |line: &str| {
        line.split('>')
            .nth(1)
            .expect("words")
            .trim_end_matches("</text")
            .to_owned()
    };
    lines
        .map(|line| (number(line, " x=\""), number(line, " y=\""), words(line)))
        .collect()
}

/// Whether texts of one line run into the sample before the next, so many pixels wide, or out of the picture.
fn collide(texts: &[(f64, f64, String)], size: f64, sample: f64, width: f64) -> bool {
    texts.iter().any(|(x, y, text)| {
        let end = x + svg::text_width(text, size, false);
        end > width
            || texts
                .iter()
                .any(|(other, line, _)| line == y && other > x && end > *other - sample)
    })
}

#[test]
fn heads_of_a_map_are_inside_and_its_colours_explained() {
    use map::{Cell, Column, Map, Outcome};
    let groups = [
        "step over h0",
        "a_very_long_name_of_a_casimir_function times",
    ];
    let column = |group: &str| Column {
        group: group.to_owned(),
        label: "1".to_owned(),
    };
    let many = (0..80)
        .map(|_| column(groups[0]))
        .chain([column(groups[1])]);
    let cell = Cell {
        outcome: Outcome::Drift(-6.0),
        text: String::new(),
    };
    let picture = Map {
        title: "Top".into(),
        subtitle: String::new(),
        columns: many.collect(),
        rows: vec![("rk4".into(), vec![Some(cell); 81])],
    };
    let svg = picture.to_svg();
    let number = |key: &str| -> f64 {
        let rest = svg.split(key).nth(1).expect("an attribute");
        rest.split('"')
            .next()
            .expect("a number")
            .parse()
            .expect("a number")
    };
    let (width, length) = (number(" width=\""), svg::text_width(groups[1], 12.5, true));
    let heads = texts(&svg, "12.5");
    let (x, y, _) = heads
        .iter()
        .find(|head| head.2 == groups[1])
        .expect("the head");
    let (sine, cosine) = 30_f64.to_radians().sin_cos();
    assert!(x + cosine * length < width && y - sine * length > 55.0);
    // the control: 60 pixels beyond the last column, as before, were too few
    assert!(x + cosine * length > x + 60.0);
    let words = texts(&svg, "11.5");
    assert!(!collide(&words, 11.5, 20.0, width), "{words:?}");
    assert!(words.iter().any(|text| text.2 == "energy error that grows"));
    assert!(svg.contains("10<tspan dy=\"-5\" font-size=\"7.5\">−16</tspan>"));
}

#[test]
fn of_many_curves_a_few_are_named() {
    let drawn = |states: usize| {
        let rows = (0..=20).map(|k| {
            let t = 0.5 * f64::from(k);
            let state = (0..states).map(|i| (t + i as f64).sin());
            [t].into_iter().chain(state).chain([1.0]).collect()
        });
        drawn(states + 2, states, rows)
    };
    let names = |svg: &str| {
        let mut all = texts(svg, "15");
        all.retain(|(.., text)| text.starts_with('c') && text[1..].parse::<u32>().is_ok());
        all
    };
    let svg = drawn(96);
    let mut seen = names(&svg);
    // the last is the energy, in the panel below
    let energy = seen.pop().expect("the energy");
    assert_eq!(energy.2, "c97");
    let first_and_last = [&*seen[0].2, &*seen[seen.len() - 1].2];
    assert_eq!((seen.len(), first_and_last), (8, ["c1", "c96"]));
    assert!(seen.iter().all(|name| name.1 < energy.1));
    assert!(svg.contains("96 curves, shaded in their order"));
    // the control: few have a name each, and nothing is said
    let few = drawn(6);
    assert_eq!(names(&few).len(), 7);
    assert!(!few.contains("shaded"));
}

#[test]
fn labels_of_an_axis_do_not_reach_its_title() {
    for scale in [1e-12, 1e12, 0.0312, 1.0] {
        let rows = (0..=20).map(|k| {
            let t = 0.5 * f64::from(k);
            vec![t, 1000.0 + scale * t.sin(), scale * t.cos(), 1.0]
        });
        let svg = drawn(4, 2, rows);
        let title = svg.find("components of μ").expect("the title");
        let at = svg[..title].rfind(" x=\"").expect("its place") + 4;
        let title: f64 = svg[at..at + 4].parse().expect("a number");
        let labels = texts(&svg, "15").into_iter();
        // at the right end of which the axis stands
        let labels = labels.filter(|(x, _, text)| *x < 250.0 && text.parse::<f64>().is_ok());
        for (x, _, text) in labels {
            assert!(
                x - svg::text_width(&text, 15.0, false) > title,
                "{text} {scale}"
            );
        }
    }
}

#[test]
fn names_of_runs_do_not_collide() {
    use phase::Phase;
    let picture = |many: usize| {
        let mut phase = Phase::new("Top", "", ["x".to_owned(), "y".to_owned()]);
        for k in 0..many {
            phase.begin(format!("a_parameter_of_the_run = {k}.25"));
            phase.push((0.0, f64::from(k as u32)));
            phase.push((1.0, 0.0));
        }
        phase.to_svg()
    };
    let names = |svg: &str| {
        let mut all = texts(svg, "12");
        all.retain(|(.., text)| text.contains('='));
        all
    };
    let (few, many) = (picture(14), picture(40));
    assert_eq!((names(&few).len(), names(&many).len()), (14, 8));
    for svg in [&few, &many] {
        assert!(!collide(&names(svg), 12.0, 29.0, 804.0), "{:?}", names(svg));
    }
    assert!(many.contains("run = 0.25") && many.contains("run = 39.25"));
    // each of the few has a colour of its own, and the many have more colours than that
    let colours = |svg: &str| {
        let all = svg.split("stroke=\"").skip(1);
        let all = all.filter_map(|rest| rest.split('"').next());
        all.collect::<std::collections::HashSet<_>>().len()
    };
    assert!(colours(&few) >= 14 && colours(&many) >= 16);
    // the control: 190 pixels for a name, as before, were too few
    let before = |(k, name): (usize, (f64, f64, String))| (24.0 + 190.0 * k as f64, 0.0, name.2);
    let before: Vec<_> = names(&few)
        .into_iter()
        .take(4)
        .enumerate()
        .map(before)
        .collect();
    assert!(collide(&before, 12.0, 29.0, 804.0));
}

#[test]
fn a_panel_without_points_says_so() {
    use phase::Phase;
    let mut phase = Phase::new("Top", "", ["x".to_owned(), "y".to_owned()]);
    phase.begin("a run");
    assert!(phase.to_svg().contains("nothing to draw"));
    phase.dot((1.0, 2.0));
    assert!(!phase.to_svg().contains("nothing to draw"));
}

/// The picture of two runs whose energy is off by these parts of t.
fn two_runs(slopes: [f64; 2]) -> String {
    let columns = ["t", "x", "y", "energy"].map(str::to_owned);
    let mut compare = compare::Compare::new("Two runs", "", &columns, 2);
    for (name, slope) in ["first", "second"].into_iter().zip(slopes) {
        compare.begin(name, (0.0, 10.0));
        for k in 0..=100 {
            let t = 0.1 * f64::from(k);
            compare.push(&[t, t.cos(), t.sin(), 1.0 + slope * t]);
        }
    }
    compare.to_svg()
}

#[test]
fn of_two_runs_with_the_same_errors_both_are_seen() {
    let dashes = |svg: &str| svg.matches("stroke-dasharray").count();
    assert!(dashes(&two_runs([1e-3, 1e-3])) > 0);
    assert_eq!(dashes(&two_runs([1e-3, 2e-3])), 0);
}

/// A circle by rows, with so many points between each two of them.
fn circle(rows: u32, parts: u32) -> Plot {
    let mut plot = Plot::new("Circle", &["t", "x", "energy"], 1, (0.0, 6.0));
    for row in 0..=rows {
        for part in 0..parts {
            let t = 6.0 * (f64::from(row) + f64::from(part) / f64::from(parts)) / f64::from(rows);
            let values = [t, t.cos(), 0.5];
            match part {
                0 => plot.push(&values),
                _ if row < rows => plot.between(&values),
                _ => {}
            }
        }
    }
    plot
}

#[test]
fn few_rows_are_dots_on_a_curve_between_them() {
    let discs = |plot: &Plot| plot.to_svg().matches("r=\"2.2\"").count();
    assert_eq!(discs(&circle(10, 20)), 11);
    assert_eq!(discs(&circle(199, 3)), 200);
    assert_eq!(discs(&circle(200, 3)), 0);
    assert_eq!(discs(&circle(100, 1)), 0);
    // the curve goes through what is between the rows, the errors do not
    let points = |svg: &str| -> Vec<usize> {
        let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
        lines.map(|line| line.matches(',').count()).collect()
    };
    assert_eq!(points(&circle(10, 20).to_svg()), [201, 10]);
}
