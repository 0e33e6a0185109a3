//! Pictures of error against run time.

use super::{collide, texts};
use crate::frontier::{Curve, Frontier};
use crate::svg;

#[test]
fn legends_of_error_against_time_do_not_collide() {
    let names = [
        "orbit-energy (mean-value)",
        "compose4(orbit-energy)",
        "orbit-energy",
        "rk4",
    ];
    let curve = |name: &str, class: &str| Curve {
        name: name.to_owned(),
        class: class.to_owned(),
        family: name.to_owned(),
        order: 2,
        control: false,
        points: vec![(1e-6, 1e-3), (2e-6, 6e-5)],
    };
    let curves = ["orbit", "energy", "Poisson"].iter();
    let curves = curves.flat_map(|class| names.map(|name| curve(name, class)));
    let picture = Frontier {
        title: String::new(),
        subtitle: String::new(),
        axis: "error".to_owned(),
        floor: 1e-14,
        curves: curves.collect(),
    };
    let svg = picture.to_svg();
    let mut names = texts(&svg, "11");
    names.retain(|(.., text)| text.contains("orbit") || text == "rk4");
    assert_eq!(names.len(), 12);
    assert!(!collide(&names, 11.0, 31.0, 1160.0), "{names:?}");
    // the control: in two columns, as they stood before, they do
    let before = |(index, name): (usize, &(f64, f64, String))| {
        let (x, y) = (172.0 * (index % 2) as f64, (index / 2) as f64);
        (x, y, name.2.clone())
    };
    let before: Vec<_> = names[..4].iter().enumerate().map(before).collect();
    assert!(collide(&before, 11.0, 31.0, 1160.0));
    for text in ["run time", ">error<", "grey: the others"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn what_is_fastest_is_bold_with_and_without_a_reference() {
    let curve = |name: &str, seconds: f64, error: f64| Curve {
        name: name.to_owned(),
        class: "orbit".to_owned(),
        family: name.to_owned(),
        order: 2,
        control: false,
        points: vec![(seconds, error), (2.0 * seconds, 0.1 * error)],
    };
    let picture = |floor: f64, error: f64| {
        let curves = vec![
            curve("quick", 1e-6, error),
            curve("slow", 1e-4, 10.0 * error),
        ];
        let subtitle =
            "largest relative drift of the energy to t = 100 against run time per unit of time";
        let (title, subtitle) = (String::new(), subtitle.to_owned());
        let axis = "energy drift".to_owned();
        Frontier {
            title,
            subtitle,
            axis,
            floor,
            curves,
        }
        .to_svg()
    };
    let bold = |svg: &str, name: &str| {
        let mut lines = svg
            .lines()
            .filter(|line| line.contains(&format!(">{name}</text>")));
        lines.any(|line| line.contains("font-weight=\"bold\""))
    };
    for floor in [1e-14, f64::NAN] {
        let svg = picture(floor, 1e-5);
        assert!(bold(&svg, "quick") && !bold(&svg, "slow"), "{floor}");
        assert!(svg.contains(">energy drift<") && !svg.contains(">error<"));
        // all of the second line is there, and none of it beyond the edge
        let head = texts(&svg, "14");
        let words: Vec<&str> = head.iter().map(|(.., text)| text.as_str()).collect();
        let all = words.join(" ");
        for text in [
            "per unit of time; bold: fastest in the panel at some energy drift",
            "grey: the others",
        ] {
            assert!(all.contains(text), "{all}");
        }
        let wide =
            |(x, _, text): &(f64, f64, String)| x + svg::text_width(text, 14.0, false) > 1160.0;
        assert!(head.len() > 2 && !head.iter().any(wide), "{head:?}");
        // and the rest is below it
        let down = svg
            .split("<g transform=\"translate(0 ")
            .nth(1)
            .expect("parts that moved");
        assert!(down.starts_with("18)"));
    }
    // errors of the size of the solution: nothing is bold, and nothing is promised
    let none = picture(1e-14, 0.5);
    assert!(!bold(&none, "quick") && !none.contains("bold:"));
}
